#include "engine/app/viewer/shell/headset_hands.h"

namespace catena::app {

namespace {

/// With a gap between down and up, so that a finger at the edge does not flicker.
bool is_down(double amount, bool was) { return amount > (was ? HeadsetHands::kUp : HeadsetHands::kDown); }

}  // namespace

void HeadsetHands::step(const std::array<RoomHand, 2>& hands, const Vec3& head_m, double dt_s, Placement& placement) {
  std::array<immersive::Hand, 2> holding;
  for (std::size_t k = 0; k < hands.size(); ++k) {
    squeezed_[k] = hands[k].there && is_down(hands[k].grab, squeezed_[k]);
    holding[k] = {hands[k].position_m, hands[k].turn, squeezed_[k]};
  }
  // the person turns, the world the other way
  if (const double turn = turn_.step(hands[kProbe].there ? hands[kProbe].stick_x : 0); turn != 0)
    placement = immersive::turned_about(placement, head_m, -turn);
  const Placement before = placement;
  placement = grab_.move(placement, holding);
  narrow_ = vignette_.step(before, placement, head_m, dt_s);
}

std::optional<Vec3> HeadsetHands::held_middle(const std::array<RoomHand, 2>& hands) const {
  Vec3 sum{0.0};
  int count = 0;
  for (std::size_t k = 0; k < hands.size(); ++k) {
    if (!squeezed_[k]) continue;
    sum += hands[k].position_m;
    ++count;
  }
  return count > 0 && is_finite(sum) ? std::optional(sum / double(count)) : std::nullopt;
}

haptics::ControllerPose HeadsetHands::probe(const RoomHand& hand, std::int64_t t_ns) {
  selected_ = hand.there && is_down(hand.select, selected_);
  return {t_ns, hand.position_m, hand.turn, selected_ ? haptics::Controller::kSelect : 0, hand.there && !holds_world()};
}

}  // namespace catena::app
