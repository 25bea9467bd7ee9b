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
#include "render/xr/frame_wait.h"
#include "render/xr/instance.h"
#include "render/xr/session_state.h"

namespace catena::render::xr {

enum class SpaceKind { local, stage, head };

/// In the local space, metres.
struct RoomPose {
  Vec3 position{0.0};
  Quat turn = kNoRotation;
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
  const Functions& xr() const { return instance_->xr(); }

  /// Takes all events: begins and ends the session with them. Where the session or the instance is lost, instance().loss() says so.
  Outcome poll();
  /// The person wants to leave: the runtime ends the session by its events.
  Outcome ask_to_leave();

  /// Of a session that runs; made when it is first asked for.
  FrameWait& frame_wait();
  /// The wait that is under way is given some seconds; a runtime that does not come back from it is left behind, with all that is its own.
  void end_wait();

  XrSessionState state() const { return state_; }
  bool running() const { return running_; }  ///< frames are made
  bool focused() const { return state_ == XR_SESSION_STATE_FOCUSED; }
  bool has_left() const { return has_left_; }
  const std::vector<XrSessionState>& history() const { return history_; }  ///< of states, the latest 256
  std::uint64_t odd_edges() const { return odd_edges_; }                   ///< state changes that OpenXR does not have

  /// The null handle where the runtime does not have it.
  XrSpace space(SpaceKind kind) const { return spaces_[static_cast<std::size_t>(kind)]; }
  /// Where a space is in the local one at that time; nothing where it is not known. `what`: for the error.
  Result<std::optional<RoomPose>> locate(XrSpace space, XrTime at, const char* what);
  /// The origin of the local or stage space has moved: how often so far. What is placed in it may be placed anew.
  std::uint64_t recentrings() const { return recentrings_; }
  /// The parts of the lenses that are seen have changed: how often so far.
  std::uint64_t mask_changes() const { return mask_changes_; }
  /// The interaction profile has changed: how often so far.
  std::uint64_t profile_changes() const { return profile_changes_; }

  Error failed(XrResult result, const std::string& what) { return instance_->failed(result, what); }

 private:
  Session(Instance& instance, vk::Device& device) : instance_(&instance), device_(&device) {}
  Outcome make_spaces();
  Outcome enter(XrSessionState state);

  Instance* instance_;
  vk::Device* device_;
  XrSession session_ = XR_NULL_HANDLE;
  std::array<XrSpace, 3> spaces_{};
  std::unique_ptr<FrameWait> frame_wait_;
  XrSessionState state_ = XR_SESSION_STATE_UNKNOWN;
  bool running_ = false, has_left_ = false;
  std::vector<XrSessionState> history_;
  std::uint64_t odd_edges_ = 0, recentrings_ = 0, mask_changes_ = 0, profile_changes_ = 0;
};

}  // namespace catena::render::xr
