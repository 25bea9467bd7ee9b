#include "engine/app/viewer/shell/desk_device.h"

#include <fmt/format.h>

namespace catena::app {
namespace {

constexpr double kJitter_m = 1e-3, kJitter_rad = 2e-3;  // of the room's space: less is no motion

bool has_moved(const RoomSpace& from, const RoomSpace& to) {
  return from.lasting != to.lasting || !(norm(to.position_m - from.position_m) <= kJitter_m) ||
         !(norm(rotation_vector(normalised(to.turn * glm::conjugate(from.turn)))) <= kJitter_rad);
}

}  // namespace

Outcome DeskDevice::begin(HandHost& hand) {
  const std::string& name = hand.device_name();
  const haptics::DeviceSettings& settings = hand.hand().settings;
  if (!haptics::has_place(haptics::device_type_of(name)))
    return Error{name + " has no place of its own on the desk, so there is nothing to register; a haptic device was expected"};
  if (settings.scale != 1 || settings.clutch_button != 0)
    return Error{fmt::format("{}: with {} its metres are not the room's; a device without was expected", name,
                             settings.scale != 1 ? "\"scale\"" : "\"clutch_button\"")};
  if (hand.forces()) hand.set_forces(false);
  touches_.emplace(name);
  news_.push_back({touches_->prompt()});
  return Done{};
}

void DeskDevice::cancel() {
  if (touches_) news_.push_back({device_ + " is not registered; G, or the panel Device, asks for its three places again"});
  touches_.reset();
}

/// Another device, or another room: what was known of the one in the other may not hold any more.
void DeskDevice::look_at(HandHost& hand, const RoomSpace& space) {
  const bool recentred = space_ && space.recentrings != space_->recentrings;
  const bool is_new = device_ != hand.device_name() || !space_;
  const bool lost = hand.room() && !space.lasting && (is_new || recentred);
  if (!space_ || recentred || has_moved(*space_, space)) space_ = space;
  device_ = hand.device_name();
  if (lost) {
    hand.set_room(std::nullopt);
    news_.push_back({"where " + device_ + " stands is not known: the headset has no space for the room itself (stage)", true});
  }
  if (!is_new && !lost) return;
  touches_.reset();
  if (!hand.room() && haptics::has_place(haptics::device_type_of(device_)))
    if (const Outcome asked = begin(hand); !asked) news_.push_back({asked.error().message, true});
}

void DeskDevice::finish(HandHost& hand, const immersive::Registration& found) {
  const Quat stage_from_local = glm::conjugate(space_->turn);
  const Room room{rotate(stage_from_local, found.origin_m - space_->position_m),
                  glm::mat3_cast(normalised(stage_from_local * found.room_from_device))};
  touches_.reset();
  hand.set_room(room);
  if (space_->lasting)
    found_ = room;
  else
    news_.push_back({"the headset has no space for the room itself (stage): this holds until it is recentred", true});
}

void DeskDevice::step(double t_s, HandHost& hand, const std::array<RoomHand, 2>& hands, const RoomSpace& space) {
  look_at(hand, space);
  if (!touches_) return;
  for (std::size_t k = 0; k < hands.size(); ++k)
    if (hands[k].there && hands[k].select > HeadsetHands::kDown && !(hands[which_].select > HeadsetHands::kDown)) which_ = k;
  const RoomHand& touching = hands[which_];
  immersive::Touches::Toucher controller, device{hand.place_m(), hand.felt().buttons != 0};
  if (touching.there) controller.place_m = touching.position_m;
  controller.pressed = touching.select > HeadsetHands::kDown;
  for (News& one : touches_->step(t_s, device, controller)) news_.push_back(std::move(one));
  if (const auto found = touches_->found()) finish(hand, *found);
}

std::optional<scene::Workspace> DeskDevice::workspace(const HandHost& hand, const Placement& placement) const {
  const auto& room = hand.room();
  if (!room || !space_ || device_ != hand.device_name()) return std::nullopt;
  const Vec3 origin = space_->position_m + rotate(space_->turn, room->origin_m);
  const Mat3 local_from_hand = glm::mat3_cast(space_->turn) * room->room_from_hand;
  return scene::Workspace{placement.metres_per_unit, placement.to_world(origin), placement.world_from_room * local_from_hand, true};
}

}  // namespace catena::app
