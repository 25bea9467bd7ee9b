// SPDX-License-Identifier: MIT
/// Ticks outside of a servo: replays, measurements, simulated sessions. With paged grids a tick waits for the bricks that it needs, so that
/// its result is that of grids that are in memory as a whole. Not for the haptic thread.
#pragma once
#include <memory>

#include "engine/base/export.h"
#include "haptics/chain/tick.h"

namespace catena::haptics {

/// Runner of ticks, with the bricks of the last ones. One thread.
class CATENA_EXPORT OfflineTicks {
 public:
  OfflineTicks();
  ~OfflineTicks();
  /// Runs one tick as tick() does, with bricks of its own in place of ProbeSample::bricks. A brick that cannot be read leaves the link on
  /// the coarse level.
  void run(const HapticProgram& program, const ProbeSample& probe, ChainState& state, ChainScratch& scratch, HapticState& out);

 private:
  class Bricks;
  std::unique_ptr<Bricks> bricks_;
};

}  // namespace catena::haptics
