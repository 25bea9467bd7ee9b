// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/measure.h"

#include <algorithm>
#include <cmath>

namespace catena::mesh {
namespace {

using field::Index3;

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

double area_of(const TriangleSoup& surface, const Triangle& t) {
  const Vec3& a = surface.vertices[t[0]];
  return norm(cross(surface.vertices[t[1]] - a, surface.vertices[t[2]] - a)) / 2;
}

/// Returns the part of the voxel above the level at the cell edge on which a vertex lies.
std::optional<std::uint32_t> part_of_vertex(const Vec3& index, const field::PartMap& map) {
  const Vec3 voxel(std::round(index.x), std::round(index.y), std::round(index.z));
  const auto at = [&](const Vec3& v) {
    return map.part_at({static_cast<std::int32_t>(v.x), static_cast<std::int32_t>(v.y), static_cast<std::int32_t>(v.z)});
  };
  if (const auto part = at(voxel)) return part;
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(index[a] - voxel[a]) > std::fabs(index[axis] - voxel[axis])) axis = a;
  Vec3 other = voxel;
  other[axis] += index[axis] < voxel[axis] ? -1 : 1;
  return at(other);
}

}  // namespace

SurfaceMeasure measure_surface(const TriangleSoup& surface) {
  SurfaceMeasure measure;
  measure.open_edges = open_edges_of(surface).size();
  const Vec3 origin = surface.vertices.empty() ? Vec3(0.0) : surface.vertices.front();
  double volume = 0;
  for (const Triangle& t : surface.triangles) {
    measure.area += area_of(surface, t);
    volume += dot(surface.vertices[t[0]] - origin, cross(surface.vertices[t[1]] - origin, surface.vertices[t[2]] - origin)) / 6;
  }
  measure.encloses_lower = volume < 0;
  if (measure.open_edges == 0) measure.volume = std::fabs(volume);
  return measure;
}

std::vector<PartSurface> measure_part_surfaces(const TriangleSoup& surface, const field::Mapping& mapping,
                                               const field::MeasuredParts& parts) {
  std::vector<std::uint8_t> open(surface.vertices.size(), 0);
  for (const std::uint64_t edge : open_edges_of(surface)) open[edge >> 32] = open[edge & 0xffffffff] = 1;
  const auto others = static_cast<std::uint32_t>(parts.parts.size());
  std::vector<PartSurface> measured(parts.parts.size() + 1);
  for (const Triangle& t : surface.triangles) {
    std::optional<std::uint32_t> part;
    for (std::size_t k = 0; k < 3 && !part; ++k) part = part_of_vertex(mapping.index_from_world(surface.vertices[t[k]]), parts.map);
    PartSurface& of = measured[part.value_or(others)];
    of.area += area_of(surface, t);
    ++of.triangles;
    int ends = 0;
    for (const std::uint32_t v : t) ends += open[v];
    of.is_closed = of.is_closed && ends < 2;
  }
  return measured;
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
    for (const Triangle& t : surface->triangles) areas[corners] += area_of(*surface, t);
  }
  return areas;
}

}  // namespace catena::mesh
