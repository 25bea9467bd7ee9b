/// A servo's tick without its thread and its clock: read the device, run the tick, write the force. And how the hand's metres lie in a
/// program's world, for both.
///   world = origin + R device / S,   device = R^T (world - origin) S,   S metres per unit
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include <memory>

#include "haptics/chain/tick.h"
#include "haptics/device/device.h"
#include "haptics/servo/servo.h"

namespace catena::haptics {

/// The place in the program's world of the device's metres.
Vec3 world_from_device(const HapticProgram& program, const Vec3& device_m) noexcept;
/// The device's metres of a place in the program's world.
Vec3 device_from_world(const HapticProgram& program, const Vec3& world) noexcept;
/// What the device says, in the program's world. The condition is the caller's.
ProbeSample make_probe_sample(const HapticProgram& program, const DeviceInput& input, double t_s) noexcept;
/// What the tick answers, in the device's axes.
DeviceOutput make_device_output(const HapticProgram& program, const HapticState& state, const ChainState& chain) noexcept;

/// Ticks one after the other, as fast as they are asked for, at even times from 0: the same device and program give the same bits.
class ServoStepper {
 public:
  /// All outlive it. `sink` gets every tick.
  ServoStepper(Device& device, const HapticProgram& program, double rate_hz, TickSink* sink = nullptr);

  /// One tick; what it says stays until the next.
  const HapticState& step() noexcept;
  double t_s() const noexcept { return static_cast<double>(ticks_) / rate_hz_; }  ///< of the next tick

 private:
  Device& device_;
  const HapticProgram& program_;
  double rate_hz_;
  TickSink* sink_;
  std::uint64_t ticks_ = 0;
  std::unique_ptr<ChainState> state_ = std::make_unique<ChainState>();
  std::unique_ptr<ChainScratch> scratch_ = std::make_unique<ChainScratch>();
  HapticState out_;
};

}  // namespace catena::haptics
