// SPDX-License-Identifier: MIT
/// Bounding volume hierarchy (BVH) over the faces of a mesh: binary, flat, the boxes of two children in one cache line, leaves of at most
/// four consecutive faces. Split by the surface-area heuristic (16 bins), by halves where the tree would become too deep.
/// Boxes are floats, rounded outward. Built off the haptic thread; a traversal is bounded by its node budget and a fixed stack.
/// Curves and polylines have trees of their own (engine/geometry/flow/curve.h, haptics/constraints/shapes/polyline_bvh.h): the traversal
/// order decides which of several equally near points is returned and what an interrupted traversal has visited; recordings rely on it.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/vec.h"

namespace catena::mesh {

/// Bounding box of one face, in the local frame of the mesh.
struct FaceBox {
  Vec3 lo{0.0}, hi{0.0};  ///< Minimum and maximum corner.
};

/// Inner node: the boxes of its two children in one cache line.
struct alignas(64) BvhNode {
  std::array<float, 3> lo[2], hi[2];     ///< Corners of the children's boxes, rounded outward.
  std::int32_t child[2] = {-1, -1};      ///< >= 0: index of a node; < 0: ~index of the first face of a leaf.
  std::array<std::uint16_t, 2> count{};  ///< Number of faces of a leaf; 0 with child < 0: no child.
  /// Padding to a full cache line.
  std::array<std::uint32_t, 1> unused_{};
};
static_assert(sizeof(BvhNode) == 64);

/// The hierarchy. Traversals do not allocate and may run on the haptic thread.
class CATENA_EXPORT Bvh {
 public:
  static constexpr int kStackSize = 64;  ///< Maximum number of pending nodes in a traversal.

  /// Builds the hierarchy over `boxes`. `order` receives the permutation of the faces: leaf ranges refer to it. Off the haptic thread.
  void build(const std::vector<FaceBox>& boxes, std::vector<std::uint32_t>& order);
  /// Memory used by the nodes, bytes.
  std::size_t bytes() const { return nodes_.size() * sizeof(BvhNode); }

  /// Calls visit(face) for every face whose box, grown by `margin`, intersects the segment from..to. `visit` may shorten the segment
  /// through the reference `to`. Returns false when `budget` (number of nodes, counted down) is exhausted.
  template <class Visit>
  bool visit_segment(const Vec3& from, const Vec3& to, double margin, int& budget, Visit&& visit) const noexcept;

  /// Calls visit(face) for the faces whose boxes are closer to `p` than sqrt(bound2), nearest boxes first; `visit` may lower the bound
  /// through the reference. Returns false when `budget` (number of nodes, counted down) is exhausted.
  template <class Visit>
  bool visit_nearest(const Vec3& p, const double& bound2, int& budget, Visit&& visit) const noexcept;

 private:
  struct Builder;
  std::vector<BvhNode> nodes_;
};

template <class Visit>
bool Bvh::visit_segment(const Vec3& from, const Vec3& to, double margin, int& budget, Visit&& visit) const noexcept {
  std::array<std::int32_t, kStackSize> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    if (--budget < 0) return false;
    const BvhNode& node = nodes_[static_cast<std::size_t>(stack[--top])];
    const Vec3 middle = (from + to) * 0.5, half = (to - from) * 0.5;
    const Vec3 a(std::fabs(half.x), std::fabs(half.y), std::fabs(half.z));
    bool overlaps[2];
    double along[2];
    for (int k = 0; k < 2; ++k) {
      const auto &lo = node.lo[k], &hi = node.hi[k];
      const Vec3 m(middle.x - 0.5 * (static_cast<double>(lo[0]) + hi[0]), middle.y - 0.5 * (static_cast<double>(lo[1]) + hi[1]),
                   middle.z - 0.5 * (static_cast<double>(lo[2]) + hi[2]));
      const Vec3 h(0.5 * (static_cast<double>(hi[0]) - lo[0]) + margin, 0.5 * (static_cast<double>(hi[1]) - lo[1]) + margin,
                   0.5 * (static_cast<double>(hi[2]) - lo[2]) + margin);
      along[k] = -dot(m, half);
      overlaps[k] = std::fabs(m.x) <= h.x + a.x && std::fabs(m.y) <= h.y + a.y && std::fabs(m.z) <= h.z + a.z &&
                    std::fabs(m.y * half.z - m.z * half.y) <= h.y * a.z + h.z * a.y + margin * 1e-3 &&
                    std::fabs(m.z * half.x - m.x * half.z) <= h.z * a.x + h.x * a.z + margin * 1e-3 &&
                    std::fabs(m.x * half.y - m.y * half.x) <= h.x * a.y + h.y * a.x + margin * 1e-3;
    }
    const int first = along[1] < along[0] ? 1 : 0;
    int later[2], pending = 0;
    for (const int k : {first, 1 - first}) {
      if (!overlaps[k]) continue;
      if (node.child[k] >= 0) {
        later[pending++] = node.child[k];
      } else {
        const auto begin = static_cast<std::uint32_t>(~node.child[k]);
        for (std::uint32_t f = begin; f < begin + node.count[static_cast<std::size_t>(k)]; ++f) visit(f);
      }
    }
    while (pending > 0 && top < kStackSize) stack[static_cast<std::size_t>(top++)] = later[--pending];
  }
  return true;
}

template <class Visit>
bool Bvh::visit_nearest(const Vec3& p, const double& bound2, int& budget, Visit&& visit) const noexcept {
  struct Entry {
    double distance2;
    std::int32_t node;
  };
  std::array<Entry, kStackSize> stack;
  int top = 0;
  stack[static_cast<std::size_t>(top++)] = {0, 0};
  while (top > 0) {
    const Entry entry = stack[static_cast<std::size_t>(--top)];
    if (entry.distance2 > bound2) continue;
    if (--budget < 0) return false;
    const BvhNode& node = nodes_[static_cast<std::size_t>(entry.node)];
    double distance2[2];
    for (int k = 0; k < 2; ++k) {
      distance2[k] = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double c = p[static_cast<int>(i)];
        const double gap = std::max(0.0, std::max(static_cast<double>(node.lo[k][i]) - c, c - static_cast<double>(node.hi[k][i])));
        distance2[k] += gap * gap;
      }
    }
    const int first = distance2[1] < distance2[0] ? 1 : 0;
    Entry later[2];
    int pending = 0;
    for (const int k : {first, 1 - first}) {
      if (distance2[k] > bound2) continue;
      if (node.child[k] >= 0) {
        later[pending++] = {distance2[k], node.child[k]};
      } else {
        const auto begin = static_cast<std::uint32_t>(~node.child[k]);
        for (std::uint32_t f = begin; f < begin + node.count[static_cast<std::size_t>(k)]; ++f) visit(f);
      }
    }
    while (pending > 0 && top < kStackSize) stack[static_cast<std::size_t>(top++)] = later[--pending];
  }
  return true;
}

}  // namespace catena::mesh
