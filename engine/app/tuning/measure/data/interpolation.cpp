// SPDX-License-Identifier: MIT
/// Interpolation of each grid of the scene: linear or cubic.
///   error  root mean square of the interpolation's error, by the range of the values: measured at every 4th and every 2nd voxel and
///          extrapolated to the grid itself (discretization_error.h); for a formula that is sampled on a grid, against the formula
///   time   one fetch of value and gradient along straight sample paths, an access pattern like that of the haptics
#include <fmt/format.h>

#include <cmath>

#include "engine/app/tuning/measure/discretization_error.h"
#include "engine/app/tuning/measure/fetch_timing.h"
#include "engine/app/tuning/measure/pareto_choice.h"
#include "engine/app/tuning/measure/registry.h"

namespace catena::app::tuning {
namespace {

double one_number(double v) { return v; }
double one_number(const Vec3& v) { return v.x; }

template <class FieldPtr>
TimedRun fetches(const FieldPtr& field, const std::vector<Vec3>& places) {
  return make_fetch_run(
      places, [&field = *field, cursor = field::Cursor{}](const Vec3& p) mutable { return one_number(field.sample(p, cursor).value); });
}

field::AnyField any(std::shared_ptr<const field::ScalarGrid> grid) { return {std::move(grid), nullptr}; }
field::AnyField any(std::shared_ptr<const field::VectorGrid> grid) { return {nullptr, std::move(grid)}; }

/// Adds both interpolations of one grid to the curve.
template <class Grid>
Outcome add_cells(Workload& subject, const Grid& grid, Curve& curve) {
  const std::shared_ptr<const Grid> linear = grid.as_linear();
  CATENA_TRY(const auto cubic, grid.as_cubic());
  std::vector<Vec3> places = straight_sample_paths(grid.index_box());
  for (Vec3& p : places) p = grid.mapping().world_from_index(p);
  for (const auto& [word, one] : {std::pair<const char*, const std::shared_ptr<const Grid>&>{"linear", linear}, {"cubic", cubic}}) {
    const auto floor = estimate_interpolation_error(any(one));
    Point p{word, fmt::format("\"interpolation\": \"{}\"", word), "", kNotMeasured, kNotMeasured, {}, kNotMeasured, {}};
    if (floor && floor->scale > 0) p.error = floor->at_h.error / floor->scale;
    p.bytes = static_cast<double>(one->bytes());
    curve.points.push_back(std::move(p));
  }
  if (!(std::isfinite(curve.points[0].error) && std::isfinite(curve.points[1].error)))
    return Error{"it has fewer than nine voxels along an axis, or too many voxels for a copy"};
  curve.current = grid.interpolation() == field::Interpolation::cubic ? 1 : 0;
  return time_points(curve, {fetches(linear, places), fetches(cubic, places)}, 0.3 * subject.effort.haptics_s);
}

/// Cubic interpolation is always slower: it is chosen only if its error is smaller by at least a quarter. Where rays go through the field
/// as a volume, the fetch is only part of the cost, and the scene's setting is kept.
void decide(Curve& curve, bool as_volume) {
  const double gain = curve.points[0].error / curve.points[1].error, cost = curve.points[1].time.median / curve.points[0].time.median;
  curve.front = pareto_front(curve.points, curve.cost);
  curve.chosen = gain >= 1.25 ? 1 : 0;
  curve.choice_reason =
      gain >= 1.25 ? fmt::format("Cubic cells have a {:.3g} times smaller error, at {:.2g} times the cost of a fetch.", gain, cost)
      : gain >= 1  ? fmt::format("Cubic cells reduce the error by {:.0f} % only: these data are not smooth at the spacing of the grid.",
                                 100 * (1 - 1 / gain))
                   : "Cubic cells have a larger error than linear cells: they overshoot at noise and edges.";
  if (curve.chosen != 1 || !as_volume) return;
  curve.choice_reason +=
      curve.current == 1 ? " The field is rendered as a volume, and a cubic volume has no fast rays: the image takes longer, see --quality."
                         : " But the field is rendered as a volume, and a cubic volume has no fast rays: the image takes longer, see "
                           "--quality, so that the scene's setting is kept.";
  curve.chosen = curve.current;
}

/// Returns whether a volume of the scene shows the field.
bool is_volume(scene::Scene& scene, scene::Entity field) {
  bool found = false;
  scene.entities.each<scene::Volume>([&](scene::Entity, const scene::Volume& volume) { found = found || volume.field == field; });
  return found;
}

}  // namespace

Result<std::vector<Curve>> measure_interpolation(Workload& subject) {
  std::vector<Curve> curves;
  subject.scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    const field::AnyField& loaded = source.loaded;
    if (!source.file || loaded.get() == nullptr || !loaded.get()->is_grid()) return;
    if (loaded.scalar && loaded.scalar->interpolation() == field::Interpolation::nearest) return;
    const std::string name = subject.scene.entities.get<scene::Name>(e).value;
    Curve curve;
    curve.id = "data-cells-" + name;
    curve.title = "Interpolation of \"" + name + "\"";
    curve.description =
        "Linear cells of eight samples, or cubic cells of 64. Interpolation from every 4th and every 2nd voxel is compared with the "
        "omitted voxels; the error between the voxels of the full grid follows from the observed order of convergence. One fetch is value "
        "and gradient.";
    curve.error_name = loaded.vector ? "interpolation error / twice the maximum length (RMS)" : "interpolation error / range (RMS)";
    curve.time_name = "ns per fetch";
    curve.bytes_name = "bytes of the grid";
    curve.reference = "the voxels of the full grid";
    const Outcome made =
        loaded.scalar ? add_cells(subject, *loaded.scalar->grid(), curve) : add_cells(subject, *loaded.vector->grid(), curve);
    if (!made) {
      subject.skipped.push_back("Interpolation of field \"" + name + "\": " + made.error().message + ".");
      return;
    }
    decide(curve, is_volume(subject.scene, e));
    curves.push_back(std::move(curve));
  });
  return curves;
}

}  // namespace catena::app::tuning
