// SPDX-License-Identifier: MIT
#include "engine/app/haptics/device_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "engine/base/clock.h"

namespace catena::app {
namespace {

using haptics::DeviceInput;
using haptics::DeviceStatus;

constexpr double kRise_s = 0.2, kRest_s = 0.2, kPause_s = 0.1;
constexpr std::uint64_t kTicksPerPrompt = 50;
constexpr double kResting_s = 0.5, kResting_m = 0.002;
constexpr double kAgainst_m = 5e-4;  // motion against the force from which axes or signs count as wrong

class Check {
 public:
  Check(haptics::Device& device, const DeviceCheckOptions& options, const TickSchedule& schedule)
      : device_(device), options_(options), pace_(schedule) {}

  DeviceCheckResult run() {
    if (wait_until_ready() && watch() && options_.forces && settle()) push_all();
    device_.write({});
    return std::move(out_);
  }

 private:
  /// Executes one tick: reads the pose, writes the force. Returns false if the check has ended; `failure` states why.
  bool step(const Vec3& force_n, DeviceInput& input) {
    now_s_ = pace_(tick_++);
    input = device_.read();
    const bool good = input.status == DeviceStatus::ready && is_finite(input.position_m) && is_finite(input.orientation);
    device_.write({good ? force_n : Vec3(0.0), Vec3(0.0)});
    if (options_.stop != nullptr && options_.stop->load()) return fail("stopped by the user");
    if (input.status == DeviceStatus::lost)
      return fail(fmt::format("the device was lost after {:.2f} s; check the cable and the power supply", now_s_));
    if (input.status == DeviceStatus::ready && !good) return fail(fmt::format("the pose is not finite after {:.2f} s", now_s_));
    return true;
  }
  bool fail(const std::string& why) {
    device_.write({});
    out_.failure = why;
    return false;
  }

  bool wait_until_ready() {
    DeviceInput input;
    do {
      if (!step(Vec3(0.0), input)) return false;
      if (input.status != DeviceStatus::ready) report_change();
      if (now_s_ > options_.ready_timeout_s)
        return fail(fmt::format("the device is not ready after {:.0f} s; move its grip through the workspace to home it",
                                options_.ready_timeout_s));
    } while (input.status != DeviceStatus::ready);
    out_.ready_after_s = now_s_;
    return true;
  }

  bool watch() {
    double start = 0;
    const auto ticks = std::max<std::uint64_t>(3, static_cast<std::uint64_t>(options_.seconds * options_.rate_hz));
    Vec3 before(0.0), last(0.0);
    Quat first{kIdentityRotation};
    double squares = 0, ages = 0;
    for (std::uint64_t k = 0; k < ticks; ++k) {
      DeviceInput input;
      if (!step(Vec3(0.0), input)) return false;
      if (input.status != DeviceStatus::ready) return fail(fmt::format("the device was no longer ready after {:.2f} s", now_s_));
      const Vec3& p = input.position_m;
      out_.min_m = k == 0 ? p : glm::min(out_.min_m, p);
      out_.max_m = k == 0 ? p : glm::max(out_.max_m, p);
      if (k == 0) start = now_s_;
      if (k == 0) first = normalized(input.orientation);
      out_.max_rotation_rad = std::max(out_.max_rotation_rad, norm(rotation_vector(normalized(input.orientation) * glm::conjugate(first))));
      if (k >= 2) {
        const Vec3 bend = last - (before + p) * 0.5;
        squares += dot(bend, bend) / 1.5;
      }
      before = last;
      last = p;
      ages += input.age_s;
      out_.max_age_s = std::max(out_.max_age_s, input.age_s);
      out_.buttons |= input.buttons;
      ++out_.read_count;
    }
    out_.seconds = now_s_ - start;
    out_.jitter_m = std::sqrt(squares / static_cast<double>(ticks - 2));
    out_.mean_age_s = ages / static_cast<double>(ticks);
    return true;
  }

  /// Waits until the device outputs forces (a Falcon requires its grip to be pulled out once more) and the grip is at rest.
  bool settle() {
    if (!(device_.capabilities().max_force_n > 0)) return fail("the device has no force output; --forces needs a device with forces");
    const double start = now_s_;
    double since = now_s_;
    bool asked = false;
    Vec3 rest(0.0);
    for (bool first = true;; first = false) {
      DeviceInput input;
      if (!step(Vec3(0.0), input)) return false;
      if (input.status != DeviceStatus::ready) return fail(fmt::format("the device was no longer ready after {:.2f} s", now_s_));
      if (first || !input.forces_on || norm(input.position_m - rest) > kResting_m) {
        since = now_s_;
        rest = input.position_m;
      }
      if (now_s_ - since >= kResting_s) return true;
      if (!input.forces_on) report_change();
      if (now_s_ - start > options_.ready_timeout_s)
        return fail(input.forces_on
                        ? fmt::format("the grip did not rest for {:.1f} s; hold the grip still", kResting_s)
                        : fmt::format("the device has not enabled its forces after {:.0f} s; {}", options_.ready_timeout_s,
                                      device_.status_text().empty() ? "its forces may be switched off" : device_.status_text()));
      if (input.forces_on && now_s_ - start > 2 * kResting_s && !std::exchange(asked, true) && options_.prompt)
        options_.prompt("hold the grip still, away from the limits of the workspace");
    }
  }

  /// Prompts with the device's request to the user when it changes. It creates a string, and therefore runs only every kTicksPerPrompt
  /// ticks.
  void report_change() {
    if (!options_.prompt || tick_ % kTicksPerPrompt != 0) return;
    const std::string text = device_.status_text();
    if (!text.empty() && text != last_prompt_) options_.prompt(text);
    last_prompt_ = text;
  }

  void push_all() {
    const double maximum = device_.capabilities().max_force_n;
    const double size = std::min(options_.push_n, maximum);
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        Vec3 force(0.0);
        force[axis] = sign * size;
        if (!push(force)) return;
      }
  }

  bool push(const Vec3& full_n) {
    DeviceInput input;
    if (!step(Vec3(0.0), input)) return false;
    const Vec3 start = input.position_m;
    PushResult done{full_n, Vec3(0.0)};
    const auto ticks = [&](double s) { return static_cast<int>(s * options_.rate_hz); };
    const int rise = ticks(kRise_s), rest = ticks(kRest_s), all = 2 * rise + rest + ticks(kPause_s);
    for (int k = 1; k <= all; ++k) {
      const double share = std::clamp(std::min(double(k), double(2 * rise + rest - k)) / rise, 0.0, 1.0);
      if (!step(full_n * share, input)) return false;
      if (input.status != DeviceStatus::ready) return fail("the device was no longer ready during a test force");
      const Vec3 moved = input.position_m - start;
      if (k == rise + rest) done.displacement_m = moved;
      if (norm(moved) > options_.max_travel_m)
        return fail(fmt::format("the hand moved {:.1f} mm under a force of {:.2f} N along {}; hold the grip still", 1e3 * norm(moved),
                                norm(full_n * share), axis_word(full_n)));
    }
    out_.pushes.push_back(done);
    if (dot(done.displacement_m, direction(full_n)) < -kAgainst_m)
      return fail(fmt::format("the hand moved {:.2f} mm against a force along {}: axes or signs are wrong",
                              -1e3 * dot(done.displacement_m, direction(full_n)), axis_word(full_n)));
    return true;
  }

  static std::string axis_word(const Vec3& v) {
    const int axis = v.x != 0 ? 0 : v.y != 0 ? 1 : 2;
    return std::string(v[axis] < 0 ? "-" : "+") + "xyz"[axis];
  }

  haptics::Device& device_;
  const DeviceCheckOptions& options_;
  const TickSchedule& pace_;
  DeviceCheckResult out_;
  std::uint64_t tick_ = 0;
  double now_s_ = 0;
  std::string last_prompt_;
};

}  // namespace

TickSchedule make_realtime_schedule(double rate_hz) {
  const std::int64_t start = now_ns();
  return [start, rate_hz](std::uint64_t k) {
    const std::int64_t due = start + static_cast<std::int64_t>(1e9 * static_cast<double>(k) / rate_hz);
    const timespec wake{static_cast<std::time_t>(due / 1000000000), static_cast<long>(due % 1000000000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
    }
    return 1e-9 * static_cast<double>(now_ns() - start);
  };
}

TickSchedule make_immediate_schedule(double rate_hz) {
  return [rate_hz](std::uint64_t k) { return static_cast<double>(k) / rate_hz; };
}

DeviceCheckResult check_device(haptics::Device& device, const DeviceCheckOptions& options, const TickSchedule& schedule) {
  return Check(device, options, schedule).run();
}

}  // namespace catena::app
