// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/measure.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/mesh/isosurface.h"
#include "engine/geometry/mesh/triangle_sums.h"

namespace catena::mesh {
namespace {

/// Directed edges without their opposite, as numbers of two vertices: those at which a surface ends.
std::vector<std::uint64_t> open_edges_of(const TriangleSoup& surface) {
  std::vector<std::uint64_t> rising, falling, open;  // edges by their direction, always with the smaller vertex first
  rising.reserve(surface.triangles.size() * 2);      // a triangle has one or two of each
  falling.reserve(surface.triangles.size() * 2);
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = t[k], b = t[(k + 1) % 3];
      (a < b ? rising : falling).push_back(std::min(a, b) << 32 | std::max(a, b));
    }
  std::sort(rising.begin(), rising.end());
  std::sort(falling.begin(), falling.end());
  std::set_symmetric_difference(rising.begin(), rising.end(), falling.begin(), falling.end(), std::back_inserter(open));
  return open;
}

}  // namespace

SurfaceMeasure measure_surface(const TriangleSoup& surface) {
  SurfaceMeasure measure;
  measure.open_edges = open_edges_of(surface).size();
  const Vec3 origin = surface.vertices.empty() ? Vec3(0.0) : surface.vertices.front();
  double volume = 0;
  for (const Triangle& t : surface.triangles) {
    measure.area += area_of(surface.vertices, t);
    volume += volume_of(surface.vertices, t, origin);
  }
  measure.encloses_lower = volume < 0;
  if (measure.open_edges == 0) measure.volume = std::fabs(volume);
  return measure;
}

std::array<double, 256> label_cell_areas(const field::Mapping& mapping) {
  std::array<double, 256> areas{};
  const field::Mapping at_origin = field::Mapping::from_linear(mapping.world_from_index_linear, Vec3(0.0));
  for (unsigned corners = 1; corners < 255; ++corners) {
    std::array<float, 8> values;
    for (unsigned c = 0; c < 8; ++c) values[c] = (corners >> c & 1) != 0 ? 1.f : 0.f;
    const auto cell = field::make_scalar_grid("cell", at_origin, {2, 2, 2}, values);
    const auto surface = extract_isosurface(*cell, 0.5, OutwardSide::lower, "cell");
    CATENA_ASSERT(bool(surface));
    for (const Triangle& t : surface->triangles) areas[corners] += area_of(surface->vertices, t);
  }
  return areas;
}

}  // namespace catena::mesh
