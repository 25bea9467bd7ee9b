// SPDX-License-Identifier: MIT
#include "haptics/device/process/device_host.h"

#include <poll.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "engine/base/clock.h"

namespace catena::haptics::process {

namespace {

constexpr std::int64_t kMs = 1'000'000;

void sleep_until(std::int64_t at_ns) {
  const timespec wake{static_cast<std::time_t>(at_ns / 1'000'000'000), static_cast<long>(at_ns % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) != 0) {
  }
}

bool has_gone(int lifeline) {
  pollfd line{lifeline, POLLIN, 0};  // the program sends nothing: only the end of the connection is detected
  return ::poll(&line, 1, 0) > 0;
}

bool pushes(const DeviceOutput& output) { return output.force_n != Vec3(0.0) || output.torque_nm != Vec3(0.0); }

class Host {
 public:
  Host(DevicePage& page, Device& device) : page_(page), device_(device), last_order_ns_(now_ns()) {}

  /// Runs one period: sends the newest force command to the device and publishes its newest pose to the program.
  void cycle(bool gone) {
    const std::int64_t now = now_ns();
    const bool fresh = page_.commands.acquire();
    const ForceCommand& order = page_.commands.front();
    if (fresh) last_order_ns_ = now;
    page_.zero_force_confirmed = 0;
    const bool stopped = page_.stopped != 0;
    if (!silent_ && pushes(order.output) && now - last_order_ns_ > page_.silence_timeout_ms * kMs) {
      silent_ = true;
      ++page_.takeovers;
    }
    // the program has resumed and acknowledged the takeover: the force ramps in
    if (silent_ && fresh && order.acknowledged_takeovers == page_.takeovers) silent_ = false;
    hold(gone || stopped || silent_);
    if (!held_ && fresh) device_.write(order.output);
    // the zero command is repeated, because a command is valid only for silence_timeout_ms
    if (!held_ && !fresh && pushes(order.output)) device_.write(order.output);
    page_.poses.publish({device_.read(), now});
    page_.zero_force_confirmed = held_ && device_.zero_force_confirmed() ? 1 : 0;
  }

  void tell_status() {
    StatusText& words = page_.status.back();
    std::snprintf(words.text, sizeof words.text, "%s", device_.status_text().c_str());
    page_.status.publish();
  }

 private:
  void hold(bool requested) {
    if (requested && !held_) device_.stop();
    if (!requested && held_) device_.resume();
    held_ = requested;
  }

  DevicePage& page_;
  Device& device_;
  std::int64_t last_order_ns_;
  bool held_ = false, silent_ = false;
};

}  // namespace

void describe_device(const DeviceCapabilities& device, DeviceDescription& to) {
  std::snprintf(to.name, sizeof to.name, "%s", device.name.c_str());
  to.workspace_m = device.workspace_m;
  to.workspace_center_m = device.workspace_center_m;
  to.button_count = device.button_count;
  to.has_orientation = device.has_orientation;
  to.has_vibration = device.has_vibration;
  to.max_force_n = device.max_force_n;
  to.max_torque_nm = device.max_torque_nm;
  to.mechanics = device.mechanics;
}

void serve_device(DevicePage& page, int lifeline, Device& device) {
  constexpr int kCyclesAStatus = 100;
  constexpr std::int64_t kAfterRest = 100 * kMs, kLongestEnd = 2000 * kMs;
  const auto period = static_cast<std::int64_t>(1e9 / std::clamp(page.rate_hz, 100.0, 1e4));
  Host host(page, device);
  std::int64_t next = now_ns();
  for (int cycles = 0; !has_gone(lifeline); ++cycles) {
    host.cycle(false);
    if (cycles % kCyclesAStatus == 0) host.tell_status();
    next = std::max(next + period, now_ns() - period);
    sleep_until(next);
  }
  const std::int64_t gone = now_ns();
  std::int64_t rest = 0;
  while (now_ns() - gone < kLongestEnd && (rest == 0 || now_ns() - rest < kAfterRest)) {
    host.cycle(true);
    if (rest == 0 && device.zero_force_confirmed()) rest = now_ns();
    sleep_until(now_ns() + period);
  }
}

}  // namespace catena::haptics::process
