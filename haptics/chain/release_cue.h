// SPDX-License-Identifier: MIT
/// Release cues: every link reports when the probe leaves its feature, as a ratio and as a haptic cue (third requirement of the paper,
/// section 2). The model is documented at ReleaseCue in program.h. The cues are triangle waves and linear ramps only, so that results are
/// bit-identical everywhere. Haptic thread: no allocation, lock or throw.
#pragma once
#include "engine/base/export.h"
#include "haptics/chain/program.h"

namespace catena::haptics {

/// State of a link's release cue between ticks.
struct ReleaseCueState {
  double pulse_level = 0;    ///< 1..0: remaining level of a detent
  Vec3 direction{0.0};       ///< unit, from the probe toward the feature
  bool released = false;     ///< the probe has left the feature
  bool initialized = false;  ///< `released` is valid
};

/// Sets the report's release_ratio and released from its gap; returns the force of the cue, newtons, world axes. `gap` = p_i - p_(i-1),
/// world units.
CATENA_EXPORT Vec3 update_release_cue(const ReleaseCue& indication, const LinkState& link, const Vec3& gap, double t_s, double dt_s,
                                      ReleaseCueState& state, LinkReport& report) noexcept;

}  // namespace catena::haptics
