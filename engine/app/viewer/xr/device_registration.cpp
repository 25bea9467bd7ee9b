// SPDX-License-Identifier: MIT
#include "engine/app/viewer/xr/device_registration.h"

#include <fmt/format.h>

namespace catena::app {
namespace {

constexpr double kJitter_m = 1e-3, kJitter_rad = 2e-3;  // in tracking space: smaller changes count as no motion

bool has_moved(const StageSpace& from, const StageSpace& to) {
  return from.is_stage != to.is_stage || !(norm(to.position_m - from.position_m) <= kJitter_m) ||
         !(norm(rotation_vector(normalized(to.orientation * glm::conjugate(from.orientation)))) <= kJitter_rad);
}

}  // namespace

Outcome DeviceRegistration::begin(HapticSession& hand) {
  const std::string& name = hand.device_name();
  const haptics::DeviceSettings& settings = hand.device().settings;
  if (!haptics::is_stationary(haptics::parse_device_type(name)))
    return Error{name + " has no fixed position in the room and cannot be registered; a haptic device was expected"};
  if (settings.scale != 1 || settings.clutch_button != 0)
    return Error{fmt::format("{}: a device with {} cannot be registered, because its motion is not the motion in the room", name,
                             settings.scale != 1 ? "\"scale\"" : "\"clutch_button\"")};
  if (hand.forces_enabled()) hand.set_forces_enabled(false);
  touch_registration_.emplace(name);
  messages_.push_back({touch_registration_->prompt()});
  return Done{};
}

void DeviceRegistration::cancel() {
  if (touch_registration_) messages_.push_back({device_ + " is not registered; press G, or use the panel Device, to register the device"});
  touch_registration_.reset();
}

/// Discards the registration when the device or the tracking space changes, since it may no longer hold.
void DeviceRegistration::track_device(HapticSession& hand, const StageSpace& space) {
  const bool recentred = space_ && space.recenter_count != space_->recenter_count;
  const bool is_new = device_ != hand.device_name() || !space_;
  const bool lost = hand.room() && !space.is_stage && (is_new || recentred);
  if (!space_ || recentred || has_moved(*space_, space)) space_ = space;
  device_ = hand.device_name();
  if (lost) {
    hand.set_room(std::nullopt);
    messages_.push_back({"the registration of " + device_ + " is lost: the headset has no stage space, which is fixed in the room", true});
  }
  if (!is_new && !lost) return;
  touch_registration_.reset();
  if (!hand.room() && haptics::is_stationary(haptics::parse_device_type(device_)))
    if (const Outcome asked = begin(hand); !asked) messages_.push_back({asked.error().message, true});
}

void DeviceRegistration::finish(HapticSession& hand, const xr_interaction::Registration& found) {
  const Quat stage_from_local = glm::conjugate(space_->orientation);
  const Room room{rotate(stage_from_local, found.origin_m - space_->position_m),
                  glm::mat3_cast(normalized(stage_from_local * found.room_from_device))};
  touch_registration_.reset();
  hand.set_room(room);
  if (space_->is_stage)
    found_pose_ = room;
  else
    messages_.push_back(
        {"the headset has no stage space, which is fixed in the room: the registration holds until the view is recentred", true});
}

void DeviceRegistration::step(double t_s, HapticSession& hand, const std::array<XrHand, 2>& hands, const StageSpace& space) {
  track_device(hand, space);
  if (!touch_registration_) return;
  for (std::size_t k = 0; k < hands.size(); ++k)
    if (hands[k].is_tracked && hands[k].select > XrControllers::kPressThreshold &&
        !(hands[touching_hand_].select > XrControllers::kPressThreshold))
      touching_hand_ = k;
  const XrHand& touching = hands[touching_hand_];
  xr_interaction::TouchRegistration::TouchInput controller, device{hand.handle_position_m(), hand.latest_state().buttons != 0};
  if (touching.is_tracked) controller.position_m = touching.position_m;
  controller.pressed = touching.select > XrControllers::kPressThreshold;
  for (Message& one : touch_registration_->step(t_s, device, controller)) messages_.push_back(std::move(one));
  if (const auto found = touch_registration_->registration()) finish(hand, *found);
}

std::optional<scene::Workspace> DeviceRegistration::workspace(const HapticSession& hand, const Placement& placement) const {
  const auto& room = hand.room();
  if (!room || !space_ || device_ != hand.device_name()) return std::nullopt;
  const Vec3 origin = space_->position_m + rotate(space_->orientation, room->origin_m);
  const Mat3 local_from_hand = glm::mat3_cast(space_->orientation) * room->room_from_workspace;
  return scene::Workspace{placement.meters_per_unit, placement.to_world(origin), placement.world_from_room * local_from_hand, true};
}

}  // namespace catena::app
