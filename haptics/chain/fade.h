/// No force jump where links are switched, reordered or replaced: what the step would have been is added and fades to zero,
/// linearly, over the coupling's ramp.
///   at a change:  fade_n = (shares before) - (shares after), of the links that the change moves;  F = sum of shares + fade_n f
/// A link that is switched on needs none: its own weight rises from 0. Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/chain/switching.h"

namespace catena::haptics {

struct Fade {
  std::array<Vec3, kMaxLinks> shares{};  ///< of the last tick, newtons
  Order order;                           ///< of the last tick
  Vec3 force_n{0.0};
  double left = 0;        ///< f, 1..0
  bool replaced = false;  ///< another program has taken over since
};

/// Steps the fade by `ramp_step` (dt / ramp_s, 1: at once) and books what this tick changes. Returns the force to add.
Vec3 step_fade(Fade& fade, const Order& order, const std::array<Vec3, kMaxLinks>& shares, double ramp_step) noexcept;

}  // namespace catena::haptics
