// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/isosurface_block.h"

namespace catena::mesh {
namespace {

using field::Index3;

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Vertices of a block, numbered in the order in which CellMesher asks for them.
class BlockVertices {
 public:
  BlockVertices(const field::ScalarGrid& grid, const Index3& block, const field::PartMap& map, std::vector<Vec3>& positions)
      : grid_(grid), block_(block), map_(map), positions_(positions), places_(map.box) {
    numbers_.fill(kNone);
  }

  std::uint32_t on_edge(const EdgeVertex& vertex) {
    const Index3 at{vertex.voxel.x - block_.x, vertex.voxel.y - block_.y, vertex.voxel.z - block_.z};
    std::uint32_t& number = numbers_[static_cast<std::size_t>(((at.z * kWide + at.y) * kWide + at.x) * 4 + vertex.kind)];
    if (number != kNone) return number;
    number = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(grid_.mapping().world_from_index(vertex.index));
    place.push_back(places_.number(vertex.voxel, vertex.kind));
    part.push_back(map_.part_at(vertex.above).value_or(kNone));
    const std::int32_t along[3] = {at.x, at.y, at.z};
    unsigned on = 0;
    for (int a = 0; a < 3; ++a) {
      if (a == vertex.kind) continue;
      if (along[a] == 0) on |= 1u << a;
      if (along[a] == kSurfaceBlock) on |= 8u << a;
    }
    faces.push_back(static_cast<std::uint8_t>(on));
    return number;
  }
  void add_cell(std::uint32_t, const std::array<double, 8>&, const Vec3&) {}
  std::uint32_t add_inner(const Vec3& index, const Vec3&) {
    positions_.push_back(grid_.mapping().world_from_index(index));
    place.push_back(0);
    part.push_back(kNone);
    faces.push_back(0);
    return static_cast<std::uint32_t>(positions_.size() - 1);
  }
  const Vec3& position(std::uint32_t number) const { return positions_[number]; }

  std::vector<std::uint64_t> place;  ///< of each vertex; unused inside of a cell
  std::vector<std::uint32_t> part;   ///< part of the voxel above the level; kNone inside of a cell
  std::vector<std::uint8_t> faces;   ///< faces of the block on which a vertex lies

 private:
  static constexpr int kWide = kSurfaceBlock + 1;

  const field::ScalarGrid& grid_;
  Index3 block_;
  const field::PartMap& map_;
  std::vector<Vec3>& positions_;
  VertexPlaces places_;
  std::array<std::uint32_t, 4 * kWide * kWide * kWide> numbers_;
};

/// An edge inside of a block, at its vertex with the smaller number.
struct InnerEdge {
  std::uint32_t other = 0, part = 0;
  std::int32_t direction = 0;  ///< 1: to the other vertex; -1: from it
};

/// Finds the edges without their opposite; `starts`: first edge of each vertex, and the number of edges.
void add_open_edges(const std::vector<std::uint32_t>& starts, std::vector<InnerEdge>& edges, std::vector<std::uint32_t>& open) {
  for (std::size_t v = 0; v + 1 < starts.size(); ++v)
    for (std::uint32_t i = starts[v]; i < starts[v + 1]; ++i) {
      if (edges[i].direction == 0) continue;
      std::int32_t net = edges[i].direction;
      for (std::uint32_t j = i + 1; j < starts[v + 1]; ++j)
        if (edges[j].other == edges[i].other) net += std::exchange(edges[j].direction, 0);
      open.insert(open.end(), static_cast<std::size_t>(std::abs(net)), edges[i].part);
    }
}

/// Separates the edges on the faces of the block from those inside, of which open ones remain.
void collect_edges(const BlockVertices& vertices, BlockSurface& made) {
  const auto is_inside = [&](std::uint32_t a, std::uint32_t b) { return (vertices.faces[a] & vertices.faces[b]) == 0; };
  std::vector<std::uint32_t> starts(made.vertices.size() + 1, 0);
  for (const Triangle& t : made.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::uint32_t a = t[k], b = t[(k + 1) % 3]; is_inside(a, b)) ++starts[std::min(a, b)];
  std::uint32_t count = 0;
  for (std::uint32_t& start : starts) start = count += start;  // the end of each vertex, moved to its start below
  std::vector<InnerEdge> inner(count);
  for (std::size_t n = 0; n < made.triangles.size(); ++n)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = made.triangles[n][k], b = made.triangles[n][(k + 1) % 3];
      if (is_inside(a, b)) {
        inner[--starts[std::min(a, b)]] = {std::max(a, b), made.parts[n], a < b ? 1 : -1};
      } else {
        const std::uint64_t from = vertices.place[a], to = vertices.place[b];
        made.border_edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1, made.parts[n]});
      }
    }
  add_open_edges(starts, inner, made.open_inside);
}

}  // namespace

BlockSurface mesh_block(const field::ScalarGrid& grid, double level, const Index3& block, const field::MeasuredParts& parts) {
  BlockSurface made;
  BlockVertices vertices(grid, block, parts.map, made.vertices);
  CellMesher(grid, level, OutwardSide::lower, vertices, made.triangles).add_block(block);
  for (const Triangle& t : made.triangles) {
    std::uint32_t part = kNone;
    for (std::size_t k = 0; k < 3 && part == kNone; ++k) part = vertices.part[t[k]];
    made.parts.push_back(part == kNone ? static_cast<std::uint32_t>(parts.parts.size()) : part);
  }
  collect_edges(vertices, made);
  return made;
}

}  // namespace catena::mesh
