/// A haptic device on the desk of a person who wears a headset. It is registered by three touched places
/// (engine/app/viewer/xr/touch_registration.h); from then on its metres lie in the room, and so in the world as it stands there:
///   world = placement(room),   room = stage(origin + rotation device)          stage: the room's own space, which recentring does not move
/// Where the runtime knows no such space the local one stands in for it, and what was found holds until the headset is recentred. Plain
/// data in and out; nothing here is OpenXR's. Frame thread.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/xr/touch_registration.h"
#include "engine/app/viewer/xr/xr_controllers.h"

namespace catena::app {

/// The room's own space in that in which heads and hands are located.
struct StageSpace {
  Vec3 position_m{0.0};
  Quat orientation{kIdentityRotation};
  bool is_stage = false;             ///< it is the stage
  std::uint64_t recenter_count = 0;  ///< so far
};

class DeviceRegistration {
 public:
  using Room = haptics::DeviceSettings::RoomRegistration;
  using Message = xr_interaction::TouchRegistration::Message;

  /// The person is asked for the three places; its forces go off. Errors: a device that cannot be registered.
  Outcome begin(HapticSession& hand);
  /// Not now: which is said.
  void cancel();
  bool is_active() const { return touch_registration_.has_value(); }
  /// What the person does next; empty: nothing is asked for.
  std::string prompt() const { return touch_registration_ ? touch_registration_->prompt() : std::string(); }

  /// Each picture. A device that could be registered and is not is asked for once.
  void step(double t_s, HapticSession& hand, const std::array<XrHand, 2>& hands, const StageSpace& space);
  /// What is to be said since the last call.
  std::vector<Message> take_messages() { return std::exchange(messages_, {}); }
  /// What was found since the last call, if it is to be kept with the device's settings.
  std::optional<Room> take_registration() { return std::exchange(found_pose_, std::nullopt); }

  /// The device's metres in the world; nothing where it is not registered.
  std::optional<scene::Workspace> workspace(const HapticSession& hand, const Placement& placement) const;

 private:
  void track_device(HapticSession& hand, const StageSpace& space);
  void finish(HapticSession& hand, const xr_interaction::Registration& found);

  std::optional<xr_interaction::TouchRegistration> touch_registration_;
  std::optional<StageSpace> space_;
  std::string device_;                                     ///< that was looked at last
  std::size_t touching_hand_ = XrControllers::kProbeHand;  ///< the hand that touches
  std::vector<Message> messages_;
  std::optional<Room> found_pose_;
};

}  // namespace catena::app
