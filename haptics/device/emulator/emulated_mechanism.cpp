#include "haptics/device/emulator/emulated_mechanism.h"

#include "engine/base/assert.h"

namespace catena::haptics {

bool EmulatedMechanism::place(const Vec3& position_m) {
  const auto legs = delta_legs(position_m);
  if (!legs) return false;
  legs_ = *legs;
  position_m_ = position_m;
  return true;
}

bool EmulatedMechanism::hold(const Vec3& position_m) {
  if (!place(position_m)) return false;
  hand_.path.clear();
  velocity_ = Vec3(0.0);
  return true;
}

void EmulatedMechanism::carry(const EmulatedHand& hand) {
  CATENA_ASSERT(!hand.path.empty() && hand.mass_kg > 0);
  const bool reached = place(hand.path.front().position_m);
  CATENA_ASSERT(reached);
  hand_ = hand;
  velocity_ = Vec3(0.0);
  t_s_ = hand.path.front().t_s;
  segment_ = 0;
}

Vec3 EmulatedMechanism::wish(Vec3& velocity) {
  const auto& path = hand_.path;
  if (hand_.repeat_from_s >= 0 && t_s_ >= path.back().t_s && path.back().t_s > hand_.repeat_from_s) {
    t_s_ = hand_.repeat_from_s;
    segment_ = 0;
  }
  while (segment_ + 1 < path.size() && path[segment_ + 1].t_s <= t_s_) ++segment_;
  const auto& from = path[segment_];
  buttons_ = from.buttons;
  velocity = Vec3(0.0);
  if (segment_ + 1 == path.size() || t_s_ <= from.t_s) return from.position_m;
  const auto& to = path[segment_ + 1];
  velocity = (to.position_m - from.position_m) / (to.t_s - from.t_s);
  return from.position_m + velocity * (t_s_ - from.t_s);
}

void EmulatedMechanism::advance(double dt_s, const Counts& motors, bool homing) {
  if (!hand_.path.empty()) {
    t_s_ += dt_s;
    Vec3 wish_velocity;
    const Vec3 target = wish(wish_velocity);
    const Vec3 force = (target - position_m_) * hand_.stiffness_n_per_m + (wish_velocity - velocity_) * hand_.damping_ns_per_m +
                       force_of_motors(legs_, motors);
    velocity_ += force * (dt_s / hand_.mass_kg);
    if (!place(position_m_ + velocity_ * dt_s)) velocity_ = Vec3(0.0);
  }
  // index marks
  const Vec3 counts = counts_of_angles(legs_.theta);
  for (int i = 0; i < 3; ++i) {
    const unsigned bit = 1u << i;
    if (counts[i] > kIndexCounts) {
      outside_ |= bit;
    } else if ((outside_ & bit) != 0) {
      outside_ &= ~bit;
      if (homing) homed_ |= bit;
    }
  }
}

void EmulatedMechanism::power_off(const Counts& power_on_offset) {
  offset_ = power_on_offset;
  homed_ = outside_ = 0;
}

void EmulatedMechanism::set_homed() { homed_ = 7; }

EmulatedMechanism::Counts EmulatedMechanism::encoders() const {
  const Vec3 counts = counts_of_angles(legs_.theta);
  Counts out{};
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i)] =
        static_cast<int>(std::lround(counts[i])) + ((homed_ >> i & 1u) != 0 ? 0 : offset_[static_cast<std::size_t>(i)]);
  return out;
}

}  // namespace catena::haptics
