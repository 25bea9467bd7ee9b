/// What the hands do in a headset, picture by picture: squeezing takes hold of the world (engine/immersive/world_grab.h), the right stick
/// turns the person in steps, the right hand is the probe, and what it feels goes to its vibration. While a hand holds the world nothing is
/// felt: the probe counts as lost, so that the force rises again when the world is let go. Plain data in and out; nothing here is OpenXR's.
/// Frame thread.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "engine/immersive/comfort.h"
#include "engine/immersive/world_grab.h"
#include "haptics/device/controller.h"
#include "haptics/vibration/vibration.h"

namespace catena::app {

/// A hand in the room, metres.
struct RoomHand {
  bool there = false;
  Vec3 position_m{0.0};
  Quat turn{kNoRotation};
  double select = 0, grab = 0, stick_x = 0;
};

class HeadsetHands {
 public:
  static constexpr std::size_t kProbe = 1;  ///< the right hand
  /// A button that is squeezed is down above the one, up below the other.
  static constexpr double kDown = 0.6, kUp = 0.4;

  /// Each picture, `dt_s` after the last: the world follows the hands.
  void step(const std::array<RoomHand, 2>& hands, const Vec3& head_m, double dt_s, Placement& placement);
  bool holds_world() const { return grab_.holds(); }
  /// Between the hands that hold it, metres of room; nothing where none does.
  std::optional<Vec3> held_middle(const std::array<RoomHand, 2>& hands) const;
  /// How far the picture narrows, 0..1.
  double vignette() const { return narrow_; }

  /// What the controller is told of the probe's hand, as it was at a time of engine/base/clock.h.
  haptics::ControllerPose probe(const RoomHand& hand, std::int64_t t_ns);
  /// What the runtime is asked for. `focused`: the session has the person.
  haptics::VibrationSender::Call vibration(haptics::Peaks& peaks, std::int64_t now_ns, bool focused, const RoomHand& hand) {
    return sender_.next(peaks, now_ns, focused && hand.there && !holds_world());
  }

 private:
  immersive::WorldGrab grab_;
  immersive::SnapTurn turn_;
  immersive::Vignette vignette_;
  haptics::VibrationSender sender_;
  std::array<bool, 2> squeezed_{};
  bool selected_ = false;
  double narrow_ = 0;
};

}  // namespace catena::app
