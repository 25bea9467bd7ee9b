// SPDX-License-Identifier: MIT
/// Comfort measures while the world moves around the user: snap turns and a vignette. Functions of their inputs; the state belongs to the
/// frame thread.
#pragma once
#include "engine/base/placement.h"

namespace catena::xr_interaction {

/// Snap turn: a thumbstick rotates by one step at a time, which causes less motion sickness than smooth rotation.
///   |x| rises above 0.7: one step to that side, counter-clockwise for the left;   re-armed when |x| falls below 0.3
class SnapTurn {
 public:
  explicit SnapTurn(double step_rad = M_PI / 6) : step_rad_(step_rad) {}
  /// `stick`: -1 left to 1 right. Returns the angle by which the user turns, radians, counter-clockwise; usually 0. The world turns the
  /// opposite way.
  double step(double stick);

 private:
  double step_rad_;
  bool armed_ = true;
};

/// Strength of the vignette while the world moves relative to the tracking space, 0 to 1 (rendered by render/passes/vignette).
///   target = min(1, max(|v| / full_speed, |w| / full_turn, |dlnS/dt| / full_scaling)),  0 below a tenth
///   the strength follows the target at most as fast as 0 to 1 in rise_s, and back in fall_s
/// v: velocity of the world at the head, meters per second in tracking space; w: angular velocity; S: scale. Motion of the user's own head
/// does not count.
class Vignette {
 public:
  /// Speeds at which the strength reaches 1, and the times to rise and to fall.
  struct Options {
    double full_speed_m_per_s = 1, full_turn_rad_per_s = 1, full_scaling_per_s = 1;
    double rise_s = 0.1, fall_s = 0.4;
  };
  Vignette() = default;
  explicit Vignette(const Options& options) : options_(options) {}
  /// Call once per frame; returns the strength. `dt_s`: time since the last frame. A step of SnapTurn does not count as motion: pass a
  /// `before` that already contains it.
  double step(const Placement& before, const Placement& now, const Vec3& head_m, double dt_s);

 private:
  Options options_;
  double strength_ = 0;
};

}  // namespace catena::xr_interaction
