/// Moves over one piece of a sampled level set: see isosurface/cell_walk.h. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/level.h"
#include "haptics/constraints/isosurface/piece.h"

namespace catena::haptics {

inline constexpr double kRelease = 1e-8;     // of L: a smaller tangential descent is none
inline constexpr double kFaceSlack = 1e-12;  // voxels: closer to a face than this is on it

enum class Followed { converged, landed, blocked };

/// Moves f within one piece towards the closest point, until it converges or meets a face of the cell. `s` and `t` are the sample
/// and the tangential part at f, on the way in, and on the way out where it converged. Steepest: by t, not by Newton's step, which
/// on a folded piece may lead out of the cell where t leads in.
Followed follow(const LevelField& field, const Piece& piece, const Vec3& probe, bool steepest, Vec3& f, PieceSample& s, Vec3& t) noexcept;

/// Far from the probe, straight along t to the face where it leaves the cell, and on that face back to the level. False: the level
/// bends too much for that, or the way is no way down.
bool cross_cell(const LevelField& field, const PieceFrames& frames, const Piece& piece, const field::ScalarCell& cell, unsigned held,
                const Vec3& probe, const PieceSample& s, const Vec3& t, Vec3& f) noexcept;

}  // namespace catena::haptics
