// SPDX-License-Identifier: MIT
/// Session of the headset on a Vulkan device created by its runtime: begun and ended according to the runtime's events (session_state.h),
/// with the reference spaces in which head and controllers are located. To be destroyed before the device. Frame thread; the queue's lock
/// is held where the runtime may use the queue.
///   local:  origin at the user's head position when the session began or was recentered, y up
///   stage:  origin on the floor in the center of the tracking space, if the runtime knows it
///   head:   fixed to the head
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/vec.h"
#include "render/vk/device.h"
#include "render/xr/frame_waiter.h"
#include "render/xr/instance.h"
#include "render/xr/session_state.h"

namespace catena::render::xr {

/// Reference space.
enum class SpaceKind { local, stage, head };

/// Pose in the local space, meters.
struct XrPose {
  Vec3 position{0.0};
  Quat orientation = kIdentityRotation;
};

/// OpenXR session.
class Session {
 public:
  /// Creates the session and its spaces. An Error if the runtime refuses.
  static Result<std::unique_ptr<Session>> create(Instance& instance, vk::Device& device);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  XrSession handle() const { return session_; }
  Instance& instance() const { return *instance_; }
  vk::Device& device() const { return *device_; }
  const DispatchTable& dispatch() const { return instance_->dispatch(); }

  /// Processes all events: begins and ends the session accordingly. If the session or the instance is lost, instance().loss() is set.
  Outcome poll();
  /// Requests to exit when the user leaves: the runtime then ends the session by its events.
  Outcome request_exit();

  /// Returns the frame waiter of a running session; created on first use.
  FrameWaiter& frame_waiter();
  /// Stops the pending wait with a time limit of some seconds; if the runtime does not return from it, instance and device are abandoned.
  void stop_wait();

  XrSessionState state() const { return state_; }
  bool is_running() const { return is_running_; }  ///< frames can be begun
  bool is_focused() const { return state_ == XR_SESSION_STATE_FOCUSED; }
  bool has_exited() const { return has_exited_; }                                      ///< the session has ended because the user left
  const std::vector<XrSessionState>& state_history() const { return state_history_; }  ///< the latest 256 states
  std::uint64_t invalid_transitions() const { return invalid_transitions_; }  ///< number of state changes that OpenXR does not define

  /// Returns the null handle if the runtime does not support the space.
  XrSpace space(SpaceKind kind) const { return spaces_[static_cast<std::size_t>(kind)]; }
  /// Returns the pose of a space in the local space at that time; nullopt if unknown. `what`: action named in the Error.
  Result<std::optional<XrPose>> locate(XrSpace space, XrTime at, const char* what);
  /// Returns the number of changes of the origin of the local or stage space. Objects placed in them may need a new placement.
  std::uint64_t recenter_count() const { return recenter_count_; }
  /// Returns the number of changes of the visibility masks.
  std::uint64_t mask_change_count() const { return mask_change_count_; }
  /// Returns the number of changes of the interaction profile.
  std::uint64_t profile_change_count() const { return profile_change_count_; }

  /// Returns the error of a failed call; records a loss if the result implies one.
  Error failed(XrResult result, const std::string& what) { return instance_->failed(result, what); }

 private:
  Session(Instance& instance, vk::Device& device) : instance_(&instance), device_(&device) {}
  Outcome create_spaces();
  Outcome enter_state(XrSessionState state);

  Instance* instance_;
  vk::Device* device_;
  XrSession session_ = XR_NULL_HANDLE;
  std::array<XrSpace, 3> spaces_{};
  std::unique_ptr<FrameWaiter> frame_waiter_;
  XrSessionState state_ = XR_SESSION_STATE_UNKNOWN;
  bool is_running_ = false, has_exited_ = false;
  std::vector<XrSessionState> state_history_;
  std::uint64_t invalid_transitions_ = 0, recenter_count_ = 0, mask_change_count_ = 0, profile_change_count_ = 0;
};

}  // namespace catena::render::xr
