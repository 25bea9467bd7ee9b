// SPDX-License-Identifier: MIT
#include "engine/app/viewer/xr/xr_controllers.h"

namespace catena::app {

namespace {

/// Hysteresis between pressed and released, so that a value at the threshold does not flicker.
bool is_down(double amount, bool was) { return amount > (was ? XrControllers::kReleaseThreshold : XrControllers::kPressThreshold); }

}  // namespace

void XrControllers::update(const std::array<XrHand, 2>& hands, const Vec3& head_m, double dt_s, Placement& placement) {
  std::array<xr_interaction::GrabController, 2> holding;
  for (std::size_t k = 0; k < hands.size(); ++k) {
    squeezed_[k] = hands[k].is_tracked && is_down(hands[k].squeeze, squeezed_[k]);
    holding[k] = {hands[k].position_m, hands[k].orientation, squeezed_[k]};
  }
  // when the user turns, the world turns the other way
  if (const double turn = snap_turn_.step(hands[kProbeHand].is_tracked ? hands[kProbeHand].stick_x : 0); turn != 0)
    placement = xr_interaction::rotate_about(placement, head_m, -turn);
  const Placement before = placement;
  placement = world_grab_.move(placement, holding);
  vignette_strength_ = vignette_.step(before, placement, head_m, dt_s);
}

std::optional<Vec3> XrControllers::grab_center(const std::array<XrHand, 2>& hands) const {
  Vec3 sum{0.0};
  int count = 0;
  for (std::size_t k = 0; k < hands.size(); ++k) {
    if (!squeezed_[k]) continue;
    sum += hands[k].position_m;
    ++count;
  }
  return count > 0 && is_finite(sum) ? std::optional(sum / double(count)) : std::nullopt;
}

haptics::ControllerPose XrControllers::make_controller_pose(const XrHand& hand, std::int64_t t_ns) {
  select_pressed_ = hand.is_tracked && is_down(hand.select, select_pressed_);
  return {t_ns, hand.position_m, hand.orientation, select_pressed_ ? haptics::TrackedController::kSelect : 0,
          hand.is_tracked && !is_grabbing_world()};
}

}  // namespace catena::app
