// SPDX-License-Identifier: MIT
/// Triangle mesh for haptics and rendering: welded, indexed, with adjacency and a bounding volume hierarchy. Immutable; open edges,
/// non-manifold edges and misoriented faces are allowed and counted.
/// `vertices` are in world units, double precision. Data for the haptic thread are in the mesh's local (normalized) frame:
///   local = (world - center) / scale,  scale = the smallest power of two >= L, so that scaling is exact and local lies in [-1/2, 1/2]^3
/// Created off the haptic thread; reading is safe from any thread and does not allocate.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/geometry/mesh/bvh.h"

namespace catena::mesh {

/// Three vertex indices, counter-clockwise when seen from the outward side.
using Triangle = std::array<std::uint32_t, 3>;

/// Output of a mesh reader: neither welded nor validated, except for its numbers.
struct TriangleSoup {
  std::vector<Vec3> vertices;       ///< Corner positions, world units.
  std::vector<Triangle> triangles;  ///< Vertex indices of each face.
};

/// One face in the local frame: the plane normal . x = offset, bounded by edge_normal[k] . x >= edge_offset[k] for all edges k (edge k
/// goes from corner k to corner k + 1).
struct Face {
  Vec3 normal{0.0};                     ///< Unit normal; the corners are counter-clockwise when seen from the side it points to.
  double offset = 0;                    ///< Plane offset: normal . x = offset.
  std::array<Vec3, 3> edge_normal{};    ///< Unit edge normals, in the plane, pointing inward.
  std::array<double, 3> edge_offset{};  ///< Edge offsets: edge_normal[k] . x = edge_offset[k] on edge k.

  /// Signed distance from the plane, local frame; positive on the outward side.
  double signed_distance(const Vec3& p) const { return dot(normal, p) - offset; }
  /// Returns whether the projection of p onto the plane lies within the face, or outside an edge by at most `tolerance` (local frame).
  bool covers(const Vec3& p, double tolerance) const {
    return dot(edge_normal[0], p) - edge_offset[0] >= -tolerance && dot(edge_normal[1], p) - edge_offset[1] >= -tolerance &&
           dot(edge_normal[2], p) - edge_offset[2] >= -tolerance;
  }
};

/// A triangle mesh. Immutable and safe to read from any thread; nothing allocates after creation.
class CATENA_EXPORT TriangleMesh {
 public:
  /// Name used in messages and in the scene.
  const std::string& name() const { return name_; }
  std::uint64_t version() const { return version_; }       ///< Unique in the process.
  double domain_length() const { return domain_length_; }  ///< L: the longest edge of the bounding box, world units.
  /// Minimum corner of the bounding box, world units.
  const Vec3& min_corner() const { return min_corner_; }
  /// Maximum corner of the bounding box, world units.
  const Vec3& max_corner() const { return max_corner_; }
  /// Memory used, bytes.
  std::size_t bytes() const;

  /// Vertex positions, world units.
  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< In the order of the hierarchy, not of the file.
  std::size_t dropped_triangles() const { return dropped_triangles_; }   ///< Number of triangles dropped because their area is zero.
  /// Number of edges with one face.
  std::size_t open_edges() const { return open_edges_; }
  std::size_t non_manifold_edges() const { return non_manifold_edges_; }  ///< Number of edges with more than two faces.
  std::size_t misoriented_edges() const { return misoriented_edges_; }    ///< Number of edges whose two faces disagree on the outward side.

  // the local frame
  /// World units per unit of the local frame.
  double scale() const { return scale_; }
  /// Converts a world position to the local frame.
  Vec3 local_from_world(const Vec3& world) const { return (world - center_) * inverse_scale_; }
  /// Converts a position in the local frame to world units.
  Vec3 world_from_local(const Vec3& own) const { return center_ + own * scale_; }
  /// Returns a face, in the local frame.
  const Face& face(std::uint32_t f) const { return faces_[f]; }
  /// Returns corner k (0, 1, 2) of a face, in the local frame.
  const Vec3& corner(std::uint32_t f, int k) const { return local_vertices_[triangles_[f][static_cast<std::size_t>(k)]]; }
  /// Bounding volume hierarchy of the faces, in the local frame; face indices are those of triangles().
  const Bvh& bvh() const { return bvh_; }
  /// Next face around edge k (from corner k to k + 1), in a cyclic order; f itself at an open edge.
  std::uint32_t adjacent_face(std::uint32_t f, int k) const { return adjacent_faces_[f][static_cast<std::size_t>(k)]; }
  /// Indices of all faces that share a vertex.
  std::span<const std::uint32_t> faces_around(std::uint32_t vertex) const {
    return std::span(vertex_faces_).subspan(vertex_face_offsets_[vertex], vertex_face_offsets_[vertex + 1] - vertex_face_offsets_[vertex]);
  }
  /// Returns whether a vertex lies on an open edge.
  bool is_boundary_vertex(std::uint32_t vertex) const { return is_boundary_[vertex] != 0; }
  /// Angle-weighted mean of the normals of the faces at a vertex, unit; its sign separates inside from outside (Baerentzen and Aanaes).
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

/// Shared, immutable mesh.
using MeshPtr = std::shared_ptr<const TriangleMesh>;

/// Triangles with a smaller height, as a fraction of L, count as having no area.
inline constexpr double kMinTriangleHeight = 1e-10;

/// Welds vertices with equal coordinates, drops triangles without an area and builds the mesh. Returns an Error that begins with `name`
/// when no triangle remains, a number is not finite, or the size is outside of 1e-100..1e100.
CATENA_EXPORT Result<MeshPtr> make_mesh(TriangleSoup soup, const std::string& name);

// ---- closest points, in the local frame; no allocation, lock or throw ----

/// A point on a mesh, in the local frame.
struct ClosestPoint {
  Vec3 point{0.0};          ///< Position of the point.
  double distance2 = 0;     ///< Squared distance from the query point.
  std::uint32_t face = 0;   ///< Index of the face that contains the point.
  std::int8_t edge = -1;    ///< 0..2: the point lies on that edge of the face (its ends included); -1: inside the face.
  std::int8_t corner = -1;  ///< 0..2: the point is that corner of the face; -1: it is not a corner.
};

/// Calls visit(face) for the other faces at an edge of `face`: one, none at an open edge, several at a non-manifold edge (at most 16).
template <class Visit>
void for_each_adjacent_face(const TriangleMesh& mesh, std::uint32_t face, int edge, Visit&& visit) noexcept {
  const Triangle& t = mesh.triangles()[face];
  const std::uint32_t a = t[static_cast<std::size_t>(edge)], b = t[static_cast<std::size_t>((edge + 1) % 3)];
  std::uint32_t f = mesh.adjacent_face(face, edge);
  for (int i = 0; i < 16 && f != face; ++i) {
    visit(f);
    // each face in the cycle has its own index for this edge
    const Triangle& other = mesh.triangles()[f];
    int k = 0;
    for (int j = 0; j < 3; ++j) {
      const std::uint32_t u = other[static_cast<std::size_t>(j)], v = other[static_cast<std::size_t>((j + 1) % 3)];
      if ((u == a && v == b) || (u == b && v == a)) k = j;
    }
    f = mesh.adjacent_face(f, k);
  }
}

/// Returns the point of one face that is closest to p; all in the local frame.
CATENA_EXPORT ClosestPoint closest_point_on_face(const TriangleMesh& mesh, std::uint32_t face, const Vec3& p) noexcept;

/// Result of nearest_point().
struct NearestResult {
  ClosestPoint closest;      ///< The closest point; meaningful only if `found`.
  bool found = false;        ///< Whether a point lies within the radius.
  bool is_complete = false;  ///< False: the node budget was exhausted, so a nearer point may exist.
};

/// Finds the point of the mesh closest to p within `radius` (local frame). `budget`: number of BVH nodes, counted down. `hint`: a face that
/// may be near.
CATENA_EXPORT NearestResult nearest_point(const TriangleMesh& mesh, const Vec3& p, double radius, int& budget,
                                          std::uint32_t hint = 0) noexcept;

/// Returns the normal at a point, not unit: the face normal, the sum of the normals of the faces at its edge, or the vertex normal.
CATENA_EXPORT Vec3 normal_at(const TriangleMesh& mesh, const ClosestPoint& at) noexcept;
/// Returns whether the point lies on an open edge, where the surface ends.
CATENA_EXPORT bool is_on_boundary(const TriangleMesh& mesh, const ClosestPoint& at) noexcept;

}  // namespace catena::mesh
