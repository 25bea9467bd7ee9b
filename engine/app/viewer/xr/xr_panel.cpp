// SPDX-License-Identifier: MIT
#ifdef CATENA_XR

#include "engine/app/viewer/xr/xr_panel.h"

#include <utility>

#include "engine/app/viewer/xr/xr_controllers.h"

namespace catena::app {

void XrPanel::update(const std::array<render::xr::ControllerState, render::xr::kControllers>& hands, const render::xr::XrHeadPose& head,
                     DeviceRegistration& desk) {
  const bool menu = hands[0].menu || hands[1].menu, pressed = menu && !menu_pressed_;
  // instructions appear in front of the user; the button postpones the registration, and the trigger marks a touch
  const bool began = desk.is_active() && !is_registering_;
  if (pressed && is_registering_) desk.cancel();
  is_registering_ = desk.is_active();
  if (pressed || began) {
    is_open_ = began || !is_open_;
    panel_ = xr_interaction::place_in_front(head.position, head.orientation, kDistanceM, kBelowEyesM, panel_);
    pointer_ = {};
  }
  menu_pressed_ = menu;
  mouse_ = {};
  const render::xr::ControllerState& hand = hands[XrControllers::kProbeHand];
  if (!is_open_ || !quad_ || !hand.has_aim || is_registering_) return;
  mouse_ =
      pointer_.step(panel_, xr_interaction::aim_ray(hand.aim.position, hand.aim.orientation), hand.select > XrControllers::kPressThreshold);
  was_pressed_ = was_pressed_ || mouse_.pressed;
}

Outcome XrPanel::show(render::xr::Headset& headset, Presenter& screen) {
  render::vk::Image* const window = is_open_ ? screen.renderer().window_image() : nullptr;
  const VkExtent3D size = window ? window->info().extent : VkExtent3D{};
  if (!window || !quad_ || panel_.width_px != size.width || panel_.height_px != size.height) {
    headset.show_panel(nullptr);
    quad_.reset();
    if (!window) return Done{};
    panel_.width_px = size.width;
    panel_.height_px = size.height;
    panel_.height_m = kWidthM * size.height / size.width;
    CATENA_TRY(quad_, render::xr::QuadLayer::create(headset.session(), {size.width, size.height}));
  }
  CATENA_CHECK(quad_->submit_image(*window));
  quad_->set_quad({{panel_.center_m, panel_.orientation}, panel_.width_m, panel_.height_m, true});
  headset.show_panel(quad_.get());
  return Done{};
}

std::optional<XrPanel::Mouse> XrPanel::take_mouse() {
  const bool pressed = std::exchange(was_pressed_, false);
  if (!mouse_.has_pointer) return std::nullopt;
  Mouse mouse = mouse_;
  mouse.pressed = mouse.pressed || pressed;
  return mouse;
}

}  // namespace catena::app

#endif
