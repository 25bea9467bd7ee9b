// SPDX-License-Identifier: MIT
/// Isosurface in one block of cells, for measuring: triangles with their parts, and the edges that other blocks may share.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/field/measure/parts.h"
#include "engine/geometry/mesh/isosurface_cells.h"

namespace catena::mesh {

/// An edge of a triangle, or several of them. Vertices are numbered by their place in the grid, the smaller number first.
struct SurfaceEdge {
  std::uint64_t a = 0, b = 0;
  std::int32_t net = 0;    ///< edges from a to b, minus those from b to a: 0 where the surface continues
  std::uint32_t part = 0;  ///< part of the triangle

  bool is_same(const SurfaceEdge& other) const { return a == other.a && b == other.b; }
  bool operator<(const SurfaceEdge& other) const { return a != other.a ? a < other.a : b < other.b; }
};

/// Numbers of the vertices of a grid by their place: 4 voxel + kind, voxels x fastest from the first voxel of the box.
class VertexPlaces {
 public:
  explicit VertexPlaces(const field::VoxelBox& box) : box_(box) {}
  std::uint64_t number(const field::Index3& voxel, int kind) const {
    const auto x = static_cast<std::uint64_t>(voxel.x - box_.lo.x), y = static_cast<std::uint64_t>(voxel.y - box_.lo.y);
    const auto z = static_cast<std::uint64_t>(voxel.z - box_.lo.z);
    return ((z * static_cast<std::uint64_t>(box_.size.y) + y) * static_cast<std::uint64_t>(box_.size.x) + x) * 4 +
           static_cast<unsigned>(kind);
  }
  /// Returns true when a vertex is on the slice of voxels with the index z.
  bool is_in_slice(std::uint64_t number, std::int32_t z) const {
    const std::uint64_t slice = static_cast<std::uint64_t>(box_.size.x) * static_cast<std::uint64_t>(box_.size.y);
    return number % 4 != 2 && number / 4 / slice == static_cast<std::uint64_t>(z - box_.lo.z);
  }

 private:
  field::VoxelBox box_;
};

/// Surface in a block.
struct BlockSurface {
  std::vector<Vec3> vertices;  ///< world
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> parts;        ///< part of each triangle
  std::vector<SurfaceEdge> border_edges;   ///< edges on the faces of the block
  std::vector<std::uint32_t> open_inside;  ///< part of each edge inside of the block at which the surface ends
};

/// Returns the surface in the block of cells at `block`, in the order of extract_isosurface() with OutwardSide::lower.
BlockSurface mesh_block(const field::ScalarGrid& grid, double level, const field::Index3& block, const field::MeasuredParts& parts);

}  // namespace catena::mesh
