// SPDX-License-Identifier: MIT
/// Ramp of the force: no tick changes the sum of the links' forces by more than the motion of the probe explains plus a ramp allows,
/// whatever the cause of the change: a switch, a mode, a snap, a release, a search that fails, another sheet, another program.
///   f_k: the links' force of tick k, at most max_force;  moved = K |dx|, K = sum of k_i S;  fall = max_force dt / ramp_s
///   d = f_k - f_(k-1);   e += d min(1, moved / |d|) - d;   |e| shrinks by `fall`;   sent: f_k + e
/// so that |sent_k - sent_(k-1)| <= moved + fall. Where |d| stays within `moved` nothing is added, and the ramp offset e fades to zero.
/// ramp_s = 0: no ramp. Cues (release_cue.h) and damping are added after the ramp. Torques follow the same rule (alignment.h).
/// Haptic thread: no allocation, lock, throw.
#pragma once
#include "engine/base/vec.h"

namespace catena::haptics {

/// State of the ramp between ticks. Newtons, or newton meters.
struct Ramp {
  Vec3 last_force{0.0};  ///< f of the last tick
  Vec3 offset{0.0};      ///< ramp offset e, which still has to fade
};

/// Steps the ramp to the force `now` of this tick. Returns e; zero without a ramp (`fall` infinite). In the first tick the caller sets
/// last_force = now, so that nothing is added.
inline Vec3 step_ramp(Ramp& ramp, const Vec3& now, double moved, double fall) noexcept {
  const Vec3 step = now - ramp.last_force;
  const double far = norm(step);
  ramp.last_force = now;
  if (far > moved) ramp.offset += step * (moved / far) - step;
  const double left = norm(ramp.offset);
  // an offset that is infinite or not a number cannot fade and is reset to zero
  ramp.offset = left > fall && std::isfinite(left) ? ramp.offset * ((left - fall) / left) : Vec3(0.0);
  return ramp.offset;
}

}  // namespace catena::haptics
