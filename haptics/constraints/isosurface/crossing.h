// SPDX-License-Identifier: MIT
/// First crossing of a level by the path of the probe between two ticks, however thin the solid that the path passes through:
///   trilinear cells   exact: along a straight segment the value in one cell is a cubic, whose extremes are all checked
///   else              by steps of half a voxel, or L/256; between two points on the same side, at the intersection of their tangents if
///                     that is beyond the level: a convex dip lies above its tangents
/// World units; every field sample counted. Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/isosurface/surface_search.h"

namespace catena::haptics {

/// Returns the point where the segment from..to meets the level first. `to` is a sample made by the caller; `known`, if not null, is the
/// sample at `from`. A segment longer than 53 voxels (which may pass 160 cells), or of more than 64 steps, is checked in 64 steps.
LevelSetHit find_first_crossing(LevelSetField& field, const Vec3& from, const LevelPoint& to, const LevelPoint* known = nullptr) noexcept;

/// Returns whether the segment between two points on the same side of a formula's level, at most one march step long, cannot contain a
/// convex dip.
bool stays_on_side(const LevelSetField& field, const LevelPoint& a, const LevelPoint& b) noexcept;

}  // namespace catena::haptics
