// SPDX-License-Identifier: MIT
/// God-object of a one-sided mesh.            (Zilles and Salisbury 1995, section 3 of the paper)
///   from its position it moves to the point closest to the probe that no touched face forbids:
///     q = argmin |q - x|  subject to  n_i . q - d_i >= gap  for the faces i that it touches (at most three are active)
///   in a straight line, up to the first face in the way (a segment query in the BVH), which is then touched too; and so on until it
///   arrives. It never crosses a face from its outer side, however thin the part and however fast the probe.
/// At a vertex that is an end of active faces (a saddle) it also tries the faces and edges of the fan one by one.
/// The gap of 2.5e-13 keeps it outside in spite of rounding; |q - x| decreases with every move, so that it converges in corners.
/// All in the mesh's own frame (mesh.h). Haptic thread: no allocation, lock or throw; at most kMaxGodObjectMoves moves and
/// kMaxGodObjectNodes nodes per tick.
#pragma once
#include "engine/geometry/mesh/mesh.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

inline constexpr double kGodObjectGap = 2.5e-13;  ///< distance at which it stays in front of a touched face, mesh frame
inline constexpr int kMaxGodObjectMoves = 32, kMaxGodObjectNodes = 3072;  ///< maximum per tick

/// State of the god-object, mesh frame. Zero bytes are a valid state: at the origin, touching nothing.
struct GodObject {
  static constexpr int kMaxFaces = 6;
  Vec3 p;                                      ///< position of the god-object
  std::array<std::uint32_t, kMaxFaces> faces;  ///< indices of the touched faces
  std::array<Vec3, 3> normals;                 ///< outward normals of the active faces
  std::int32_t count, binding;                 ///< number of touched faces; number of active ones
};

/// Result of one tick's moves.
struct GodObjectMove {
  bool reached = false;   ///< no face is between the god-object and the probe
  bool complete = false;  ///< false: resumes in the next tick
  int nodes = 0;          ///< BVH nodes visited
};

/// Moves the god-object towards the probe x (mesh frame) for one tick, visiting at most `nodes` BVH nodes. `outside`: 1 where the normals
/// point to the free side, -1 where they point away from it.
GodObjectMove move_god_object(const mesh::TriangleMesh& mesh, double outside, const Vec3& x, int nodes, GodObject& god) noexcept;

}  // namespace catena::haptics
