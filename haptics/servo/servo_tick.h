// SPDX-License-Identifier: MIT
/// Tick of a servo without its thread and clock: reads the device, runs the tick, writes the force. Also the conversions between the
/// device's axes and the program's world, which the servo uses too.
///   world = origin + R device / S,   device = R^T (world - origin) S,   S in meters per unit
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include <memory>

#include "engine/base/export.h"
#include "haptics/chain/offline_ticks.h"
#include "haptics/device/device.h"
#include "haptics/servo/servo.h"

namespace catena::haptics {

/// Returns the position in the program's world, world units, of a position of the device, meters.
CATENA_EXPORT Vec3 world_from_device(const HapticProgram& program, const Vec3& device_m) noexcept;
/// Returns the position of the device, meters, of a position in the program's world, world units.
CATENA_EXPORT Vec3 device_from_world(const HapticProgram& program, const Vec3& world) noexcept;
/// Returns the input of the tick from the device's input, in the program's world. `t_s` is ignored for a recorded path, which has its own
/// time. The caller sets the condition.
CATENA_EXPORT ProbeSample make_probe_sample(const HapticProgram& program, const DeviceInput& input, double t_s) noexcept;
/// Returns the device's output from the result of the tick, in the device's axes.
CATENA_EXPORT DeviceOutput make_device_output(const HapticProgram& program, const HapticState& state, const ChainState& chain) noexcept;

/// Runs ticks one by one when the caller requests them, with equally spaced times from 0: the same device input and program give
/// bit-identical results. One thread.
class CATENA_EXPORT ServoStepper {
 public:
  /// Creates a stepper. All arguments must outlive it. `sink` receives every tick; null: none.
  ServoStepper(Device& device, const HapticProgram& program, double rate_hz, TickSink* sink = nullptr);

  /// Runs one tick. The result is valid until the next call.
  const HapticState& step();
  /// Returns the time of the next tick, seconds.
  double t_s() const noexcept { return static_cast<double>(ticks_) / rate_hz_; }

 private:
  Device& device_;
  const HapticProgram& program_;
  double rate_hz_;
  TickSink* sink_;
  std::uint64_t ticks_ = 0;
  std::unique_ptr<ChainState> state_ = std::make_unique<ChainState>();
  std::unique_ptr<ChainScratch> scratch_ = std::make_unique<ChainScratch>();
  OfflineTicks runner_;
  HapticState out_;
};

}  // namespace catena::haptics
