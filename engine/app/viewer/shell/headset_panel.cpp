#ifdef CATENA_XR

#include "engine/app/viewer/shell/headset_panel.h"

#include <utility>

#include "engine/app/viewer/shell/headset_hands.h"

namespace catena::app {

void HeadsetPanel::take(const std::array<render::xr::HandState, render::xr::kHands>& hands, const render::xr::RoomHead& head,
                        DeskDevice& desk) {
  const bool menu = hands[0].menu || hands[1].menu, pressed = menu && !menu_down_;
  // what is asked of the person stands before them; the button puts it off, and the trigger means the touch
  const bool began = desk.touching() && !asks_;
  if (pressed && asks_) desk.cancel();
  asks_ = desk.touching();
  if (pressed || began) {
    open_ = began || !open_;
    panel_ = immersive::in_front_of(head.position, head.turn, kAwayM, kDropM, panel_);
    pointer_ = {};
  }
  menu_down_ = menu;
  mouse_ = {};
  const render::xr::HandState& hand = hands[HeadsetHands::kProbe];
  if (!open_ || !quad_ || !hand.points || asks_) return;
  mouse_ = pointer_.step(panel_, immersive::aim_ray(hand.aim.position, hand.aim.turn), hand.select > HeadsetHands::kDown);
  pressed_since_ = pressed_since_ || mouse_.pressed;
}

Outcome HeadsetPanel::show(render::xr::Headset& headset, Screen& screen) {
  render::vk::Image* const window = open_ ? screen.renderer().window_image() : nullptr;
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
  CATENA_CHECK(quad_->take(*window));
  quad_->place({{panel_.middle_m, panel_.orientation}, panel_.width_m, panel_.height_m, true});
  headset.show_panel(quad_.get());
  return Done{};
}

std::optional<HeadsetPanel::Mouse> HeadsetPanel::mouse() {
  const bool pressed = std::exchange(pressed_since_, false);
  if (!mouse_.here) return std::nullopt;
  Mouse mouse = mouse_;
  mouse.pressed = mouse.pressed || pressed;
  return mouse;
}

}  // namespace catena::app

#endif
