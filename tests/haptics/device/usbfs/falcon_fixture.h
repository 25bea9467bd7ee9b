// SPDX-License-Identifier: MIT
/// Shared helpers of the driver's tests on an emulated Falcon, for both buses: timeouts, homing, whole encoder counts.
#pragma once
#include <gtest/gtest.h>

#include <chrono>
#include <glm/matrix.hpp>
#include <thread>

#include "haptics/device/usb/falcon.h"
#include "tests/haptics/device/usbfs/emulated_usbfs.h"

namespace catena::haptics::tests {

/// Waits for a condition that other threads bring about; false after 30 s.
template <class F>
bool wait_until(F&& condition) {
  for (int i = 0; i < 60000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  return condition();
}

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

/// Moves out, in (homes) and out (arms), in steps of a hand's speed.
template <class Bus>
bool home_and_arm(Bus& bus, usb::Falcon& falcon) {
  for (const double z : {0.14, 0.165, 0.175, 0.165, 0.15, 0.14})
    if (!hold_grip_at(bus, {0, 0, z})) return false;
  if (!wait_until([&] { return falcon.state() == usb::FalconState::arming; })) return false;
  for (const double z : {0.155, 0.165, 0.175})
    if (!hold_grip_at(bus, {0, 0, z})) return false;
  return wait_until([&] { return falcon.state() == usb::FalconState::ready; });
}

/// The grip position near `guess_m` with whole encoder counts, by Newton iterations on the emulator's mechanism.
inline Vec3 snap_to_whole_counts(const Vec3& guess_m) {
  const Vec3 near = angles_to_counts(solve_delta_legs(guess_m)->theta);
  const Vec3 wanted{std::round(near.x), std::round(near.y), std::round(near.z)};
  Vec3 p = guess_m;
  const double rad_per_count = 0.0364347 * 3.14159265358979323846 / 180;
  for (int i = 0; i < 8; ++i) {
    const auto legs = *solve_delta_legs(p);
    p += glm::inverse(legs.dtheta_dp) * ((wanted - angles_to_counts(legs.theta)) * rad_per_count);
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
  const double half_count = 0.5 * 0.0364347 * 3.14159265358979323846 / 180;
  return half_count * (norm(p_by_theta[0]) + norm(p_by_theta[1]) + norm(p_by_theta[2]));
}

}  // namespace catena::haptics::tests
