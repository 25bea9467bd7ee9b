/// What the hands do in a headset, picture by picture: squeezing takes hold of the world (engine/app/viewer/xr/world_grab.h), the right
/// stick turns the person in steps, the right hand is the probe, and what it feels goes to its vibration. While a hand holds the world
/// nothing is felt: the probe counts as lost, so that the force rises again when the world is let go. Plain data in and out; nothing here
/// is OpenXR's. Frame thread.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "engine/app/viewer/xr/comfort.h"
#include "engine/app/viewer/xr/world_grab.h"
#include "haptics/device/controller.h"
#include "haptics/vibration/vibration.h"

namespace catena::app {

/// A hand in the room, metres.
struct XrHand {
  bool is_tracked = false;
  Vec3 position_m{0.0};
  Quat orientation{kIdentityRotation};
  double select = 0, squeeze = 0, stick_x = 0;
};

class XrControllers {
 public:
  static constexpr std::size_t kProbeHand = 1;  ///< the right hand
  /// A button that is squeezed is down above the one, up below the other.
  static constexpr double kPressThreshold = 0.6, kReleaseThreshold = 0.4;

  /// Each picture, `dt_s` after the last: the world follows the hands.
  void update(const std::array<XrHand, 2>& hands, const Vec3& head_m, double dt_s, Placement& placement);
  bool is_grabbing_world() const { return world_grab_.is_grabbing(); }
  /// Between the hands that hold it, metres of room; nothing where none does.
  std::optional<Vec3> grab_center(const std::array<XrHand, 2>& hands) const;
  /// How far the picture narrows, 0..1.
  double vignette_strength() const { return vignette_strength_; }

  /// What the controller is told of the probe's hand, as it was at a time of engine/base/clock.h.
  haptics::ControllerPose make_controller_pose(const XrHand& hand, std::int64_t t_ns);
  /// What the runtime is asked for. `focused`: the session has the person.
  haptics::VibrationSender::Command next_vibration(haptics::PeakDetector& peaks, std::int64_t now_ns, bool focused, const XrHand& hand) {
    return vibration_sender_.next(peaks, now_ns, focused && hand.is_tracked && !is_grabbing_world());
  }

 private:
  xr_interaction::WorldGrab world_grab_;
  xr_interaction::SnapTurn snap_turn_;
  xr_interaction::Vignette vignette_;
  haptics::VibrationSender vibration_sender_;
  std::array<bool, 2> squeezed_{};
  bool select_pressed_ = false;
  double vignette_strength_ = 0;
};

}  // namespace catena::app
