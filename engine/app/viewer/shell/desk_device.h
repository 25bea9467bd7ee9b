/// A haptic device on the desk of a person who wears a headset. It is registered by three touched places (engine/immersive/touches.h); from
/// then on its metres lie in the room, and so in the world as it stands there:
///   world = placement(room),   room = stage(origin + rotation device)          stage: the room's own space, which recentring does not move
/// Where the runtime knows no such space the local one stands in for it, and what was found holds until the headset is recentred. Plain
/// data in and out; nothing here is OpenXR's. Frame thread.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/shell/hand_host.h"
#include "engine/app/viewer/shell/headset_hands.h"
#include "engine/immersive/touches.h"

namespace catena::app {

/// The room's own space in that in which heads and hands are located.
struct RoomSpace {
  Vec3 position_m{0.0};
  Quat turn{kNoRotation};
  bool lasting = false;           ///< it is the stage
  std::uint64_t recentrings = 0;  ///< so far
};

class DeskDevice {
 public:
  using Room = haptics::DeviceSettings::Room;
  using News = immersive::Touches::News;

  /// The person is asked for the three places; its forces go off. Errors: a device that cannot be registered.
  Outcome begin(HandHost& hand);
  /// Not now: which is said.
  void cancel();
  bool touching() const { return touches_.has_value(); }
  /// What the person does next; empty: nothing is asked for.
  std::string prompt() const { return touches_ ? touches_->prompt() : std::string(); }

  /// Each picture. A device that could be registered and is not is asked for once.
  void step(double t_s, HandHost& hand, const std::array<RoomHand, 2>& hands, const RoomSpace& space);
  /// What is to be said since the last call.
  std::vector<News> take_news() { return std::exchange(news_, {}); }
  /// What was found since the last call, if it is to be kept with the device's settings.
  std::optional<Room> take_found() { return std::exchange(found_, std::nullopt); }

  /// The device's metres in the world; nothing where it is not registered.
  std::optional<scene::Workspace> workspace(const HandHost& hand, const Placement& placement) const;

 private:
  void look_at(HandHost& hand, const RoomSpace& space);
  void finish(HandHost& hand, const immersive::Registration& found);

  std::optional<immersive::Touches> touches_;
  std::optional<RoomSpace> space_;
  std::string device_;                        ///< that was looked at last
  std::size_t which_ = HeadsetHands::kProbe;  ///< the hand that touches
  std::vector<News> news_;
  std::optional<Room> found_;
};

}  // namespace catena::app
