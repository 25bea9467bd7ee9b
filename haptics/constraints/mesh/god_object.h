/// The god-object of a mesh that is felt from one side.            (Zilles and Salisbury 1995, section 3 of the paper)
///   from where it is, it goes to the point closest to the probe that no touched face forbids:
///     q = argmin |q - x|  subject to  n_i . q - d_i >= gap  for the faces i that it touches (up to three of them bind)
///   straight, until the first face in the way (a segment through the hierarchy), which is then touched too; and so on until it
///   arrives. It never crosses a face from its outer side, however thin the part and however fast the hand.
/// At a vertex where faces bind that end there (a saddle) it also tries the faces and edges of the fan one by one.
/// The gap of 2.5e-13 keeps it outside in spite of rounding; |q - x| falls with every move, so that it settles in corners.
/// All in the mesh's own frame (mesh.h). Haptic thread: no allocation, lock or throw; at most kMaxGodObjectMoves moves and
/// kMaxGodObjectNodes nodes a tick.
#pragma once
#include "engine/geometry/mesh/mesh.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

inline constexpr double kGodObjectGap = 2.5e-13;
inline constexpr int kMaxGodObjectMoves = 32, kMaxGodObjectNodes = 3072;

/// Zero bytes are a legal one: at the centre, touching nothing.
struct GodObject {
  static constexpr int kMaxFaces = 6;
  Vec3 p;
  std::array<std::uint32_t, kMaxFaces> faces;  ///< touched
  std::array<Vec3, 3> normals;                 ///< of the faces that bind, outwards
  std::int32_t count, binding;
};

struct GodObjectMove {
  bool reached = false;   ///< nothing is between it and the probe
  bool complete = false;  ///< false: goes on next tick
  int nodes = 0;          ///< visited
};

/// One tick towards x, with at most `nodes` nodes. `outside`: 1 where normals point to the free side, -1 where they point away from it.
GodObjectMove move_god_object(const mesh::TriangleMesh& mesh, double outside, const Vec3& x, int nodes, GodObject& god) noexcept;

}  // namespace catena::haptics
