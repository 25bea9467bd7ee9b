// SPDX-License-Identifier: MIT
/// Self-test of a device: reads it for some seconds and, only if requested, applies small test forces. Without `forces` only zero force is
/// written. With `forces`, when the device's forces are enabled and the grip has rested for half a second, a test force is applied along
/// each axis in both directions: it rises linearly to at most `push_n`, stays constant, and falls. The check ends at once if the grip moves
/// by more than `max_travel_m`, the device is not ready, or `stop` is set. Meters, newtons, seconds. One thread, which is not a real-time
/// thread.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "haptics/device/device.h"

namespace catena::app {

/// Options of the check.
struct DeviceCheckOptions {
  double seconds = 2;
  double rate_hz = 1000;
  bool forces = false;
  double push_n = 1;
  double max_travel_m = 0.02;
  double ready_timeout_s = 20;  ///< Time limit for the device to become ready; firmware upload and homing take time
  const std::atomic<bool>* stop = nullptr;
  /// Receives instructions for the user; may be empty
  std::function<void(const std::string&)> prompt;
};

/// Waits until tick k is due and returns the seconds since the start.
using TickSchedule = std::function<double(std::uint64_t k)>;
TickSchedule make_realtime_schedule(double rate_hz);   ///< Absolute deadlines on the monotonic clock
TickSchedule make_immediate_schedule(double rate_hz);  ///< Returns k / rate at once: for tests

/// Result of one test force.
struct PushResult {
  Vec3 requested_n{0.0};
  Vec3 displacement_m{0.0};  ///< Displacement at the end of the constant phase
};

/// Result of the check.
struct DeviceCheckResult {
  double ready_after_s = 0;
  std::uint64_t read_count = 0;
  double seconds = 0;  ///< From the first to the last read
  Vec3 min_m{0.0}, max_m{0.0};
  double max_rotation_rad = 0;  ///< Largest rotation away from the first orientation
  /// rms of x_k - (x_(k-1) + x_(k+1)) / 2, divided by sqrt(1.5): for white noise its standard deviation
  double jitter_m = 0;
  double mean_age_s = 0, max_age_s = 0;
  std::uint32_t buttons = 0;  ///< Union of all buttons that were pressed
  std::vector<PushResult> pushes;
  std::string failure;  ///< Reason of the failure, one line; empty: passed

  /// Measured rate of reads.
  double rate_hz() const { return seconds > 0 ? static_cast<double>(read_count - 1) / seconds : 0; }
};

/// Runs the check on an open device.
DeviceCheckResult check_device(haptics::Device& device, const DeviceCheckOptions& options, const TickSchedule& schedule);

}  // namespace catena::app
