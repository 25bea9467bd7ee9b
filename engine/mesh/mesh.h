/// A triangle mesh that can be felt and seen: welded, indexed, with its neighbourhoods and a hierarchy of boxes. Immutable;
/// open edges, non-manifold edges and turned faces are allowed and counted.
/// World units in `vertices`, double precision. What a tick reads is in the mesh's own frame:
///   own = (world - centre) / scale,  scale = the power of two at or above L, so that scaling is exact and own lies in [-1/2, 1/2]^3
/// Made off the tick; reading is safe from every thread, without allocation.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/mesh/bvh.h"

namespace catena::mesh {

/// Three indices of vertices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// What a reader found: not welded, not checked beyond its numbers.
struct Soup {
  std::vector<Vec3> vertices;       ///< corners, world units
  std::vector<Triangle> triangles;  ///< faces
};

/// One face in the mesh's own frame: normal . x = offset, and within its outline where side[k] . x >= limit[k] for all edges k
/// (from corner k to corner k + 1; side[k] is unit, in the plane, pointing inwards).
struct Face {
  Vec3 normal{0.0};               ///< unit; the corners run counter-clockwise seen from where it points
  double offset = 0;              ///< the plane is normal . x = offset
  std::array<Vec3, 3> side{};     ///< unit, in the plane, pointing inwards
  std::array<double, 3> limit{};  ///< see above

  /// Distance from the plane, positive on the outside.
  double height(const Vec3& p) const { return dot(normal, p) - offset; }
  /// Whether p lies over the face's outline, or at most `tolerance` beyond an edge.
  bool covers(const Vec3& p, double tolerance) const {
    return dot(side[0], p) - limit[0] >= -tolerance && dot(side[1], p) - limit[1] >= -tolerance && dot(side[2], p) - limit[2] >= -tolerance;
  }
};

/// A mesh. Immutable; any thread; nothing allocates after it was made.
class TriangleMesh {
 public:
  /// What messages and the scene call it.
  const std::string& name() const { return name_; }
  std::uint64_t version() const { return version_; }  ///< unique in the process
  double length() const { return length_; }           ///< L: the longest edge of the bounding box, world units
  /// Least corner of its box, world units.
  const Vec3& lowest() const { return lowest_; }
  /// Greatest corner of its box, world units.
  const Vec3& highest() const { return highest_; }
  /// Memory that it holds.
  std::size_t bytes() const;

  /// Places of the vertices, world units.
  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< in the order of the hierarchy, not of the file
  std::size_t dropped() const { return dropped_; }                       ///< triangles without an area
  /// Edges with one face.
  std::size_t open_edges() const { return open_edges_; }
  std::size_t non_manifold_edges() const { return non_manifold_edges_; }  ///< with more than two faces
  std::size_t misoriented_edges() const { return misoriented_edges_; }    ///< whose two faces disagree on the outside

  // the mesh's own frame
  /// World units a unit of its own frame.
  double scale() const { return scale_; }
  /// A world place in its own frame.
  Vec3 own(const Vec3& world) const { return (world - centre_) * inverse_scale_; }
  /// A place of its own frame in the world.
  Vec3 world(const Vec3& own) const { return centre_ + own * scale_; }
  /// A face, in its own frame.
  const Face& face(std::uint32_t f) const { return faces_[f]; }
  /// Corner k (0, 1, 2) of a face, in its own frame.
  const Vec3& corner(std::uint32_t f, int k) const { return own_vertices_[triangles_[f][static_cast<std::size_t>(k)]]; }
  /// The hierarchy of boxes over its faces, in the mesh's own frame; it numbers faces as triangles() does.
  const Bvh& bvh() const { return bvh_; }
  /// The next face around edge k (from corner k to k + 1), in a ring; f itself at an open edge.
  std::uint32_t across(std::uint32_t f, int k) const { return across_[f][static_cast<std::size_t>(k)]; }
  /// All faces at a vertex.
  std::span<const std::uint32_t> fan(std::uint32_t vertex) const {
    return std::span(fans_).subspan(fan_starts_[vertex], fan_starts_[vertex + 1] - fan_starts_[vertex]);
  }
  /// Whether a vertex lies on an open edge.
  bool on_border(std::uint32_t vertex) const { return border_[vertex] != 0; }
  /// The mean of the faces' normals, weighted by their angles: its sign tells inside from outside (Baerentzen and Aanaes).
  const Vec3& vertex_normal(std::uint32_t vertex) const { return vertex_normals_[vertex]; }

 private:
  friend Result<std::shared_ptr<const TriangleMesh>> make_mesh(Soup soup, const std::string& name);
  void connect();
  void measure_faces();

  std::string name_;
  std::uint64_t version_ = 0;
  double length_ = 0, scale_ = 1, inverse_scale_ = 1;
  Vec3 centre_{0.0}, lowest_{0.0}, highest_{0.0};
  std::vector<Vec3> vertices_, own_vertices_, vertex_normals_;
  std::vector<Triangle> triangles_, across_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> fans_, fan_starts_;
  std::vector<std::uint8_t> border_;
  std::size_t dropped_ = 0, open_edges_ = 0, non_manifold_edges_ = 0, misoriented_edges_ = 0;
  Bvh bvh_;
};

/// Meshes are shared and never change.
using MeshPtr = std::shared_ptr<const TriangleMesh>;

inline constexpr double kThinnest = 1e-10;  ///< of L: the height below which a triangle has no area

/// Welds vertices of equal coordinates, drops triangles without an area and builds the rest. Refused: no triangle left, numbers that
/// are not finite, a size beyond 1e-100..1e100. The message begins with `name`.
Result<MeshPtr> make_mesh(Soup soup, const std::string& name);

// ---- closest points, in the mesh's own frame; no allocation, lock or throw ----

/// A place on a mesh, in the mesh's own frame.
struct Closest {
  Vec3 point{0.0};          ///< the place
  double distance2 = 0;     ///< squared distance from what was asked about
  std::uint32_t face = 0;   ///< the face that it is on
  std::int8_t edge = -1;    ///< 0..2: on that edge of the face (its ends included)
  std::int8_t corner = -1;  ///< 0..2: at that corner
};

/// Calls visit(face) for the other faces at an edge of `face`: one, none at an open edge, several at a non-manifold one (at most 16).
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

/// What nearest_point() finds.
struct Nearest {
  Closest at;             ///< the place; means something where `found`
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
