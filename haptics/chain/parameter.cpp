#include "haptics/chain/parameter.h"

#include <algorithm>

#include "haptics/chain/constraint.h"

namespace catena::haptics {

namespace {

double piecewise_linear(const std::vector<ParameterMap::Point>& points, double x) noexcept {
  if (x <= points.front().value) return points.front().output;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const ParameterMap::Point &a = points[i - 1], &b = points[i];
    if (x < b.value) return a.output + (b.output - a.output) * ((x - a.value) / (b.value - a.value));
  }
  return points.back().output;
}

}  // namespace

double Parameter::of_field(const Vec3& world, field::Cursor& cursor, std::int32_t& evaluations) const noexcept {
  const ParameterMap& map = *map_;
  if (evaluations >= kEvaluationCap) return map.outside;
  ++evaluations;
  double x = 0;
  if (map.field.scalar) {
    const field::ScalarSample sample = map.field.scalar->sample(world, cursor);
    x = map.by == ParameterMap::By::gradient ? norm(sample.gradient) : sample.value;
    if (!sample.inside) return map.outside;
  } else {
    const field::VectorSample sample = map.field.vector->sample(world, cursor);
    x = norm(sample.value);
    if (!sample.inside) return map.outside;
  }
  if (!std::isfinite(x)) return map.outside;
  if (map.normalise) x = map.span > 0 ? std::clamp(x / map.span - map.lo / map.span, 0.0, 1.0) : 0.0;
  return piecewise_linear(map.points, x);
}

double Parameter::least() const {
  if (!map_) return constant_;
  double least = map_->outside;
  for (const ParameterMap::Point& point : map_->points) least = std::min(least, point.output);
  return least;
}

double Parameter::most() const {
  if (!map_) return constant_;
  double most = map_->outside;
  for (const ParameterMap::Point& point : map_->points) most = std::max(most, point.output);
  return most;
}

}  // namespace catena::haptics
