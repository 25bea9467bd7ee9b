// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"
#include "engine/geometry/mesh/isosurface_block.h"
#include "engine/geometry/mesh/measure.h"
#include "engine/geometry/mesh/triangle_sums.h"

namespace catena::mesh {
namespace {

/// Blocks whose triangles are in memory at one time.
constexpr std::size_t kBlocksAtOnce = 64;

/// Sums over the blocks of a surface, in their order.
class SurfaceSums {
 public:
  SurfaceSums(const field::MeasuredParts& parts) : places_(parts.map.box) { made_.parts.resize(parts.parts.size() + 1); }

  void add(const BlockSurface& block) {
    if (!has_origin_ && !block.vertices.empty()) origin_ = block.vertices.front(), has_origin_ = true;
    for (std::size_t n = 0; n < block.triangles.size(); ++n) {
      const double area = area_of(block.vertices, block.triangles[n]);
      made_.area += area;
      volume_ += volume_of(block.vertices, block.triangles[n], origin_);
      PartSurface& part = made_.parts[block.parts[n]];
      part.area += area;
      ++part.triangles;
    }
    has_triangles_ = has_triangles_ || !block.triangles.empty();
    edges_.insert(edges_.end(), block.border_edges.begin(), block.border_edges.end());
    for (const std::uint32_t part : block.open_inside) add_open(part, 1);
  }

  /// Counts the open edges of the blocks so far. Those on the slice of voxels z may continue in the next layer of blocks.
  void close_layer(std::int32_t z) {
    std::sort(edges_.begin(), edges_.end());
    std::size_t kept = 0;
    for (std::size_t from = 0, to = 0; from < edges_.size(); from = to) {
      SurfaceEdge edge = edges_[from];
      for (to = from + 1; to < edges_.size() && edges_[to].is_same(edge); ++to) edge.net += edges_[to].net;
      if (edge.net == 0) continue;
      if (places_.is_in_slice(edge.a, z) && places_.is_in_slice(edge.b, z))
        edges_[kept++] = edge;
      else
        add_open(edge.part, static_cast<std::uint64_t>(std::abs(edge.net)));
    }
    edges_.resize(kept);
  }

  std::size_t edge_bytes() const { return edges_.size() * sizeof(SurfaceEdge); }
  bool has_triangles() const { return has_triangles_; }

  /// Returns the result; after the last layer.
  SurfaceMeasure take() {
    for (const SurfaceEdge& edge : std::exchange(edges_, {})) add_open(edge.part, static_cast<std::uint64_t>(std::abs(edge.net)));
    made_.encloses_lower = volume_ < 0;
    if (made_.open_edges == 0) made_.volume = std::fabs(volume_);
    return std::move(made_);
  }

 private:
  void add_open(std::uint32_t part, std::uint64_t edges) {
    made_.open_edges += edges;
    made_.parts[part].is_closed = false;
  }

  SurfaceMeasure made_;
  VertexPlaces places_;
  bool has_origin_ = false, has_triangles_ = false;
  Vec3 origin_{0.0};  ///< first vertex, near which the volumes lose no digits
  double volume_ = 0;
  std::vector<SurfaceEdge> edges_;  ///< edges that later blocks may share
};

}  // namespace

Result<SurfaceMeasure> measure_isosurface(const field::ScalarGrid& grid, double level, const field::MeasuredParts& parts,
                                          const std::string& name, const std::function<void(double)>& progress) {
  const std::uint64_t allowed = available_memory();
  CATENA_TRY(SurfaceBlocks blocks, SurfaceBlocks::of(grid, level, name));
  SurfaceSums sums(parts);
  for (std::int64_t k = 0; k < blocks.layers(); ++k) {
    const std::vector<field::Index3> layer = blocks.next_layer();
    for (std::size_t first = 0; first < layer.size(); first += kBlocksAtOnce) {
      std::vector<BlockSurface> made(std::min(kBlocksAtOnce, layer.size() - first));
      parallel_for(made.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) made[n] = mesh_block(grid, level, layer[first + n], parts);
      });
      for (const BlockSurface& block : made) sums.add(block);
      constexpr double kGrowth = 2;  // vectors double their capacity
      CATENA_CHECK(check_memory_available(name + ": the surface", kGrowth * static_cast<double>(sums.edge_bytes()), allowed));
    }
    if (!layer.empty()) sums.close_layer(layer.front().z + kSurfaceBlock);
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(blocks.layers()));
  }
  if (!sums.has_triangles()) return no_surface(level, name);
  return sums.take();
}

}  // namespace catena::mesh
