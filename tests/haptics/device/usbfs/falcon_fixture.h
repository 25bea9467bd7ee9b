// SPDX-License-Identifier: MIT
/// Shared helpers of the driver's tests on an emulated Falcon, for both buses: timeouts, homing, whole encoder counts.
#pragma once
#include <gtest/gtest.h>

#include <glm/matrix.hpp>
#include <numbers>

#include "haptics/device/usb/falcon.h"
#include "tests/haptics/device/usbfs/emulated_usbfs.h"
#include "tests/haptics/device/wait_until.h"

namespace catena::haptics::tests {

using test::wait_until;

/// Options without timeouts for commands and poses, so that slow machines do not fail the tests.
inline usb::FalconOptions patient_options() {
  usb::FalconOptions options;
  options.command_timeout_s = 1e6;
  options.max_pose_age_s = 1e6;
  options.reconnect_poll_ms = 20;
  return options;
}

template <class Bus>
std::uint64_t frame_count(Bus& bus) {
  return bus.with([](EmulatedFalcon& device) { return device.frames(); });
}

/// Waits for `n` more frames of the device, after which the driver has its earlier state.
template <class Bus>
bool wait_for_frames(Bus& bus, std::uint64_t n) {
  const std::uint64_t from = frame_count(bus);
  return wait_until([&] { return frame_count(bus) >= from + n; });
}

template <class Bus>
bool hold_grip_at(Bus& bus, const Vec3& position_m, std::uint64_t frames = 6) {
  EXPECT_TRUE(bus.with([&](EmulatedFalcon& device) { return device.mechanism().hold(position_m); }));
  return wait_for_frames(bus, frames);
}

/// Holds the grip at one height after the other.
template <class Bus>
bool move_grip(Bus& bus, const std::vector<double>& heights_m) {
  return std::all_of(heights_m.begin(), heights_m.end(), [&](double z) { return hold_grip_at(bus, {0, 0, z}); });
}

/// Moves out, in (homes) and out (arms), in steps of a hand's speed.
template <class Bus>
bool home_and_arm(Bus& bus, usb::Falcon& falcon) {
  if (!move_grip(bus, {0.14, 0.165, 0.175, 0.165, 0.15, 0.14})) return false;
  if (!wait_until([&] { return falcon.state() == usb::FalconState::arming; })) return false;
  return move_grip(bus, {0.155, 0.165, 0.175}) && wait_until([&] { return falcon.state() == usb::FalconState::ready; });
}

inline constexpr double kRadPerCount = 0.0364347 * std::numbers::pi / 180;

/// The grip position near `guess_m` with whole encoder counts, by Newton iterations on the emulator's mechanism.
inline Vec3 snap_to_whole_counts(const Vec3& guess_m) {
  const Vec3 near = angles_to_counts(solve_delta_legs(guess_m)->theta);
  const Vec3 wanted{std::round(near.x), std::round(near.y), std::round(near.z)};
  Vec3 p = guess_m;
  for (int i = 0; i < 8; ++i) {
    const auto legs = *solve_delta_legs(p);
    p += glm::inverse(legs.dtheta_dp) * ((wanted - angles_to_counts(legs.theta)) * kRadPerCount);
  }
  return p;
}

/// Maximum force error per axis from rounding to motor counts: half a count per motor, through (dp/dtheta)^-T.
inline Vec3 force_quantum(const Vec3& position_m) {
  const auto legs = *solve_delta_legs(position_m);
  Vec3 bound(0.0);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) bound[j] += std::fabs(legs.dtheta_dp[j][i]) * 0.5 / kEmulatedCountsPerNm;
  return bound;
}

/// Maximum position error from rounding to encoder counts: half a count per leg, through dp/dtheta.
inline double encoder_quantum_m(const Vec3& position_m) {
  const Mat3 p_by_theta = glm::inverse(solve_delta_legs(position_m)->dtheta_dp);
  return 0.5 * kRadPerCount * (norm(p_by_theta[0]) + norm(p_by_theta[1]) + norm(p_by_theta[2]));
}

}  // namespace catena::haptics::tests
