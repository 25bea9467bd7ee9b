#include "engine/mesh/closest.h"

namespace catena::mesh {
Closest closest_on_face(const TriangleMesh& mesh, std::uint32_t f, const Vec3& p) noexcept {
  const Face& face = mesh.face(f);
  Closest best;
  best.face = f;
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (dot(face.side[at], p) - face.limit[at] >= 0) continue;
    const Vec3 &a = mesh.corner(f, k), &b = mesh.corner(f, (k + 1) % 3);
    const Vec3 edge = b - a;
    const double part = dot(p - a, edge) / dot(edge, edge);
    Closest c;
    c.face = f;
    c.edge = static_cast<std::int8_t>(k);
    if (part <= 0) {
      c.point = a;
      c.corner = c.edge;
    } else if (part >= 1) {
      c.point = b;
      c.corner = static_cast<std::int8_t>((k + 1) % 3);
    } else {
      c.point = part < 0.5 ? a + part * edge : b - (1 - part) * edge;
    }
    c.distance2 = dot(p - c.point, p - c.point);
    if (inside || c.distance2 < best.distance2) best = c;
    inside = false;
  }
  if (!inside) return best;
  best.point = p - face.normal * face.height(p);
  best.point -= face.normal * face.height(best.point);
  best.distance2 = dot(p - best.point, p - best.point);
  return best;
}

Nearest nearest_point(const TriangleMesh& mesh, const Vec3& p, double radius, int& budget, std::uint32_t hint) noexcept {
  Nearest out;
  double bound2 = radius * radius;
  const auto offer = [&](std::uint32_t f) {
    const Closest c = closest_on_face(mesh, f, p);
    if (c.distance2 < bound2 || (!out.found && c.distance2 <= bound2)) {
      bound2 = c.distance2;
      out.at = c;
      out.found = true;
    }
  };
  offer(hint);
  out.complete = mesh.bvh().nearest(p, bound2, budget, offer);
  return out;
}

Vec3 normal_at(const TriangleMesh& mesh, const Closest& at) noexcept {
  if (at.corner >= 0) return mesh.vertex_normal(mesh.triangles()[at.face][static_cast<std::size_t>(at.corner)]);
  Vec3 sum = mesh.face(at.face).normal;
  if (at.edge < 0) return sum;
  each_across(mesh, at.face, at.edge, [&](std::uint32_t f) { sum += mesh.face(f).normal; });
  return sum;
}

bool on_border(const TriangleMesh& mesh, const Closest& at) noexcept {
  if (at.corner >= 0) return mesh.on_border(mesh.triangles()[at.face][static_cast<std::size_t>(at.corner)]);
  return at.edge >= 0 && mesh.across(at.face, at.edge) == at.face;
}

}  // namespace catena::mesh
