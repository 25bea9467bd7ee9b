/// The paper's third requirement (section 2): every link tells when the hand leaves its feature, as a figure and as a cue.
/// The model is beside ReleaseCue in program.h. Triangle waves and straight ramps only, so that bits repeat.
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/chain/program.h"

namespace catena::haptics {

/// What the cue of a link remembers.
struct ReleaseCueState {
  double pulse_level = 0;    ///< 1..0, what is left of a detent
  Vec3 direction{0.0};       ///< unit, towards the feature
  bool released = false;     ///< the hand has left the feature
  bool initialized = false;  ///< `left` means something
};

/// Fills in the report's leaving and left from its gap; returns the cue's force. `gap` = p_i - p_(i-1), world units.
Vec3 update_release_cue(const ReleaseCue& indication, const LinkState& link, const Vec3& gap, double t_s, double dt_s,
                        ReleaseCueState& state, LinkReport& report) noexcept;

}  // namespace catena::haptics
