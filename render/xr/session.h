/// A session of the headset on a Vulkan device that its runtime made: begun and ended as the runtime's events say (session_state.h), with
/// the spaces in which heads and hands are located. It is destroyed before the device. Frame thread; the queue's lock is held where the
/// runtime may use the queue.
///   local:  origin where the person's head was when the session began or was recentred, y up
///   stage:  origin on the floor in the middle of the room, where the runtime knows it
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

enum class SpaceKind { local, stage, head };

/// In the local space, metres.
struct XrPose {
  Vec3 position{0.0};
  Quat orientation = kIdentityRotation;
};

class Session {
 public:
  static Result<std::unique_ptr<Session>> create(Instance& instance, vk::Device& device);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  XrSession handle() const { return session_; }
  Instance& instance() const { return *instance_; }
  vk::Device& device() const { return *device_; }
  const DispatchTable& dispatch() const { return instance_->dispatch(); }

  /// Takes all events: begins and ends the session with them. Where the session or the instance is lost, instance().loss() says so.
  Outcome poll();
  /// The person wants to leave: the runtime ends the session by its events.
  Outcome request_exit();

  /// Of a session that runs; made when it is first asked for.
  FrameWaiter& frame_waiter();
  /// The wait that is under way is given some seconds; a runtime that does not come back from it is left behind, with all that is its own.
  void stop_wait();

  XrSessionState state() const { return state_; }
  bool is_running() const { return is_running_; }  ///< frames are made
  bool is_focused() const { return state_ == XR_SESSION_STATE_FOCUSED; }
  bool has_exited() const { return has_exited_; }
  const std::vector<XrSessionState>& state_history() const { return state_history_; }  ///< of states, the latest 256
  std::uint64_t invalid_transitions() const { return invalid_transitions_; }           ///< state changes that OpenXR does not have

  /// The null handle where the runtime does not have it.
  XrSpace space(SpaceKind kind) const { return spaces_[static_cast<std::size_t>(kind)]; }
  /// Where a space is in the local one at that time; nothing where it is not known. `what`: for the error.
  Result<std::optional<XrPose>> locate(XrSpace space, XrTime at, const char* what);
  /// The origin of the local or stage space has moved: how often so far. What is placed in it may be placed anew.
  std::uint64_t recenter_count() const { return recenter_count_; }
  /// The parts of the lenses that are seen have changed: how often so far.
  std::uint64_t mask_change_count() const { return mask_change_count_; }
  /// The interaction profile has changed: how often so far.
  std::uint64_t profile_change_count() const { return profile_change_count_; }

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
