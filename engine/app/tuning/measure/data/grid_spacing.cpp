// SPDX-License-Identifier: MIT
/// Interpolation error, linear or cubic, on each grid of the scene: measured at every 4th and every 2nd voxel, and extrapolated to the grid
/// itself. The last is the discretization error of haptics and rendering. For a formula that is sampled on a grid the true error is shown
/// too.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/app/tuning/measure/discretization_error.h"
#include "engine/app/tuning/measure/registry.h"

namespace catena::app::tuning {
namespace {

/// Root mean square of grid - formula at random points of the grid.
double true_error(const field::AnyField& grid, const field::AnyField& formula) {
  std::mt19937 random(11);
  const auto unit = [&] { return static_cast<double>(random() >> 8) / 16777216.0; };
  field::Cursor a, b;
  const field::Box& box = grid.get()->index_box();
  double sum = 0, count = 0;
  for (int k = 0; k < 200000; ++k) {
    const Vec3 i = box.lo + Vec3(unit(), unit(), unit()) * (box.hi - box.lo);
    const Vec3 p = grid.get()->mapping().world_from_index(i);
    double d2 = 0;
    if (grid.scalar) {
      const field::ScalarSample s = grid.scalar->sample(p, a), t = formula.scalar->sample(p, b);
      if (!s.inside || !t.inside) continue;
      d2 = (s.value - t.value) * (s.value - t.value);
    } else {
      const field::VectorSample s = grid.vector->sample(p, a), t = formula.vector->sample(p, b);
      if (!s.inside || !t.inside) continue;
      d2 = dot(s.value - t.value, s.value - t.value);
    }
    if (!std::isfinite(d2)) continue;
    sum += d2;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNotMeasured;
}

}  // namespace

Result<std::vector<Curve>> measure_grid_spacing(Workload& subject) {
  std::vector<Curve> curves;
  subject.scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    const field::AnyField& grid = source.rendered.get() != nullptr && source.rendered.get()->is_grid() ? source.rendered : source.loaded;
    if (grid.get() == nullptr || !grid.get()->is_grid()) return;
    const std::string name = subject.scene.entities.get<scene::Name>(e).value;
    const auto floor = estimate_interpolation_error(grid);
    if (!floor || !(floor->scale > 0)) {
      subject.skipped.push_back(
          "Discretization error of field \"" + name +
          "\": the field uses nearest-neighbour interpolation, has fewer than nine voxels along an axis, or too many voxels for a copy.");
      return;
    }
    Curve curve;
    curve.id = "data-" + name;
    curve.title = "Discretization error of the grid \"" + name + "\"";
    curve.description =
        "Interpolation from every 4th and every 2nd voxel is compared with the omitted voxels; the error between the voxels of the full "
        "grid follows from the observed order of convergence.";
    curve.error_name = grid.vector ? "interpolation error / twice the maximum length (RMS)" : "interpolation error / range (RMS)";
    curve.bytes_name = "bytes of the values";
    curve.cost = CostKind::bytes;
    const Vec3 n = grid.get()->index_box().hi - grid.get()->index_box().lo + Vec3(1.0);
    const double bytes = 4.0 * (grid.vector ? 3 : 1) * n.x * n.y * n.z;
    const auto add = [&](const char* setting, double error, double size) {
      curve.points.push_back({setting, "", "", error / floor->scale, kNotMeasured, {}, size, {}});
    };
    add("every 4th voxel", floor->at_4h, bytes / 64);
    add("every 2nd voxel", floor->at_2h, bytes / 8);
    add("all voxels (estimated)", floor->at_h.error, bytes);
    curve.current = 2;
    curve.discretization_error = floor->at_h.error / floor->scale;
    curve.discretization_error_method = fmt::format(
        "extrapolated with the observed order {:.2f}{}", floor->at_h.order,
        floor->at_h.is_converged ? ""
                                 : "; the error hardly decreases with the spacing: a finer grid would not resolve the edges or the noise");
    if (source.rendered.get() == grid.get() && source.loaded.get() != nullptr && !source.loaded.get()->is_grid())
      curve.discretization_error_method +=
          fmt::format("; compared with the formula it is {:.3g}", true_error(grid, source.loaded) / floor->scale);
    const field::Interpolation cells = grid.scalar ? grid.scalar->interpolation() : grid.vector->grid()->interpolation();
    curve.choice_reason = fmt::format(
        "With {} cells, the interpolation error of the grid is {:.2g} of {}: images and forces cannot be more accurate than that.",
        cells == field::Interpolation::cubic ? "cubic" : "linear", curve.discretization_error,
        grid.vector ? "twice the maximum length of the vectors" : "the range of the values");
    curves.push_back(std::move(curve));
  });
  return curves;
}

}  // namespace catena::app::tuning
