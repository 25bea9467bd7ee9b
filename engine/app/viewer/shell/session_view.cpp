// Where the picture lies, how the eye moves by itself, what is under the pointer.
#include <algorithm>

#include "engine/app/viewer/shell/pick.h"
#include "engine/app/viewer/shell/session.h"
#include "engine/base/clock.h"
#include "engine/scene/units.h"

namespace catena::app {

namespace {
constexpr double kLongestStepS = 0.1;  // of the camera by itself: a slow picture is no leap
}

/// The picture's place in the window; true where it has changed.
bool Session::lay_out() {
  double width = 1, height = 1;
  std::uint32_t frame_width = 0, frame_height = 0;
  window_->size(width, height);
  screen_->size(frame_width, frame_height);
  state_.area = picture_area(width, height, state_.panels ? interface_edges() : Edges{});
  const auto before = pixels_;
  if (frame_width > 0 && frame_height > 0) pixels_ = pixels_of(state_.area, width, height, frame_width, frame_height);
  return pixels_ != before;
}

/// What the menu and the keys have switched.
void Session::obey_view() {
  if (window_->is_full_screen() != state_.full_screen) {
    window_->set_full_screen(state_.full_screen);
    state_.full_screen = window_->is_full_screen();
  }
  controls_.fly = state_.fly;
  if (!state_.fly) flight_ = {};
}

/// Flight and turntable, by the time since the last picture. True: the view has changed.
bool Session::move_camera() {
  const std::int64_t now = now_ns();
  const double dt_s = std::min(kLongestStepS, 1e-9 * static_cast<double>(now - std::exchange(last_move_ns_, now)));
  bool moved = false;
  if (state_.turntable) {
    turn_table(controls_.view, dt_s);
    moved = true;
  }
  const double size = controls_.bounds.empty() ? 1 : controls_.bounds.diagonal();
  const FlyKeys keys = state_.fly && !gui_->wants_keys() ? window_->held_keys() : FlyKeys{};
  if (keys.any() || is_gliding()) {
    fly(controls_.view, flight_, keys, size, controls_.fly_speed, dt_s);
    if (!keys.any() && flight_.rests(size)) flight_ = {};
    moved = true;
  }
  if (moved) pin_camera();
  return moved;
}

bool Session::is_gliding() const { return norm(flight_.velocity) > 0 || flight_.zoom_rate != 0; }

/// Whoever takes hold of the view ends the turntable.
void Session::stop_turning(const Input& input) {
  if (!state_.turntable) return;
  if (input.left || input.middle || input.wheel != 0 || input.axis || input.fit || input.reset_view) state_.turntable = false;
}

/// The rows of the table of values. The place under the pointer is looked up while nothing moves.
void Session::update_values() {
  const scene::Scene& scene = scene_->scene();
  state_.unit_length = scene::unit_length(scene);
  const auto at = [&](const std::optional<Vec3>& world, std::string object) {
    PlaceValues place{world, std::move(object), {}};
    if (world) place.fields = values_at(scene, *world);
    return place;
  };
  const exchange::HapticState& felt = hand_.felt();
  const bool feels = felt.tick > 0;
  state_.probe = at(feels ? std::optional(felt.probe) : std::nullopt, {});
  std::optional<Vec3> proxy;
  if (feels && felt.link_count > 0) proxy = felt.links[static_cast<std::size_t>(felt.link_count - 1)].proxy;
  state_.proxy = at(proxy, feels && felt.link_count > 0 && !hand_.link_names().empty() ? hand_.link_names().back() : "");
  const double most = scene.coupling.max_force_n;
  state_.force_share = most > 0 ? std::clamp(norm(felt.force_n) / most, 0.0, 1.0) : 0;

  const bool can = state_.pointer_on_picture && !state_.pointer_pressed && shown_ && shown_->eyes.empty() && !state_.untitled;
  if (!can) {
    state_.pointer = {};
    picked_stale_ = true;
    return;
  }
  if (!std::exchange(picked_stale_, false)) return;
  const double x = (state_.pointer_x - state_.area.x) / state_.area.width * shown_->width;
  const double y = (state_.pointer_y - state_.area.y) / state_.area.height * shown_->height;
  state_.pointer = {};
  const auto texel = screen_->pick(x, y);
  if (!texel) return;
  if (const auto place = pick(*shown_, x, y, texel->depth, texel->id)) state_.pointer = at(place->world, object_words(*shown_, place->id));
}

}  // namespace catena::app
