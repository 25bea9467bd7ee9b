#include "haptics/constraints/mesh/walk.h"

namespace catena::haptics {

void Planes::offer(const Vec3& x, const Vec3& q, const std::array<int, 3>& binding, int count, Solution& best) const noexcept {
  for (int i = 0; i < count_; ++i)
    if (gap(i, q) < -0.25 * kGap) return;
  if (best.found && dot(q - x, q - x) >= dot(best.q - x, best.q - x)) return;
  best = {q, binding, count, true};
}

void Planes::on_line(const Vec3& x, int a, int b, Solution& best) const noexcept {
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
  offer(x, q, {a, b, 0}, 2, best);
}

void Planes::at_corner(const Vec3& x, int a, int b, int c, Solution& best) const noexcept {
  const Vec3 bc = cross(normal(b), normal(c)), ca = cross(normal(c), normal(a)), ab = cross(normal(a), normal(b));
  const double det = dot(normal(a), bc);
  if (!(std::fabs(det) > 1e-12)) return;
  Vec3 q(0.0);
  for (int pass = 0; pass < 3; ++pass) q -= (gap(a, q) * bc + gap(b, q) * ca + gap(c, q) * ab) / det;
  offer(x, q, {a, b, c}, 3, best);
}

Solution Planes::closest(const Vec3& x) const noexcept {
  Solution best;
  bool free = true;
  for (int i = 0; i < count_; ++i) free = free && gap(i, x) >= -kGap;
  if (free) return {x, {}, 0, true};
  for (int a = 0; a < count_; ++a) {
    if (gap(a, x) > 0) continue;
    Vec3 q = x - gap(a, x) * normal(a);
    q -= gap(a, q) * normal(a);
    offer(x, q, {a, 0, 0}, 1, best);
  }
  for (int a = 0; a < count_; ++a)
    for (int b = a + 1; b < count_; ++b) on_line(x, a, b, best);
  for (int a = 0; a < count_; ++a)
    for (int b = a + 1; b < count_; ++b)
      for (int c = b + 1; c < count_; ++c) at_corner(x, a, b, c, best);
  return best;
}

namespace {

constexpr double kSeam = 1e-7;
constexpr int kSeamNodes = 64;

}  // namespace

MeshWalk walk_mesh(const mesh::TriangleMesh& mesh, std::uint32_t face, const Vec3& x) noexcept {
  MeshWalk walk;
  walk.at = mesh::closest_on_face(mesh, face, x);
  int& faces = walk.faces;
  faces = 1;
  while (true) {
    const mesh::Closest from = walk.at;
    const auto offer = [&](std::uint32_t f) {
      if (f == from.face) return;
      ++faces;
      const mesh::Closest c = mesh::closest_on_face(mesh, f, x);
      if (c.distance2 < walk.at.distance2) walk.at = c;
    };
    if (from.corner >= 0) {
      for (const std::uint32_t f : mesh.fan(mesh.triangles()[from.face][static_cast<std::size_t>(from.corner)])) {
        if (faces >= kFaces) return walk;
        offer(f);
      }
    } else if (from.edge >= 0) {
      mesh::each_across(mesh, from.face, from.edge, offer);
    }
    if (walk.at.distance2 >= from.distance2 && mesh::on_border(mesh, from)) {
      double bound2 = kSeam * kSeam;
      int nodes = kSeamNodes;
      mesh.bvh().nearest(from.point, bound2, nodes, [&](std::uint32_t f) {
        const mesh::Closest near = mesh::closest_on_face(mesh, f, from.point);
        if (near.distance2 <= bound2 && faces < kFaces) offer(f);
      });
    }
    if (walk.at.distance2 >= from.distance2) {
      walk.complete = true;
      return walk;
    }
    if (faces >= kFaces) return walk;
  }
}

}  // namespace catena::haptics
