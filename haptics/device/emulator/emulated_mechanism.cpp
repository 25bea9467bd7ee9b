// SPDX-License-Identifier: MIT
#include "haptics/device/emulator/emulated_mechanism.h"

#include <numbers>

#include "engine/base/result.h"

namespace catena::haptics {
namespace {

constexpr double kA = 0.060, kB = 0.1025, kC = 0.01443, kDE = 0.01125 + 0.01125, kF = -0.025, kR = 0.040, kS = -0.02309;
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLegDegrees[3] = {105, -15, -135};

}  // namespace

std::optional<DeltaLegs> solve_delta_legs(const Vec3& grip_m) {
  DeltaLegs legs;
  for (int i = 0; i < 3; ++i) {
    const double cos_phi = std::cos(kLegDegrees[i] * kDegree), sin_phi = std::sin(kLegDegrees[i] * kDegree);
    const double u = grip_m.x * cos_phi + grip_m.y * sin_phi - kR;
    const double v = -grip_m.x * sin_phi + grip_m.y * cos_phi - kS;
    const double w = grip_m.z;
    const double cos_3 = (v + kF) / kB, sin_3 = std::sqrt(1 - cos_3 * cos_3);
    const double length = kDE + kB * sin_3;
    const double radius = std::hypot(u + kC, w);
    const double cosine = (kA * kA + radius * radius - length * length) / (2 * kA * radius);
    const double sine = std::sqrt(1 - cosine * cosine);
    legs.theta[i] = std::atan2(w, u + kC) - std::acos(cosine);
    // d acos(q) = -dq / sqrt(1 - q^2); q depends on R and L
    const double cosine_by_radius = (1 - (kA * kA - length * length) / (radius * radius)) / (2 * kA);
    const double cosine_by_length = -length / (kA * radius);
    const double theta_by_u = -w / (radius * radius) + cosine_by_radius * (u + kC) / radius / sine;
    const double theta_by_w = (u + kC) / (radius * radius) + cosine_by_radius * w / radius / sine;
    const double theta_by_v = cosine_by_length * (-cos_3 / sin_3) / sine;
    const Vec3 row{theta_by_u * cos_phi - theta_by_v * sin_phi, theta_by_u * sin_phi + theta_by_v * cos_phi, theta_by_w};
    if (!std::isfinite(legs.theta[i]) || !is_finite(row)) return std::nullopt;
    for (int j = 0; j < 3; ++j) legs.dtheta_dp[j][i] = row[j];
  }
  return legs;
}

Vec3 angles_to_counts(const Vec3& theta) { return (theta / kDegree - Vec3(kEmulatedDegreesAtZero)) / kEmulatedDegreesPerCount; }

Vec3 compute_motor_force(const DeltaLegs& legs, const std::array<int, 3>& counts) {
  const Vec3 tau = Vec3(counts[0], counts[1], counts[2]) * (-1 / kEmulatedCountsPerNm);
  return tau * legs.dtheta_dp;  // GLM: v * M = M^T v
}

bool EmulatedMechanism::set_position(const Vec3& position_m) {
  const auto legs = solve_delta_legs(position_m);
  if (!legs) return false;
  legs_ = *legs;
  position_m_ = position_m;
  return true;
}

bool EmulatedMechanism::hold(const Vec3& position_m) {
  if (!set_position(position_m)) return false;
  user_.path.clear();
  velocity_ = Vec3(0.0);
  return true;
}

void EmulatedMechanism::attach_user(const EmulatedUser& hand) {
  CATENA_ASSERT(!hand.path.empty() && hand.mass_kg > 0);
  const bool reached = set_position(hand.path.front().position_m);
  CATENA_ASSERT(reached);
  user_ = hand;
  velocity_ = Vec3(0.0);
  t_s_ = hand.path.front().t_s;
  segment_ = 0;
}

Vec3 EmulatedMechanism::target_at(Vec3& velocity) {
  const auto& path = user_.path;
  if (user_.repeat_from_s >= 0 && t_s_ >= path.back().t_s && path.back().t_s > user_.repeat_from_s) {
    t_s_ = user_.repeat_from_s;
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
  if (!user_.path.empty()) {
    t_s_ += dt_s;
    Vec3 wish_velocity;
    const Vec3 target = target_at(wish_velocity);
    const Vec3 force = (target - position_m_) * user_.stiffness_n_per_m + (wish_velocity - velocity_) * user_.damping_ns_per_m +
                       compute_motor_force(legs_, motors);
    velocity_ += force * (dt_s / user_.mass_kg);
    if (!set_position(position_m_ + velocity_ * dt_s)) velocity_ = Vec3(0.0);
  }
  // index marks
  const Vec3 counts = angles_to_counts(legs_.theta);
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
  const Vec3 counts = angles_to_counts(legs_.theta);
  Counts out{};
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i)] =
        static_cast<int>(std::lround(counts[i])) + ((homed_ >> i & 1u) != 0 ? 0 : offset_[static_cast<std::size_t>(i)]);
  return out;
}

}  // namespace catena::haptics
