// SPDX-License-Identifier: MIT
#include "engine/scene/uniform_sampling.h"

#include <algorithm>
#include <cmath>

namespace catena::scene {
namespace {

constexpr double kCornersLost = 4;   ///< upper bound of the area of the bounding rectangle of a section, relative to the section
constexpr double kOnTheEdge = 1e-9;  ///< tolerance for rounding, as a fraction of a step or of a voxel
constexpr double kMaxAnAxis = 1 << 24;

/// Returns the intersections of the plane with the twelve edges of the domain.
std::vector<Vec3> section_corners(const Domain& domain, const Vec3& point, const Vec3& normal) {
  const auto corner = [&](int i) { return field::world_corner(domain.mapping, domain.box, i); };
  double max_extent = 0;
  for (int i = 0; i < 8; ++i) max_extent = std::max(max_extent, std::fabs(dot(normal, corner(i) - corner(0))));
  const double slack = kOnTheEdge * max_extent;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    for (int step = 1; step < 8; step *= 2) {
      if ((i & step) != 0) continue;
      const Vec3 a = corner(i), b = corner(i | step);
      const double from = dot(normal, a - point), to = dot(normal, b - point);
      if (std::fabs(from) <= slack) corners.push_back(a);
      if (std::fabs(to) <= slack) corners.push_back(b);
      if ((from < -slack && to > slack) || (from > slack && to < -slack)) corners.push_back(a + from / (from - to) * (b - a));
    }
  return corners;
}

}  // namespace

UniformSamples sample_plane(const Domain& domain, const Vec3& point, const Vec3& normal, double spacing, std::size_t max_count) {
  const Vec3 n = direction(normal);
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(n[a]) < std::fabs(n[axis])) axis = a;
  Vec3 along(0.0);
  along[axis] = 1;
  const Vec3 u = direction(along - dot(along, n) * n), v = cross(n, u);
  const Vec3 centre = domain.mapping.world_from_index(0.5 * (domain.box.lo + domain.box.hi)), origin = centre - dot(centre - point, n) * n;

  // rows and columns of the sampling grid that cover the section
  double min_u = HUGE_VAL, max_u = -HUGE_VAL, min_v = HUGE_VAL, max_v = -HUGE_VAL;
  for (const Vec3& corner : section_corners(domain, point, n)) {
    const double a = dot(corner - origin, u), b = dot(corner - origin, v);
    min_u = std::min(min_u, a), max_u = std::max(max_u, a);
    min_v = std::min(min_v, b), max_v = std::max(max_v, b);
  }
  UniformSamples even;
  if (!(min_u <= max_u)) return even;
  const double row = std::sqrt(0.75) * spacing;
  even.expected_count = ((max_u - min_u) / spacing + 1) * ((max_v - min_v) / row + 1);
  if (!(even.expected_count <= kCornersLost * static_cast<double>(max_count) + 1000) || (max_u - min_u) / spacing > kMaxAnAxis ||
      (max_v - min_v) / row > kMaxAnAxis)
    return even;
  for (double j = std::ceil(min_v / row - kOnTheEdge); j <= max_v / row + kOnTheEdge; ++j) {
    const double shift = std::fmod(j, 2) == 0 ? 0 : 0.5;
    for (double i = std::ceil(min_u / spacing - shift - kOnTheEdge); i + shift <= max_u / spacing + kOnTheEdge; ++i) {
      const Vec3 position = origin + (i + shift) * spacing * u + j * row * v;
      if (domain.box.contains(domain.mapping.index_from_world(position), kOnTheEdge)) even.positions.push_back(position);
    }
  }
  even.expected_count = static_cast<double>(even.positions.size());
  if (even.positions.size() > max_count) even.positions.clear();
  return even;
}

UniformSamples sample_box(const Domain& domain, double spacing, std::size_t max_count) {
  const Vec3 low = domain.mapping.world_from_index(domain.box.lo);
  Vec3 steps[3], first = low;
  double count[3];
  UniformSamples even;
  even.expected_count = 1;
  for (int a = 0; a < 3; ++a) {
    Vec3 edge(0.0);
    edge[a] = domain.box.hi[a] - domain.box.lo[a];
    edge = domain.mapping.world_from_index_linear * edge;
    const double length = norm(edge);
    count[a] = std::floor(length / spacing + kOnTheEdge) + 1;
    even.expected_count *= count[a];
    steps[a] = spacing * direction(edge);
    first += 0.5 * edge - (0.5 * (count[a] - 1)) * steps[a];
  }
  if (!(even.expected_count <= static_cast<double>(max_count))) return even;
  even.positions.reserve(static_cast<std::size_t>(even.expected_count));
  for (double k = 0; k < count[2]; ++k)
    for (double j = 0; j < count[1]; ++j)
      for (double i = 0; i < count[0]; ++i) even.positions.push_back(first + i * steps[0] + j * steps[1] + k * steps[2]);
  return even;
}

}  // namespace catena::scene
