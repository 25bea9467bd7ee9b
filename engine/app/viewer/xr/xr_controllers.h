// SPDX-License-Identifier: MIT
/// Interpretation of the XR controllers, frame by frame: squeezing grabs the world (engine/app/viewer/xr/world_grab.h), the right
/// thumbstick turns the user in steps, and the right controller is the probe, with contact rendered as vibration. While a controller grabs
/// the world, the probe counts as lost, so that the force ramps up again after the release. Plain data, independent of OpenXR. Frame
/// thread.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "engine/app/viewer/xr/comfort.h"
#include "engine/app/viewer/xr/world_grab.h"
#include "haptics/device/controller.h"
#include "haptics/vibration/vibration.h"

namespace catena::app {

/// State of a controller in tracking space, meters.
struct XrHand {
  bool is_tracked = false;
  Vec3 position_m{0.0};
  Quat orientation{kIdentityRotation};
  /// Select and squeeze from 0 to 1; thumbstick from -1 (left) to 1.
  double select = 0, squeeze = 0, stick_x = 0;
};

/// Turns controller states into the placement of the world, the probe pose and vibration commands.
class XrControllers {
 public:
  static constexpr std::size_t kProbeHand = 1;  ///< Index of the right controller, which is the probe.
  /// A button counts as pressed above kPressThreshold until it falls below kReleaseThreshold.
  static constexpr double kPressThreshold = 0.6, kReleaseThreshold = 0.4;

  /// Call once per frame, `dt_s` after the last one: moves the placement with the controllers.
  void update(const std::array<XrHand, 2>& hands, const Vec3& head_m, double dt_s, Placement& placement);
  bool is_grabbing_world() const { return world_grab_.is_grabbing(); }
  /// Returns the midpoint of the grabbing controllers in tracking space, meters; nothing if none grabs.
  std::optional<Vec3> grab_center(const std::array<XrHand, 2>& hands) const;
  /// Returns the strength of the vignette, 0 to 1.
  double vignette_strength() const { return vignette_strength_; }

  /// Returns the probe pose for the device, from a controller state at time `t_ns` of engine/base/clock.h.
  haptics::ControllerPose make_controller_pose(const XrHand& hand, std::int64_t t_ns);
  /// Returns the vibration command for the runtime. `focused`: whether the session has the input focus.
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
