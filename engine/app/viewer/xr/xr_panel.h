/// The window as a panel before the person, brought and sent away by the menu button, and the controller as a mouse on it. What the desk's
/// device asks of the person brings it, too. It is there with a session: drop() before the session stops. Frame thread.
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "engine/app/viewer/window/presenter.h"
#include "engine/app/viewer/xr/device_registration.h"
#include "engine/app/viewer/xr/panel.h"
#include "render/xr/headset.h"

namespace catena::app {

class XrPanel {
 public:
  using Mouse = xr_interaction::PanelPointer::Mouse;

  /// Each frame, with the hands at its time.
  void update(const std::array<render::xr::ControllerState, render::xr::kControllers>& hands, const render::xr::XrHeadPose& head,
              DeviceRegistration& desk);
  /// After the window was shown: as it is now, on the panel, in the headset's next pictures.
  Outcome show(render::xr::Headset& headset, Presenter& screen);
  void release() { quad_.reset(); }

  /// The controller means the panel, and not the data behind it.
  bool captures_pointer() const { return mouse_.has_pointer; }
  /// Since the last call, pixels of the window; nothing while the controller points elsewhere.
  std::optional<Mouse> take_mouse();

 private:
  static constexpr double kWidthM = 0.8, kDistanceM = 0.9, kBelowEyesM = 0.1;  // from the head, and below the eyes

  bool is_open_ = false, menu_pressed_ = false;
  bool is_registering_ = false;  ///< the desk's three places, in the last picture
  xr_interaction::Panel panel_{.width_m = kWidthM};
  xr_interaction::PanelPointer pointer_;
  Mouse mouse_;
  bool was_pressed_ = false;  ///< the last call of mouse()
  std::unique_ptr<render::xr::QuadLayer> quad_;
};

}  // namespace catena::app
