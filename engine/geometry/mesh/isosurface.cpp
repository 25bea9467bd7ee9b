// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/isosurface.h"

#include <fmt/format.h>

#include <unordered_map>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/geometry/mesh/isosurface_cells.h"

namespace catena::mesh {
namespace {

using field::Index3;

/// All vertices of a surface with their normals; CellMesher numbers them.
class StoredVertices {
 public:
  StoredVertices(const field::ScalarGrid& grid, Isosurface& made) : grid_(grid), made_(made) {
    const Vec3 &lo = grid.index_box().lo, &hi = grid.index_box().hi;
    for (int a = 0; a < 3; ++a) {
      lo_[a] = static_cast<std::int64_t>(lo[a]);
      size_[a] = static_cast<std::uint64_t>(static_cast<std::int64_t>(hi[a]) - lo_[a] + 1);
    }
  }

  std::uint32_t on_edge(const EdgeVertex& vertex) {
    const auto number = [&](std::int32_t at, int a) { return static_cast<std::uint64_t>(at - lo_[a]); };
    const std::uint64_t voxel = (number(vertex.voxel.z, 2) * size_[1] + number(vertex.voxel.y, 1)) * size_[0] + number(vertex.voxel.x, 0);
    const auto [found, inserted] =
        numbers_.try_emplace(voxel * 4 + static_cast<unsigned>(vertex.kind), static_cast<std::uint32_t>(made_.vertices.size()));
    if (inserted) {
      made_.vertices.push_back(grid_.mapping().world_from_index(vertex.index));
      made_.normals.emplace_back(0.0);
    }
    return found->second;
  }
  void add_cell(std::uint32_t number, const std::array<double, 8>& corner, const Vec3& in_cell) {
    double value;
    Vec3 gradient;
    field::trilinear(corner, in_cell, value, gradient);
    made_.normals[number] += grid_.mapping().world_from_index_gradient(gradient);
  }
  std::uint32_t add_inner(const Vec3& index, const Vec3& gradient) {
    made_.vertices.push_back(grid_.mapping().world_from_index(index));
    made_.normals.push_back(grid_.mapping().world_from_index_gradient(gradient));
    return static_cast<std::uint32_t>(made_.vertices.size() - 1);
  }
  const Vec3& position(std::uint32_t number) const { return made_.vertices[number]; }

 private:
  const field::ScalarGrid& grid_;
  Isosurface& made_;
  std::int64_t lo_[3];     ///< first voxel of the grid
  std::uint64_t size_[3];  ///< voxels per axis
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
};

Outcome check_memory(const Isosurface& made, const std::string& name, std::uint64_t allowed) {
  constexpr double kVertex = 2 * sizeof(Vec3) + 48, kGrowth = 2;  // with its entry in the hash table; vectors double their capacity
  const double bytes =
      kGrowth * (kVertex * static_cast<double>(made.vertices.size()) + sizeof(Triangle) * static_cast<double>(made.triangles.size()));
  return check_memory_available(name + ": the surface", bytes, allowed);
}

}  // namespace

Result<Isosurface> extract_isosurface(const field::ScalarGrid& grid, double level, OutwardSide outside, const std::string& name,
                                      const std::function<void(double)>& progress) {
  const std::uint64_t allowed = available_memory();
  CATENA_TRY(SurfaceBlocks blocks, SurfaceBlocks::of(grid, level, name));
  Isosurface made;
  StoredVertices vertices(grid, made);
  CellMesher mesher(grid, level, outside, vertices, made.triangles);
  for (std::int64_t k = 0; k < blocks.layers(); ++k) {
    for (const Index3& block : blocks.next_layer()) {
      mesher.add_block(block);
      CATENA_CHECK(check_memory(made, name, allowed));
    }
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(blocks.layers()));
  }
  if (made.triangles.empty()) return no_surface(level, name);
  const double sign = outside == OutwardSide::lower ? -1 : 1;
  for (Vec3& normal : made.normals) normal = sign * direction(normal);
  return made;
}

Error no_surface(double level, const std::string& name) {
  return Error{
      fmt::format("{}: there is no surface at {}; a level between the values of adjacent voxels was expected", name, to_text(level))};
}

}  // namespace catena::mesh
