/// The first crossing of a level by the way of a probe, between two ticks. However thin the body is that the way passes through:
///   trilinear cells   exact: along a straight way the value in one cell is a cubic, of which every extreme is looked at
///   else              by steps of half a voxel, or L/256; between two places on the same side, where their tangents meet beyond the level,
///                     which every convex dip lies above
/// World units; every fetch counts. Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/isosurface/surface_search.h"

namespace catena::haptics {

/// Where the segment from..to meets the level first; `to` has been asked for already, and what `known` points to, if anything, at `from`. A
/// way longer than 53 voxels, which may pass 160 cells, or of more than 64 steps is looked at by 64 steps.
LevelSetHit find_first_crossing(LevelSetField& field, const Vec3& from, const LevelPoint& to, const LevelPoint* known = nullptr) noexcept;

/// Whether the way between two places on the same side of a formula's level, at most one step long, leaves no room for a convex dip.
bool stays_on_side(const LevelSetField& field, const LevelPoint& a, const LevelPoint& b) noexcept;

}  // namespace catena::haptics
