/// What keeps a person well while the world moves around them: turns in steps, and a picture that narrows.
/// Plain functions of their inputs; the frame thread keeps the state.
#pragma once
#include "engine/base/placement.h"

namespace catena::xr_interaction {

/// A stick turns by a step at a time, which makes fewer people sick than turning evenly.
///   |x| rises past 0.7: one step to that side, counter-clockwise for the left;   again only after |x| has been below 0.3
class SnapTurn {
 public:
  explicit SnapTurn(double step_rad = M_PI / 6) : step_rad_(step_rad) {}
  /// `stick`: -1 left to 1 right. The angle that the person turns by, counter-clockwise; mostly 0. The world turns the other way.
  double step(double stick);

 private:
  double step_rad_;
  bool armed_ = true;
};

/// How far the picture narrows while the world moves against the room, 0..1: what render/passes/vignette draws.
///   wish = min(1, max(|v| / reference_speed, |w| / full_turn, |dlnS/dt| / full_scaling)),  0 below a tenth
///   it follows the wish at most as fast as 0 to 1 in rise_s, and back in fall_s
/// v: of the place of the world where the head is, metres of room a second. Nothing that the person's own head does counts.
class Vignette {
 public:
  struct Options {
    double full_speed_m_per_s = 1, full_turn_rad_per_s = 1, full_scaling_per_s = 1;
    double rise_s = 0.1, fall_s = 0.4;
  };
  Vignette() = default;
  explicit Vignette(const Options& options) : options_(options) {}
  /// Each picture. `dt_s` since the last one. A step of SnapTurn is no motion: leave it out of `before`.
  double step(const Placement& before, const Placement& now, const Vec3& head_m, double dt_s);

 private:
  Options options_;
  double strength_ = 0;
};

}  // namespace catena::xr_interaction
