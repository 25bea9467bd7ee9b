// SPDX-License-Identifier: MIT
#include "haptics/device/controller.h"

#include <algorithm>

namespace catena::haptics {
namespace {

constexpr double kBehind = 1.1;                    // playback delay, relative to the longest interval
constexpr int kIntervals = 3;                      // number of intervals from which the longest is taken
constexpr double kSettle_ns = 1e8;                 // time constant with which the playback lag is corrected
constexpr double kSlowest = 0.8, kFastest = 1.25;  // limits of the playback rate, relative to real time

}  // namespace

DeviceCapabilities TrackedController::nominal_capabilities() {
  DeviceCapabilities out;
  out.name = "controller";
  out.workspace_m = 1;
  out.has_orientation = true;
  out.button_count = 2;
  out.has_vibration = true;
  return out;
}

TrackedController::TrackedController(const ControllerParameters& parameters)
    : parameters_(parameters),
      capabilities_(nominal_capabilities()),
      peaks_(parameters.rate_hz),
      filter_(Vec3(0.0), parameters.smoothing_s, parameters.rate_hz) {}

void TrackedController::push_pose(const ControllerPose& pose) {
  if (!is_finite(pose.position_m) || !is_finite(pose.orientation)) return;
  if (!pose.tracked) {
    if (history_.count == 0) return;
    history_.count = 0;
  } else {
    if (history_.count > 0 && pose.t_ns <= history_.poses[0].t_ns) return;
    const bool silent = history_.count > 0 && 1e-9 * static_cast<double>(pose.t_ns - history_.poses[0].t_ns) > parameters_.lost_timeout_s;
    if (history_.count == 0 || silent) {
      history_.count = 0;
      ++history_.session_id;
    }
    std::copy_backward(history_.poses.begin(), history_.poses.end() - 1, history_.poses.end());
    history_.poses[0] = pose;
    history_.count = std::min(history_.count + 1, PoseHistory::kMaxPoses);
  }
  shared_.publish(history_);
}

// Advances the playback clock, which lags behind the samples, by one tick, and interpolates the pose at it.
void TrackedController::advance_playback(const PoseHistory& past, std::int64_t now_ns) noexcept {
  std::int64_t longest = 0;
  for (int i = 0; i + 1 < past.count && i < kIntervals; ++i) longest = std::max(longest, past.poses[i].t_ns - past.poses[i + 1].t_ns);
  const ControllerPose& newest = past.poses[0];
  const ControllerPose& oldest = past.poses[past.count - 1];
  if (!tracked_ || past.session_id != session_id_) {
    session_id_ = past.session_id;
    playback_ns_ = newest.t_ns;
    filter_.reset(newest.position_m, normalized(newest.orientation));
    return;
  }
  const double passed = static_cast<double>(std::max<std::int64_t>(0, now_ns - last_ns_));
  const double lag = static_cast<double>(now_ns - playback_ns_), wanted = kBehind * static_cast<double>(longest);
  const double pace = std::clamp(1 + (lag - wanted) / kSettle_ns, kSlowest, kFastest);
  playback_ns_ = std::clamp(playback_ns_ + static_cast<std::int64_t>(pace * passed), oldest.t_ns, newest.t_ns);

  int after = 0;
  while (after + 1 < past.count && past.poses[after + 1].t_ns > playback_ns_) ++after;
  const ControllerPose& to = past.poses[after];
  const ControllerPose& from = past.poses[std::min(after + 1, past.count - 1)];
  const double length = static_cast<double>(to.t_ns - from.t_ns);
  const double part = length > 0 ? static_cast<double>(playback_ns_ - from.t_ns) / length : 1;
  const Quat start = normalized(from.orientation);
  const Vec3 turn = rotation_vector(normalized(normalized(to.orientation) * glm::conjugate(start)));
  filter_.step_toward(from.position_m + part * (to.position_m - from.position_m), normalized(rotation_from_vector(part * turn) * start));
}

DeviceInput TrackedController::read() noexcept {
  shared_.acquire();
  const PoseHistory& past = shared_.front();
  const std::int64_t now_ns = parameters_.clock();
  DeviceInput input;
  const bool was_there = past.session_id > 0;
  const double age_s = 1e-9 * static_cast<double>(now_ns - past.poses[0].t_ns);
  if (past.count > 0 && age_s <= parameters_.lost_timeout_s) {
    advance_playback(past, now_ns);
    tracked_ = true;
    input.buttons = past.poses[0].buttons;
    input.age_s = std::max(0.0, age_s);
  } else {
    tracked_ = false;
    input.status = was_there ? DeviceStatus::lost : DeviceStatus::starting;
  }
  last_ns_ = now_ns;
  input.position_m = filter_.position_m();
  input.orientation = filter_.orientation();
  return input;
}

void TrackedController::write(const DeviceOutput& output) noexcept {
  peaks_.add({output.requested_force_n, filter_.position_m(), output.accounted_j, output.forces_active && tracked_});
}

}  // namespace catena::haptics
