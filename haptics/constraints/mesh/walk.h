/// The closest point of a mesh that is felt from both sides, reached over its faces, edges and vertices from the point held before:
/// a local one, so that it never changes over to another part that happens to come near.
///   from face to face around the closest point's edge or vertex while that brings it nearer (the distance falls strictly)
/// Where it ends at an open edge, faces within 1e-7 of it count as neighbours: files whose corners do not quite meet.
/// In the mesh's own frame. Haptic thread: no allocation, lock or throw; at most kFaces faces a tick.
#pragma once
#include "engine/mesh/mesh.h"

namespace catena::haptics {

inline constexpr int kFaces = 512;

struct MeshWalk {
  mesh::Closest at;
  bool complete = false;  ///< false: goes on next tick
  int faces = 0;          ///< looked at
};

MeshWalk walk_mesh(const mesh::TriangleMesh& mesh, std::uint32_t face, const Vec3& x) noexcept;

}  // namespace catena::haptics
