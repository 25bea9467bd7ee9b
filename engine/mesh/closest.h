/// Closest points, in a mesh's own frame. Any thread; no allocation, lock or throw.
#pragma once
#include "engine/mesh/mesh.h"

namespace catena::mesh {

struct Closest {
  Vec3 point{0.0};
  double distance2 = 0;
  std::uint32_t face = 0;
  std::int8_t edge = -1;    ///< 0..2: on that edge of the face (its ends included)
  std::int8_t corner = -1;  ///< 0..2: at that corner
};

/// Calls visit(face) for the other faces at an edge of `face`: one, none at an open edge, several at a crowded one (at most 16).
template <class Visit>
void each_across(const TriangleMesh& mesh, std::uint32_t face, int edge, Visit&& visit) noexcept {
  const Triangle& t = mesh.triangles()[face];
  const std::uint32_t a = t[static_cast<std::size_t>(edge)], b = t[static_cast<std::size_t>((edge + 1) % 3)];
  std::uint32_t f = mesh.across(face, edge);
  for (int i = 0; i < 16 && f != face; ++i) {
    visit(f);
    // the ring's faces number the edge in their own way
    const Triangle& other = mesh.triangles()[f];
    int k = 0;
    for (int j = 0; j < 3; ++j) {
      const std::uint32_t u = other[static_cast<std::size_t>(j)], v = other[static_cast<std::size_t>((j + 1) % 3)];
      if ((u == a && v == b) || (u == b && v == a)) k = j;
    }
    f = mesh.across(f, k);
  }
}

/// The closest point of one face.
Closest closest_on_face(const TriangleMesh& mesh, std::uint32_t face, const Vec3& p) noexcept;

struct Nearest {
  Closest at;
  bool found = false;     ///< something within the radius
  bool complete = false;  ///< false: the budget of nodes ran out, something nearer may be there
};

/// The closest point of the whole mesh, if at most `radius` away. `hint`: a face that may be near.
Nearest nearest_point(const TriangleMesh& mesh, const Vec3& p, double radius, int& budget, std::uint32_t hint = 0) noexcept;

/// The sum of the normals at the point found, not unit: of its face, of the faces at its edge, or the vertex normal.
Vec3 normal_at(const TriangleMesh& mesh, const Closest& at) noexcept;
/// At an open edge, where the surface ends.
bool on_border(const TriangleMesh& mesh, const Closest& at) noexcept;

}  // namespace catena::mesh
