// SPDX-License-Identifier: MIT
/// Registration of a haptic device on the desk of a user who wears a headset. Three touched points determine where it stands
/// (engine/app/viewer/xr/touch_registration.h); then positions in device meters map to tracking space, and from there to the world:
///   world = placement(tracking space),   tracking space = stage(origin + rotation device)     recentering does not move the stage space
/// If the runtime has no stage space, the local space is used, and the registration holds until the headset is recentered. Plain data,
/// independent of OpenXR. Frame thread.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/xr/touch_registration.h"
#include "engine/app/viewer/xr/xr_controllers.h"

namespace catena::app {

/// Pose of the stage space within the space in which heads and controllers are located.
struct StageSpace {
  Vec3 position_m{0.0};
  Quat orientation{kIdentityRotation};
  bool is_stage = false;             ///< False: there is no stage space, and this is the local space.
  std::uint64_t recenter_count = 0;  ///< Number of recenterings so far.
};

/// Guides the user through the registration of the current device and maps the device to the world.
class DeviceRegistration {
 public:
  /// Pose of the device in the stage space.
  using Room = haptics::DeviceSettings::RoomRegistration;
  using Message = xr_interaction::TouchRegistration::Message;

  /// Starts a registration: switches the forces off and prompts for the three points. An Error for a device that cannot be registered: not
  /// a stationary haptic device, or one with "scale" or "clutch_button" settings.
  Outcome begin(HapticSession& hand);
  /// Aborts the registration and queues a message.
  void cancel();
  bool is_active() const { return touch_registration_.has_value(); }
  /// Returns the next instruction for the user; empty if no registration is active.
  std::string prompt() const { return touch_registration_ ? touch_registration_->prompt() : std::string(); }

  /// Call once per frame. A device that can be registered and is not is prompted for once, when it is first seen. `t_s`: time of the frame.
  void step(double t_s, HapticSession& hand, const std::array<XrHand, 2>& hands, const StageSpace& space);
  /// Returns the messages for the user since the last call.
  std::vector<Message> take_messages() { return std::exchange(messages_, {}); }
  /// Returns a registration found since the last call, if it should be saved in the device's settings (only one in the stage space).
  std::optional<Room> take_registration() { return std::exchange(found_pose_, std::nullopt); }

  /// Returns the workspace that maps device meters to the world; nothing if the device is not registered.
  std::optional<scene::Workspace> workspace(const HapticSession& hand, const Placement& placement) const;

 private:
  void track_device(HapticSession& hand, const StageSpace& space);
  void finish(HapticSession& hand, const xr_interaction::Registration& found);

  std::optional<xr_interaction::TouchRegistration> touch_registration_;
  std::optional<StageSpace> space_;
  std::string device_;                                     ///< Device of the last step().
  std::size_t touching_hand_ = XrControllers::kProbeHand;  ///< Index of the controller that touches.
  std::vector<Message> messages_;
  std::optional<Room> found_pose_;
};

}  // namespace catena::app
