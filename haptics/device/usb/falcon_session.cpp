// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_session.h"

#include <cstdlib>

namespace catena::haptics::usb {
namespace {

constexpr int kWriteMs = 20, kReadMs = 10, kReads = 16;
constexpr int kFramesToBelieve = 3, kLeaveTries = 3;
constexpr int kJumpCounts = 1000;  // 38 mm between two frames

}  // namespace

FalconCommand FalconSession::make_command(const Vec3& force_n, bool forces) noexcept {
  switch (pose_.state) {
    case FalconState::ready: {
      FalconCommand out{.control = forces ? kFalconGreen : kFalconBlue};
      if (!forces || !pose_.valid) return out;
      const Vec3 torque_nm = falcon_torque(meters_per_rad_, force_n);
      if (max_abs(torque_nm) * force_gain_ > kFalconFullTorque) increment(counters_.saturated);
      out.motors = falcon_motor_counts(torque_nm, force_gain_);
      return out;
    }
    case FalconState::arming:
      return {.control = kFalconBlue};
    default:
      return {.control = static_cast<std::uint8_t>(kFalconHoming | kFalconRed)};
  }
}

bool FalconSession::send(const Vec3& force_n, bool forces) noexcept {
  increment(counters_.cycles);
  sent_ = make_command(force_n, forces);
  const UsbError error = ftdi_.write(encode_command(sent_), kWriteMs);
  acknowledged_ = error == UsbError::none;
  return error != UsbError::disconnected;
}

FalconSession::Cycle FalconSession::receive() noexcept {
  // reads until a frame arrives: the device answers each packet with one frame, whole or in parts, among packets without payload
  FalconFrame frame;
  int frames = 0;
  for (int i = 0; i < kReads && frames == 0; ++i) {
    std::span<const std::uint8_t> payload;
    const UsbError error = ftdi_.read(payload, kReadMs);
    frames = framer_.push(payload, frame);
    if (error == UsbError::disconnected) return Cycle::disconnected;
    if (error != UsbError::none) break;
  }
  counters_.resyncs.store(framer_.resyncs(), std::memory_order_relaxed);
  counters_.dropped_bytes.store(framer_.dropped_bytes(), std::memory_order_relaxed);
  if (frames == 0) {
    increment(counters_.bad_cycles);
    return Cycle::no_frame;
  }
  increment(counters_.frames, static_cast<std::uint64_t>(frames));
  handle_frame(frame);
  return Cycle::frame;
}

void FalconSession::send_shutdown() noexcept {
  sent_ = {};
  UsbError error = UsbError::timeout;
  for (int i = 0; i < kLeaveTries && error != UsbError::none && error != UsbError::disconnected; ++i)
    error = ftdi_.write(encode_command(sent_), kWriteMs);
  acknowledged_ = error == UsbError::none;
}

void FalconSession::release_force() noexcept {
  pose_.valid = false;
  send_shutdown();
}

// Compares a frame with the last one, accepted or not.
bool FalconSession::is_plausible(const FalconFrame& frame) noexcept {
  bool near = has_encoders_;
  for (std::size_t axis = 0; axis < 3; ++axis) near = near && std::abs(frame.encoders[axis] - last_encoders_[axis]) <= kJumpCounts;
  last_encoders_ = frame.encoders;
  has_encoders_ = true;
  return near;
}

void FalconSession::handle_frame(const FalconFrame& frame) noexcept {
  const bool near = is_plausible(frame);
  pose_.sampled_ns = clock_();
  pose_.encoders = frame.encoders;
  pose_.buttons = frame.buttons;
  pose_.valid = false;
  homed_ = frame.homed;
  homed_run_ = frame.all_homed() ? std::min(homed_run_ + 1, kFramesToBelieve) : 0;
  unhomed_run_ = frame.all_homed() ? 0 : std::min(unhomed_run_ + 1, kFramesToBelieve);

  if (state_ == FalconState::homing && homed_run_ == kFramesToBelieve) state_ = FalconState::arming;
  if (state_ != FalconState::homing && unhomed_run_ == kFramesToBelieve) state_ = FalconState::homing;
  pose_.state = frame.all_homed() ? state_ : FalconState::homing;
  if (pose_.state == FalconState::homing) return;
  if (near)
    update_position(frame);
  else
    increment(counters_.jumps);
  if (state_ == FalconState::arming && pose_.valid && pose_.position_m.z > kFalconArmingZ) pose_.state = state_ = FalconState::ready;
}

void FalconSession::update_position(const FalconFrame& frame) noexcept {
  const Vec3 angles = falcon_angles(frame.encoders);
  Vec3 position_m;
  pose_.valid = falcon_forward_kinematics(angles, position_m) && falcon_jacobian(position_m, angles, meters_per_rad_);
  if (pose_.valid)
    pose_.position_m = position_m;
  else
    increment(counters_.out_of_reach);
}

}  // namespace catena::haptics::usb
