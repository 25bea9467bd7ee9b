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
#include "engine/geometry/mesh/bvh.h"

namespace catena::mesh {

/// Three indices of vertices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// What a reader found: not welded, not checked beyond its numbers.
struct TriangleSoup {
  std::vector<Vec3> vertices;       ///< corners, world units
  std::vector<Triangle> triangles;  ///< faces
};

/// One face in the mesh's own frame: normal . x = offset, and within its outline where side[k] . x >= limit[k] for all edges k
/// (from corner k to corner k + 1; side[k] is unit, in the plane, pointing inwards).
struct Face {
  Vec3 normal{0.0};                     ///< unit; the corners run counter-clockwise seen from where it points
  double offset = 0;                    ///< the plane is normal . x = offset
  std::array<Vec3, 3> edge_normal{};    ///< unit, in the plane, pointing inwards
  std::array<double, 3> edge_offset{};  ///< see above

  /// Distance from the plane, positive on the outside.
  double signed_distance(const Vec3& p) const { return dot(normal, p) - offset; }
  /// Whether p lies over the face's outline, or at most `tolerance` beyond an edge.
  bool covers(const Vec3& p, double tolerance) const {
    return dot(edge_normal[0], p) - edge_offset[0] >= -tolerance && dot(edge_normal[1], p) - edge_offset[1] >= -tolerance &&
           dot(edge_normal[2], p) - edge_offset[2] >= -tolerance;
  }
};

/// A mesh. Immutable; any thread; nothing allocates after it was made.
class TriangleMesh {
 public:
  /// What messages and the scene call it.
  const std::string& name() const { return name_; }
  std::uint64_t version() const { return version_; }       ///< unique in the process
  double domain_length() const { return domain_length_; }  ///< L: the longest edge of the bounding box, world units
  /// Least corner of its box, world units.
  const Vec3& min_corner() const { return min_corner_; }
  /// Greatest corner of its box, world units.
  const Vec3& max_corner() const { return max_corner_; }
  /// Memory that it holds.
  std::size_t bytes() const;

  /// Places of the vertices, world units.
  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< in the order of the hierarchy, not of the file
  std::size_t dropped_triangles() const { return dropped_triangles_; }   ///< triangles without an area
  /// Insets with one face.
  std::size_t open_edges() const { return open_edges_; }
  std::size_t non_manifold_edges() const { return non_manifold_edges_; }  ///< with more than two faces
  std::size_t misoriented_edges() const { return misoriented_edges_; }    ///< whose two faces disagree on the outside

  // the mesh's own frame
  /// World units a unit of its own frame.
  double scale() const { return scale_; }
  /// A world place in its own frame.
  Vec3 local_from_world(const Vec3& world) const { return (world - center_) * inverse_scale_; }
  /// A place of its own frame in the world.
  Vec3 world_from_local(const Vec3& own) const { return center_ + own * scale_; }
  /// A face, in its own frame.
  const Face& face(std::uint32_t f) const { return faces_[f]; }
  /// Corner k (0, 1, 2) of a face, in its own frame.
  const Vec3& corner(std::uint32_t f, int k) const { return local_vertices_[triangles_[f][static_cast<std::size_t>(k)]]; }
  /// The hierarchy of boxes over its faces, in the mesh's own frame; it numbers faces as triangles() does.
  const Bvh& bvh() const { return bvh_; }
  /// The next face around edge k (from corner k to k + 1), in a ring; f itself at an open edge.
  std::uint32_t adjacent_face(std::uint32_t f, int k) const { return adjacent_faces_[f][static_cast<std::size_t>(k)]; }
  /// All faces at a vertex.
  std::span<const std::uint32_t> faces_around(std::uint32_t vertex) const {
    return std::span(vertex_faces_).subspan(vertex_face_offsets_[vertex], vertex_face_offsets_[vertex + 1] - vertex_face_offsets_[vertex]);
  }
  /// Whether a vertex lies on an open edge.
  bool is_boundary_vertex(std::uint32_t vertex) const { return is_boundary_[vertex] != 0; }
  /// The mean of the faces' normals, weighted by their angles: its sign tells inside from outside (Baerentzen and Aanaes).
  const Vec3& vertex_normal(std::uint32_t vertex) const { return vertex_normals_[vertex]; }

 private:
  friend Result<std::shared_ptr<const TriangleMesh>> make_mesh(TriangleSoup soup, const std::string& name);
  void build_adjacency();
  void compute_faces();

  std::string name_;
  std::uint64_t version_ = 0;
  double domain_length_ = 0, scale_ = 1, inverse_scale_ = 1;
  Vec3 center_{0.0}, min_corner_{0.0}, max_corner_{0.0};
  std::vector<Vec3> vertices_, local_vertices_, vertex_normals_;
  std::vector<Triangle> triangles_, adjacent_faces_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> vertex_faces_, vertex_face_offsets_;
  std::vector<std::uint8_t> is_boundary_;
  std::size_t dropped_triangles_ = 0, open_edges_ = 0, non_manifold_edges_ = 0, misoriented_edges_ = 0;
  Bvh bvh_;
};

/// Meshes are shared and never change.
using MeshPtr = std::shared_ptr<const TriangleMesh>;

inline constexpr double kMinTriangleHeight = 1e-10;  ///< of L: the height below which a triangle has no area

/// Welds vertices of equal coordinates, drops triangles without an area and builds the rest. Refused: no triangle left, numbers that
/// are not finite, a size beyond 1e-100..1e100. The message begins with `name`.
Result<MeshPtr> make_mesh(TriangleSoup soup, const std::string& name);

// ---- closest points, in the mesh's own frame; no allocation, lock or throw ----

/// A place on a mesh, in the mesh's own frame.
struct ClosestPoint {
  Vec3 point{0.0};          ///< the place
  double distance2 = 0;     ///< squared distance from what was asked about
  std::uint32_t face = 0;   ///< the face that it is on
  std::int8_t edge = -1;    ///< 0..2: on that edge of the face (its ends included)
  std::int8_t corner = -1;  ///< 0..2: at that corner
};

/// Calls visit(face) for the other faces at an edge of `face`: one, none at an open edge, several at a non-manifold one (at most 16).
template <class Visit>
void for_each_adjacent_face(const TriangleMesh& mesh, std::uint32_t face, int edge, Visit&& visit) noexcept {
  const Triangle& t = mesh.triangles()[face];
  const std::uint32_t a = t[static_cast<std::size_t>(edge)], b = t[static_cast<std::size_t>((edge + 1) % 3)];
  std::uint32_t f = mesh.adjacent_face(face, edge);
  for (int i = 0; i < 16 && f != face; ++i) {
    visit(f);
    // the ring's faces number the edge in their own way
    const Triangle& other = mesh.triangles()[f];
    int k = 0;
    for (int j = 0; j < 3; ++j) {
      const std::uint32_t u = other[static_cast<std::size_t>(j)], v = other[static_cast<std::size_t>((j + 1) % 3)];
      if ((u == a && v == b) || (u == b && v == a)) k = j;
    }
    f = mesh.adjacent_face(f, k);
  }
}

/// The closest point of one face.
ClosestPoint closest_point_on_face(const TriangleMesh& mesh, std::uint32_t face, const Vec3& p) noexcept;

/// What nearest_point() finds.
struct NearestResult {
  ClosestPoint closest;      ///< the place; means something where `found`
  bool found = false;        ///< something within the radius
  bool is_complete = false;  ///< false: the budget of nodes ran out, something nearer may be there
};

/// The closest point of the whole mesh, if at most `radius` away. `hint`: a face that may be near.
NearestResult nearest_point(const TriangleMesh& mesh, const Vec3& p, double radius, int& budget, std::uint32_t hint = 0) noexcept;

/// The sum of the normals at the point found, not unit: of its face, of the faces at its edge, or the vertex normal.
Vec3 normal_at(const TriangleMesh& mesh, const ClosestPoint& at) noexcept;
/// At an open edge, where the surface ends.
bool is_on_boundary(const TriangleMesh& mesh, const ClosestPoint& at) noexcept;

}  // namespace catena::mesh
