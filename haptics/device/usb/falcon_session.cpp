#include "haptics/device/usb/falcon_session.h"

#include <cstdlib>

namespace catena::haptics::usb {
namespace {

constexpr int kWriteMs = 20, kReadMs = 10, kReads = 16;
constexpr int kFramesToBelieve = 3, kLeaveTries = 3;
constexpr int kJumpCounts = 1000;  // 38 mm between two frames

}  // namespace

FalconCommand FalconSession::command(const Vec3& force_n, bool forces) noexcept {
  switch (pose_.state) {
    case FalconState::ready: {
      FalconCommand out{.control = forces ? kFalconGreen : kFalconBlue};
      if (!forces || !pose_.good) return out;
      const Vec3 torque_nm = falcon_torque(metres_per_rad_, force_n);
      if (max_abs(torque_nm) * force_gain_ > kFalconFullTorque) count(counters_.saturated);
      out.motors = falcon_motor_counts(torque_nm, force_gain_);
      return out;
    }
    case FalconState::waiting:
      return {.control = kFalconBlue};
    default:
      return {.control = static_cast<std::uint8_t>(kFalconHoming | kFalconRed)};
  }
}

bool FalconSession::send(const Vec3& force_n, bool forces) noexcept {
  count(counters_.cycles);
  sent_ = command(force_n, forces);
  const UsbError error = ftdi_.write(encode_command(sent_), kWriteMs);
  acknowledged_ = error == UsbError::none;
  return error != UsbError::gone;
}

FalconSession::Cycle FalconSession::receive() noexcept {
  // until a frame: the device answers each packet by one, whole or in parts, among packets without payload
  FalconFrame frame;
  int frames = 0;
  for (int i = 0; i < kReads && frames == 0; ++i) {
    std::span<const std::uint8_t> payload;
    const UsbError error = ftdi_.read(payload, kReadMs);
    frames = framer_.push(payload, frame);
    if (error == UsbError::gone) return Cycle::gone;
    if (error != UsbError::none) break;
  }
  counters_.resyncs.store(framer_.resyncs(), std::memory_order_relaxed);
  counters_.dropped_bytes.store(framer_.dropped_bytes(), std::memory_order_relaxed);
  if (frames == 0) {
    count(counters_.bad_cycles);
    return Cycle::no_frame;
  }
  count(counters_.frames, static_cast<std::uint64_t>(frames));
  take(frame);
  return Cycle::frame;
}

void FalconSession::leave() noexcept {
  sent_ = {};
  UsbError error = UsbError::timeout;
  for (int i = 0; i < kLeaveTries && error != UsbError::none && error != UsbError::gone; ++i)
    error = ftdi_.write(encode_command(sent_), kWriteMs);
  acknowledged_ = error == UsbError::none;
}

void FalconSession::let_go() noexcept {
  pose_.good = false;
  leave();
}

// compared with the last frame that was seen, believed or not
bool FalconSession::believed(const FalconFrame& frame) noexcept {
  bool near = has_seen_;
  for (std::size_t axis = 0; axis < 3; ++axis) near = near && std::abs(frame.encoders[axis] - last_seen_[axis]) <= kJumpCounts;
  last_seen_ = frame.encoders;
  has_seen_ = true;
  return near;
}

void FalconSession::take(const FalconFrame& frame) noexcept {
  const bool near = believed(frame);
  pose_.taken_ns = clock_();
  pose_.encoders = frame.encoders;
  pose_.buttons = frame.buttons;
  pose_.good = false;
  homed_ = frame.homed;
  homed_run_ = frame.all_homed() ? std::min(homed_run_ + 1, kFramesToBelieve) : 0;
  unhomed_run_ = frame.all_homed() ? 0 : std::min(unhomed_run_ + 1, kFramesToBelieve);

  if (state_ == FalconState::homing && homed_run_ == kFramesToBelieve) state_ = FalconState::waiting;
  if (state_ != FalconState::homing && unhomed_run_ == kFramesToBelieve) state_ = FalconState::homing;
  pose_.state = frame.all_homed() ? state_ : FalconState::homing;
  if (pose_.state == FalconState::homing) return;
  if (near)
    locate(frame);
  else
    count(counters_.jumps);
  if (state_ == FalconState::waiting && pose_.good && pose_.position_m.z > kFalconArmingZ) pose_.state = state_ = FalconState::ready;
}

void FalconSession::locate(const FalconFrame& frame) noexcept {
  const Vec3 angles = falcon_angles(frame.encoders);
  Vec3 position_m;
  pose_.good = falcon_forward(angles, position_m) && falcon_jacobian(position_m, angles, metres_per_rad_);
  if (pose_.good)
    pose_.position_m = position_m;
  else
    count(counters_.out_of_reach);
}

}  // namespace catena::haptics::usb
