// SPDX-License-Identifier: MIT
#include "haptics/constraints/mesh/mesh_walk.h"

namespace catena::haptics {

void PlaneConstraints::try_candidate(const Vec3& x, const Vec3& q, const std::array<int, 3>& binding, int count,
                                     PlaneSolution& best) const noexcept {
  for (int i = 0; i < count_; ++i)
    if (gap(i, q) < -0.25 * kGodObjectGap) return;
  if (best.found && dot(q - x, q - x) >= dot(best.q - x, best.q - x)) return;
  best = {q, binding, count, true};
}

void PlaneConstraints::try_edge(const Vec3& x, int a, int b, PlaneSolution& best) const noexcept {
  const Vec3 along = cross(normal(a), normal(b));
  const double det = dot(along, along), c = dot(normal(a), normal(b));
  if (!(det > 1e-24)) return;
  Vec3 q = x;
  for (int pass = 0; pass < 2; ++pass) {
    const double ra = -gap(a, q), rb = -gap(b, q);
    const double la = (ra - c * rb) / det, lb = (rb - c * ra) / det;
    if (pass == 0 && (la < 0 || lb < 0)) return;
    q += la * normal(a) + lb * normal(b);
  }
  try_candidate(x, q, {a, b, 0}, 2, best);
}

void PlaneConstraints::try_corner(const Vec3& x, int a, int b, int c, PlaneSolution& best) const noexcept {
  const Vec3 bc = cross(normal(b), normal(c)), ca = cross(normal(c), normal(a)), ab = cross(normal(a), normal(b));
  const double det = dot(normal(a), bc);
  if (!(std::fabs(det) > 1e-12)) return;
  Vec3 q(0.0);
  for (int pass = 0; pass < 3; ++pass) q -= (gap(a, q) * bc + gap(b, q) * ca + gap(c, q) * ab) / det;
  try_candidate(x, q, {a, b, c}, 3, best);
}

PlaneSolution PlaneConstraints::closest(const Vec3& x) const noexcept {
  PlaneSolution best;
  bool free = true;
  for (int i = 0; i < count_; ++i) free = free && gap(i, x) >= -kGodObjectGap;
  if (free) return {x, {}, 0, true};
  for (int a = 0; a < count_; ++a) {
    if (gap(a, x) > 0) continue;
    Vec3 q = x - gap(a, x) * normal(a);
    q -= gap(a, q) * normal(a);
    try_candidate(x, q, {a, 0, 0}, 1, best);
  }
  for (int a = 0; a < count_; ++a)
    for (int b = a + 1; b < count_; ++b) try_edge(x, a, b, best);
  for (int a = 0; a < count_; ++a)
    for (int b = a + 1; b < count_; ++b)
      for (int c = b + 1; c < count_; ++c) try_corner(x, a, b, c, best);
  return best;
}

namespace {

constexpr double kSeam = 1e-7;
constexpr int kSeamNodes = 64;

}  // namespace

MeshWalkResult walk_mesh(const mesh::TriangleMesh& mesh, std::uint32_t face, const Vec3& x) noexcept {
  MeshWalkResult walk;
  walk.closest = mesh::closest_point_on_face(mesh, face, x);
  int& faces = walk.faces;
  faces = 1;
  while (true) {
    const mesh::ClosestPoint from = walk.closest;
    const auto offer = [&](std::uint32_t f) {
      if (f == from.face) return;
      ++faces;
      const mesh::ClosestPoint c = mesh::closest_point_on_face(mesh, f, x);
      if (c.distance2 < walk.closest.distance2) walk.closest = c;
    };
    if (from.corner >= 0) {
      for (const std::uint32_t f : mesh.faces_around(mesh.triangles()[from.face][static_cast<std::size_t>(from.corner)])) {
        if (faces >= kMaxWalkFaces) return walk;
        offer(f);
      }
    } else if (from.edge >= 0) {
      mesh::for_each_adjacent_face(mesh, from.face, from.edge, offer);
    }
    if (walk.closest.distance2 >= from.distance2 && mesh::is_on_boundary(mesh, from)) {
      double bound2 = kSeam * kSeam;
      int nodes = kSeamNodes;
      mesh.bvh().visit_nearest(from.point, bound2, nodes, [&](std::uint32_t f) {
        const mesh::ClosestPoint near = mesh::closest_point_on_face(mesh, f, from.point);
        if (near.distance2 <= bound2 && faces < kMaxWalkFaces) offer(f);
      });
    }
    if (walk.closest.distance2 >= from.distance2) {
      walk.complete = true;
      return walk;
    }
    if (faces >= kMaxWalkFaces) return walk;
  }
}

}  // namespace catena::haptics
