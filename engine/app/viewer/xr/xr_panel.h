// SPDX-License-Identifier: MIT
/// XR panel: the window shown in front of the user, toggled by the menu button, with the controller as a mouse on it. The prompts of a
/// device registration open it, too. It uses the headset's session: call release() before that ends. Frame thread.
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "engine/app/viewer/window/presenter.h"
#include "engine/app/viewer/xr/device_registration.h"
#include "engine/app/viewer/xr/panel.h"
#include "render/xr/headset.h"

namespace catena::app {

/// Owns the panel's quad layer, its placement and its pointer.
class XrPanel {
 public:
  using Mouse = xr_interaction::PanelPointer::Mouse;

  /// Call once per frame with the controllers and head at its display time. Starting a registration in `desk` opens the panel; the menu
  /// button cancels it.
  void update(const std::array<render::xr::ControllerState, render::xr::kControllers>& hands, const render::xr::XrHeadPose& head,
              DeviceRegistration& desk);
  /// Copies the window to the panel for the headset's next frames. Call after the window was shown. An Error if the headset fails.
  Outcome show(render::xr::Headset& headset, Presenter& screen);
  /// Releases the quad layer.
  void release() { quad_.reset(); }

  /// Returns whether the controller acts on the panel and not on the data behind it.
  bool captures_pointer() const { return mouse_.has_pointer; }
  /// Returns the mouse since the last call, pixels of the window; nothing while the controller points elsewhere.
  std::optional<Mouse> take_mouse();

 private:
  /// Width of the panel; its distance from the head and below the eyes, meters.
  static constexpr double kWidthM = 0.8, kDistanceM = 0.9, kBelowEyesM = 0.1;

  bool is_open_ = false, menu_pressed_ = false;
  bool is_registering_ = false;  ///< Whether a registration was active in the last frame.
  xr_interaction::Panel panel_{.width_m = kWidthM};
  xr_interaction::PanelPointer pointer_;
  Mouse mouse_;
  bool was_pressed_ = false;  ///< Whether the button was pressed since the last take_mouse().
  std::unique_ptr<render::xr::QuadLayer> quad_;
};

}  // namespace catena::app
