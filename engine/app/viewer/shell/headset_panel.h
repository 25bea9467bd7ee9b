/// The window as a panel before the person, brought and sent away by the menu button, and the controller as a mouse on it. What the desk's
/// device asks of the person brings it, too. It is there with a session: drop() before the session stops. Frame thread.
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "engine/app/viewer/shell/desk_device.h"
#include "engine/app/viewer/shell/screen.h"
#include "engine/immersive/panel.h"
#include "render/xr/headset.h"

namespace catena::app {

class HeadsetPanel {
 public:
  using Mouse = immersive::PanelPointer::Mouse;

  /// Each frame, with the hands at its time.
  void take(const std::array<render::xr::HandState, render::xr::kHands>& hands, const render::xr::RoomHead& head, DeskDevice& desk);
  /// After the window was shown: as it is now, on the panel, in the headset's next pictures.
  Outcome show(render::xr::Headset& headset, Screen& screen);
  void drop() { quad_.reset(); }

  /// The controller means the panel, and not the data behind it.
  bool has_controller() const { return mouse_.here; }
  /// Since the last call, pixels of the window; nothing while the controller points elsewhere.
  std::optional<Mouse> mouse();

 private:
  static constexpr double kWidthM = 0.8, kAwayM = 0.9, kDropM = 0.1;  // from the head, and below the eyes

  bool open_ = false, menu_down_ = false;
  bool asks_ = false;  ///< the desk's three places, in the last picture
  immersive::Panel panel_{.width_m = kWidthM};
  immersive::PanelPointer pointer_;
  Mouse mouse_;
  bool pressed_since_ = false;  ///< the last call of mouse()
  std::unique_ptr<render::xr::QuadLayer> quad_;
};

}  // namespace catena::app
