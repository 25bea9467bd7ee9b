// SPDX-License-Identifier: MIT
/// Bricks of paged grids (engine/field/bricks/paged_grid.h) in a tick. A tick samples one snapshot of the bricks in memory. Where a brick
/// at the chain arrives or leaves between two ticks, the surface there moves without the probe: for kLimitedTicks ticks the force then
/// changes by at most kSlipFraction of max_force per tick besides the motion of the probe (ramp.h). A snapshot that has the same bricks
/// there is no change. Haptic thread: no allocation, lock, throw.
#pragma once
#include <span>

#include "engine/field/bricks/paged_grid.h"
#include "haptics/chain/program.h"

namespace catena::haptics {

/// Ticks with limited steps after a change, which a proxy needs to reach the new surface.
inline constexpr int kLimitedTicks = 50;

/// Returns whether one of the two snapshots lacks a brick that the other has, around any of the positions (world units, at most
/// kMaxLinks + 2); null: no bricks. A brick that was read again is the same. Around: in the box of all positions, or if that has too many
/// bricks, in that of each position, widened by two voxels.
bool bricks_differ(std::span<const std::shared_ptr<const field::PagedGrid>> grids, const field::BrickSnapshot* a,
                   const field::BrickSnapshot* b, std::span<const Vec3> positions) noexcept;

/// Prepares all cursors of a link for a tick that samples `bricks`.
inline void begin_bricks(const field::BrickSnapshot* bricks, LinkScratch& scratch) noexcept {
  scratch.for_cursors([&](field::Cursor& cursor) {
    cursor.owner = nullptr;
    cursor.bricks = bricks;
    cursor.is_coarse = false;
  });
}

/// Returns whether a link has sampled the coarse level of a paged grid since begin_bricks().
inline bool is_coarse(LinkScratch& scratch) noexcept {
  bool coarse = false;
  scratch.for_cursors([&](const field::Cursor& cursor) { coarse = coarse || cursor.is_coarse; });
  return coarse;
}

}  // namespace catena::haptics
