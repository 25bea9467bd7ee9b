/// The self-test of a device: what it says for some seconds, and, only where asked for, small pushes.
/// Without `forces` nothing but zero is written. With it, once the device lets forces through and the grip rests for half a second: along
/// each axis, both ways, a push that rises evenly to at most `push_n`, rests, and falls; it ends at once where the hand has moved by
/// `max_travel_m`, the device is not ready, or `stop` is set. Metres, newtons, seconds. One thread, which is not a real-time one.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "haptics/device/device.h"

namespace catena::app {

struct DeviceCheckOptions {
  double seconds = 2;
  double rate_hz = 1000;
  bool forces = false;
  double push_n = 1;
  double max_travel_m = 0.02;
  double ready_timeout_s = 20;  ///< firmware and homing take their time
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const std::string&)> prompt;  ///< hears what is asked of the person before it goes on; may be empty
};

/// Waits until tick k is due; the seconds since the start.
using TickSchedule = std::function<double(std::uint64_t k)>;
TickSchedule make_realtime_schedule(double rate_hz);   ///< absolute deadlines of the monotonic clock
TickSchedule make_immediate_schedule(double rate_hz);  ///< at once, as if it were k / rate: tests

struct PushResult {
  Vec3 requested_n{0.0};
  Vec3 displacement_m{0.0};  ///< at the end of the rest at full force
};

struct DeviceCheckResult {
  double ready_after_s = 0;
  std::uint64_t read_count = 0;
  double seconds = 0;  ///< from the first to the last
  Vec3 min_m{0.0}, max_m{0.0};
  double max_rotation_rad = 0;  ///< largest turn away from the first orientation
  double jitter_m = 0;          ///< rms of x_k - (x_(k-1) + x_(k+1)) / 2, by sqrt(1.5): of white noise its own
  double mean_age_s = 0, max_age_s = 0;
  std::uint32_t buttons = 0;  ///< seen
  std::vector<PushResult> pushes;
  std::string failure;  ///< one line; empty: passed

  double rate_hz() const { return seconds > 0 ? static_cast<double>(read_count - 1) / seconds : 0; }
};

DeviceCheckResult check_device(haptics::Device& device, const DeviceCheckOptions& options, const TickSchedule& pace);

}  // namespace catena::app
