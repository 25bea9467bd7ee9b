// SPDX-License-Identifier: MIT
#include "haptics/chain/parameter.h"

#include <algorithm>

#include "haptics/chain/constraint.h"

namespace catena::haptics {

namespace {

/// Returns (x - lo) / (hi - lo) for lo <= x <= hi, lo < hi, without overflow.
double part(double x, double lo, double hi) noexcept {
  const double span = hi - lo;
  return std::isfinite(span) ? (x - lo) / span : (0.5 * x - 0.5 * lo) / (0.5 * hi - 0.5 * lo);
}

double piecewise_linear(const std::vector<HapticTransferFunction::Point>& points, double x) noexcept {
  const auto after = std::upper_bound(points.begin(), points.end(), x,
                                      [](double value, const HapticTransferFunction::Point& p) { return value < p.value; });
  if (after == points.begin()) return points.front().output;
  const HapticTransferFunction::Point& a = *(after - 1);
  if (after == points.end() || x == a.value) return a.output;
  const double t = part(x, a.value, after->value);
  return (1 - t) * a.output + t * after->output;
}

double normalised(double x, double lo, double hi) noexcept {
  if (!(hi > lo)) return 0;
  return part(std::clamp(x, lo, hi), lo, hi);
}

}  // namespace

double Parameter::evaluate_field(const Vec3& world, field::Cursor& cursor, std::int32_t& evaluations) const noexcept {
  const HapticTransferFunction& map = *map_;
  if (evaluations >= kMaxEvaluations) return map.outside;
  ++evaluations;
  double x = 0;
  if (map.field.scalar) {
    const field::ScalarSample sample = map.field.scalar->sample(world, cursor);
    x = map.quantity == HapticTransferFunction::Quantity::gradient ? norm(sample.gradient) : sample.value;
    if (!sample.inside) return map.outside;
  } else {
    const field::VectorSample sample = map.field.vector->sample(world, cursor);
    x = norm(sample.value);
    if (!sample.inside) return map.outside;
  }
  if (!std::isfinite(x)) return map.outside;
  if (map.normalize) x = normalised(x, map.range_min, map.range_max);
  return piecewise_linear(map.points, x);
}

double Parameter::min() const {
  if (!map_) return constant_;
  double minimum = map_->outside;
  for (const HapticTransferFunction::Point& point : map_->points) minimum = std::min(minimum, point.output);
  return minimum;
}

double Parameter::max() const {
  if (!map_) return constant_;
  double maximum = map_->outside;
  for (const HapticTransferFunction::Point& point : map_->points) maximum = std::max(maximum, point.output);
  return maximum;
}

}  // namespace catena::haptics
