// SPDX-License-Identifier: MIT
#include "engine/geometry/curves/point_set.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "engine/base/numbers.h"

namespace catena::curves {
namespace {

std::atomic<std::uint64_t> next_points_version{1};

/// Median distance of sampled points to their nearest neighbors.
double spacing_of(const std::vector<glm::vec3>& points) {
  constexpr std::size_t kSampled = 64;
  std::vector<double> nearest;
  const std::size_t step = 1 + points.size() / kSampled;
  for (std::size_t i = 0; i < points.size(); i += step) {
    float min_distance2 = std::numeric_limits<float>::infinity();
    for (const glm::vec3& p : points) {
      const glm::vec3 e = p - points[i];
      const float d = e.x * e.x + e.y * e.y + e.z * e.z;
      if (d > 0 && d < min_distance2) min_distance2 = d;
    }
    if (std::isfinite(min_distance2)) nearest.push_back(std::sqrt(static_cast<double>(min_distance2)));
  }
  return quantile(nearest, 0.5);
}

}  // namespace

void PointSet::set_positions(const std::vector<Vec3>& positions) {
  // single precision resolves 2^-24 of a coordinate, which is 1/4096 of an edge at a distance of this many box edges
  constexpr double kFarEdges = 4096;
  Bounds box;
  double max_coordinate = 0;
  for (const Vec3& p : positions) {
    box.extend(p);
    max_coordinate = std::max(max_coordinate, max_abs(p));
  }
  origin = max_coordinate > kFarEdges * max_abs(box.hi - box.lo) ? box.center() : Vec3(0.0);
  points.clear();
  points.reserve(positions.size());
  for (const Vec3& p : positions) points.emplace_back(p - origin);
}

const PointValues* PointSet::find_values(std::string_view value_name) const {
  for (const PointValues& one : values)
    if (one.name == value_name) return &one;
  return nullptr;
}

PointSet complete_points(PointSet set, const std::string& name) {
  set.name = name;
  Bounds box;
  for (std::size_t i = 0; i < set.points.size(); ++i) box.extend(set.position(i));
  set.min_corner = box.lo;
  set.max_corner = box.hi;
  set.robust_bounds = compute_robust_bounds(set.points);
  if (!(set.origin == Vec3(0.0)) && !set.robust_bounds.box.empty())
    set.robust_bounds.box = {set.robust_bounds.box.lo + set.origin, set.robust_bounds.box.hi + set.origin};
  set.median_spacing = spacing_of(set.points);
  set.version = next_points_version.fetch_add(1);
  set.memory_reservation = MemoryReservation(set.bytes());
  return set;
}

}  // namespace catena::curves
