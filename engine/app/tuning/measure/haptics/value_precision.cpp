// SPDX-License-Identifier: MIT
/// Precision of the values of a grid: floats, half floats, and bytes between the minimum and the maximum value. An experiment on a
/// copy with its own trilinear fetch; Catena's haptics reads floats and has no setting for it.
///   error  root mean square difference of a sample from that of floats, at points within the grid, by the range of the values
#include <Imath/half.h>
#include <fmt/format.h>

#include <cmath>

#include "engine/app/tuning/measure/discretization_error.h"
#include "engine/app/tuning/measure/fetch_timing.h"
#include "engine/app/tuning/measure/haptics/link_replay.h"
#include "engine/app/tuning/measure/registry.h"
#include "engine/field/field_display_range.h"

namespace catena::app::tuning {
namespace {

struct AsFloat {
  static double value(float v, double, double) { return static_cast<double>(v); }
};
struct AsHalf {
  static double value(std::uint16_t v, double, double) { return static_cast<double>(imath_half_to_float(v)); }
};
struct AsByte {
  static double value(std::uint8_t v, double offset, double scale) { return offset + scale * v; }
};

/// A block of samples and their trilinear fetch.
template <class T, class As>
struct Block {
  field::Index3 n;
  double offset = 0, scale = 1;
  std::vector<T> values;

  double at(const Vec3& p) const {
    const int x = static_cast<int>(p.x), y = static_cast<int>(p.y), z = static_cast<int>(p.z);
    const std::size_t base = (std::size_t(z) * n.y + y) * n.x + x, row = std::size_t(n.x), layer = row * n.y;
    std::array<double, 8> c;
    for (std::size_t k = 0; k < 8; ++k) c[k] = As::value(values[base + (k & 1) + (k >> 1 & 1) * row + (k >> 2) * layer], offset, scale);
    double value;
    Vec3 gradient;
    field::trilinear(c, {p.x - x, p.y - y, p.z - z}, value, gradient);
    return value + 1e-300 * gradient.x;
  }
};

template <class B>
TimedRun fetches_of(const B& block, const std::vector<Vec3>& places) {
  return make_fetch_run(places, [&block](const Vec3& p) { return block.at(p); });
}

Result<Curve> measure_grid(Workload& subject, const std::string& name, const field::ScalarGrid& grid) {
  const field::Box& box = grid.index_box();
  const auto cut = [](double span) { return std::min(static_cast<int>(span) + 1, 256); };
  const field::Index3 n{cut(box.hi.x - box.lo.x), cut(box.hi.y - box.lo.y), cut(box.hi.z - box.lo.z)};
  if (n.x < 2 || n.y < 2 || n.z < 2) return Error{"field \"" + name + "\" has only one voxel along an axis"};
  const field::Index3 origin{static_cast<int>(box.lo.x), static_cast<int>(box.lo.y), static_cast<int>(box.lo.z)};
  Block<float, AsFloat> floats{n, 0, 1, std::vector<float>(std::size_t(n.x) * n.y * n.z)};
  grid.read_block(origin, n, floats.values);
  for (float& v : floats.values)
    if (!std::isfinite(v)) v = static_cast<float>(grid.min_value());
  const DisplayRange& shown = field::display_range(grid);
  const double lo = shown.lo, range = shown.hi - lo;
  if (!(range > 0)) return Error{"field \"" + name + "\" has the same value everywhere"};
  Block<std::uint16_t, AsHalf> halves{n, 0, 1, {}};
  Block<std::uint8_t, AsByte> bytes{n, lo, range / 255, {}};
  for (const float v : floats.values) {
    halves.values.push_back(imath_float_to_half(v));
    bytes.values.push_back(static_cast<std::uint8_t>(std::lround(std::clamp((static_cast<double>(v) - lo) / range, 0.0, 1.0) * 255)));
  }
  Curve curve;
  curve.id = "hand-values-" + name;
  curve.title = "Precision of the values of \"" + name + "\"";
  curve.description =
      "A copy of the grid's samples in each format, sampled along straight paths with steps of a tenth of a voxel. The haptics uses "
      "floats; "
      "the other formats are for comparison and cannot be selected.";
  curve.error_name = "error of a sample / range (RMS)";
  curve.time_name = "ns per fetch";
  curve.bytes_name = "bytes of the samples";
  curve.cost = CostKind::bytes;
  curve.extra_columns = {"maximum error / range"};
  curve.reference = "the samples as floats";
  if (const auto floor = estimate_interpolation_error({grid.with_interpolation(field::Interpolation::linear), nullptr})) {
    curve.discretization_error = floor->at_h.error / range;
    curve.discretization_error_method =
        fmt::format("of linear interpolation between the samples, from every 2nd and 4th voxel, observed order {:.1f}", floor->at_h.order);
  }
  // excludes the last voxels: every point must be the start of a cell
  const std::vector<Vec3> places = straight_sample_paths({Vec3(0.0), Vec3(n.x - 1, n.y - 1, n.z - 1) - 1e-9});
  const auto add = [&](const char* setting, double size, const auto& block) {
    Point p{setting, "", "", 0, kNotMeasured, {}, size * static_cast<double>(floats.values.size()), {0}};
    double squares = 0;
    for (const Vec3& place : places) {
      const double off = std::fabs(block.at(place) - floats.at(place)) / range;
      squares += off * off;
      p.extra_values[0] = std::max(p.extra_values[0], off);
    }
    p.error = std::sqrt(squares / static_cast<double>(places.size()));
    curve.points.push_back(std::move(p));
  };
  add("float (32 bits)", 4, floats);
  add("half float (16 bits)", 2, halves);
  add("byte (8 bits)", 1, bytes);
  curve.current = 0;
  CATENA_CHECK(time_points(curve, {fetches_of(floats, places), fetches_of(halves, places), fetches_of(bytes, places)},
                           0.3 * subject.effort.haptics_s));
  return curve;
}

}  // namespace

Result<std::vector<Curve>> measure_value_precision(Workload& subject) {
  std::vector<Curve> curves;
  bool has_scalar_link = false;
  std::vector<std::string> done;
  subject.scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    const field::ScalarFieldPtr field = find_link_field(subject.scene, link.node).scalar;
    if (!field || field->grid() == nullptr) return;
    has_scalar_link = true;
    const std::string name = link.node.find("field")->string;
    if (std::find(done.begin(), done.end(), name) != done.end()) return;
    done.push_back(name);
    auto curve = measure_grid(subject, name, *field->grid());
    if (curve)
      curves.push_back(std::move(*curve));
    else
      subject.skipped.push_back("Precision of the values: " + curve.error().message + ".");
  });
  if (!has_scalar_link) subject.skipped.emplace_back("Precision of the values: no link uses a scalar grid, and formulas store no values.");
  return curves;
}

}  // namespace catena::app::tuning
