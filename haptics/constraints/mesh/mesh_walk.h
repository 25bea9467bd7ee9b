// SPDX-License-Identifier: MIT
/// The point closest to x in front of a few planes: a convex problem of three unknowns, solved by trying every set of one, two or
/// three planes as the active set (six planes: 41 sets).
///   argmin |q - x|  subject to  n_i . q - e_i >= 0
/// Exact to rounding, also where planes are nearly parallel. Haptic thread: no allocation, lock or throw.
#pragma once
#include "engine/geometry/mesh/mesh.h"
#include "haptics/constraints/mesh/god_object.h"

namespace catena::haptics {

/// Solution of PlaneConstraints::closest.
struct PlaneSolution {
  Vec3 q{0.0};                   ///< the closest point
  std::array<int, 3> binding{};  ///< indices of the active planes, the first `count` are valid
  int count = 0;                 ///< number of active planes; 0: q is x
  bool found = false;            ///< false: no active set is feasible
};

/// Set of half-spaces normal . q >= offset.
class PlaneConstraints {
 public:
  /// Adds a plane; at most GodObject::kMaxFaces.
  void add(const Vec3& normal, double offset) { planes_[static_cast<std::size_t>(count_++)] = {normal, offset}; }
  /// Returns the point closest to x. A candidate q counts as in front of a plane up to a quarter of kGodObjectGap behind it, x itself up to
  /// kGodObjectGap behind it.
  PlaneSolution closest(const Vec3& x) const noexcept;

 private:
  struct Plane {
    Vec3 normal{0.0};
    double offset = 0;
  };
  const Vec3& normal(int i) const { return planes_[static_cast<std::size_t>(i)].normal; }
  double gap(int i, const Vec3& p) const { return dot(normal(i), p) - planes_[static_cast<std::size_t>(i)].offset; }
  void try_candidate(const Vec3& x, const Vec3& q, const std::array<int, 3>& binding, int count, PlaneSolution& best) const noexcept;
  void try_edge(const Vec3& x, int a, int b, PlaneSolution& best) const noexcept;
  void try_corner(const Vec3& x, int a, int b, int c, PlaneSolution& best) const noexcept;

  std::array<Plane, GodObject::kMaxFaces> planes_{};
  int count_ = 0;
};

/// The closest point of a two-sided mesh, reached over its faces, edges and vertices from the point held in the last tick: a local
/// minimum, so that it never jumps to another part that happens to come near.
///   from face to face around the closest point's edge or vertex while that brings it nearer (the distance decreases strictly)
/// Where it ends at an open edge, faces within 1e-7 of it count as neighbors: for files whose corners do not quite meet.
/// In the mesh's own frame. Haptic thread: no allocation, lock or throw; at most kMaxWalkFaces faces per tick.
inline constexpr int kMaxWalkFaces = 512;

/// Result of one tick's walk.
struct MeshWalkResult {
  mesh::ClosestPoint closest;
  bool complete = false;  ///< false: resumes in the next tick
  int faces = 0;          ///< faces visited
};

/// Walks from `face` to the local closest point to the probe x (mesh frame).
MeshWalkResult walk_mesh(const mesh::TriangleMesh& mesh, std::uint32_t face, const Vec3& x) noexcept;

}  // namespace catena::haptics
