#include "haptics/device/controller.h"

#include <algorithm>

namespace catena::haptics {
namespace {

constexpr double kBehind = 1.1;                    // of the longest interval
constexpr int kIntervals = 3;                      // of which it is the longest
constexpr double kSettle_ns = 1e8;                 // how fast a wrong lag goes
constexpr double kSlowest = 0.8, kFastest = 1.25;  // of the time that passes

}  // namespace

DeviceCapabilities Controller::nominal() {
  DeviceCapabilities out;
  out.name = "controller";
  out.workspace_m = 1;
  out.has_orientation = true;
  out.buttons = 2;
  out.vibrates = true;
  return out;
}

Controller::Controller(const ControllerParameters& parameters)
    : parameters_(parameters),
      capabilities_(nominal()),
      peaks_(parameters.rate_hz),
      eased_(Vec3(0.0), parameters.smoothing_s, parameters.rate_hz) {}

void Controller::say(const ControllerPose& pose) {
  if (!is_finite(pose.position_m) || !is_finite(pose.orientation)) return;
  if (!pose.tracked) {
    if (told_.count == 0) return;
    told_.count = 0;
  } else {
    if (told_.count > 0 && pose.t_ns <= told_.poses[0].t_ns) return;
    const bool silent = told_.count > 0 && 1e-9 * static_cast<double>(pose.t_ns - told_.poses[0].t_ns) > parameters_.lost_s;
    if (told_.count == 0 || silent) {
      told_.count = 0;
      ++told_.stay;
    }
    std::copy_backward(told_.poses.begin(), told_.poses.end() - 1, told_.poses.end());
    told_.poses[0] = pose;
    told_.count = std::min(told_.count + 1, Past::kMost);
  }
  shared_.publish(told_);
}

// One tick of the clock that is behind the samples, and the place at it.
void Controller::play(const Past& past, std::int64_t now_ns) noexcept {
  std::int64_t longest = 0;
  for (int i = 0; i + 1 < past.count && i < kIntervals; ++i) longest = std::max(longest, past.poses[i].t_ns - past.poses[i + 1].t_ns);
  const ControllerPose& newest = past.poses[0];
  const ControllerPose& oldest = past.poses[past.count - 1];
  if (!there_ || past.stay != stay_) {
    stay_ = past.stay;
    play_ns_ = newest.t_ns;
    eased_.put(newest.position_m, normalised(newest.orientation));
    return;
  }
  const double passed = static_cast<double>(std::max<std::int64_t>(0, now_ns - last_ns_));
  const double lag = static_cast<double>(now_ns - play_ns_), wanted = kBehind * static_cast<double>(longest);
  const double pace = std::clamp(1 + (lag - wanted) / kSettle_ns, kSlowest, kFastest);
  play_ns_ = std::clamp(play_ns_ + static_cast<std::int64_t>(pace * passed), oldest.t_ns, newest.t_ns);

  int after = 0;
  while (after + 1 < past.count && past.poses[after + 1].t_ns > play_ns_) ++after;
  const ControllerPose& to = past.poses[after];
  const ControllerPose& from = past.poses[std::min(after + 1, past.count - 1)];
  const double length = static_cast<double>(to.t_ns - from.t_ns);
  const double part = length > 0 ? static_cast<double>(play_ns_ - from.t_ns) / length : 1;
  const Quat start = normalised(from.orientation);
  const Vec3 turn = rotation_vector(normalised(normalised(to.orientation) * glm::conjugate(start)));
  eased_.follow(from.position_m + part * (to.position_m - from.position_m), normalised(rotation_of(part * turn) * start));
}

DeviceInput Controller::read() noexcept {
  shared_.take();
  const Past& past = shared_.front();
  const std::int64_t now_ns = parameters_.now();
  DeviceInput input;
  const bool was_there = past.stay > 0;
  const double age_s = 1e-9 * static_cast<double>(now_ns - past.poses[0].t_ns);
  if (past.count > 0 && age_s <= parameters_.lost_s) {
    play(past, now_ns);
    there_ = true;
    input.buttons = past.poses[0].buttons;
    input.age_s = std::max(0.0, age_s);
  } else {
    there_ = false;
    input.status = was_there ? DeviceStatus::lost : DeviceStatus::starting;
  }
  last_ns_ = now_ns;
  input.position_m = eased_.position_m();
  input.orientation = eased_.orientation();
  return input;
}

void Controller::write(const DeviceOutput& output) noexcept {
  peaks_.add({output.told_n, eased_.position_m(), output.booked_j, output.live && there_});
}

}  // namespace catena::haptics
