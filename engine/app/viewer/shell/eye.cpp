#include "engine/app/viewer/shell/eye.h"

#include <algorithm>
#include <utility>

#include "engine/app/viewer/shell/commands.h"
#include "engine/base/clock.h"

namespace catena::app {

namespace {
constexpr double kLongestStepS = 0.1;  // a slow picture is no leap
}

scene::Camera camera_of(const render::View& v) { return {v.position, v.target, v.up, v.fovy_deg, v.orthographic, v.height, true}; }

void Eye::look_at(const LoadedScene& loaded) {
  controls_.hand = hand_.first_probe();
  controls_.view = controls_.home = saved_ = loaded.packet.view;
  controls_.bounds = loaded.bounds;
  flight_ = {};
  pin();
}

void Eye::pin() { scene_.scene().camera = camera_of(controls_.view); }

bool Eye::act(Action action, double aspect) {
  if (takes_hold(action)) controls_.turntable = false;
  if (action == Action::turntable) controls_.turntable = !controls_.turntable;
  if (action == Action::fly) controls_.fly = !controls_.fly;
  if (!apply(controls_, action, aspect)) return false;
  pin();
  return true;
}

bool Eye::move(const FlyKeys& keys) {
  const std::int64_t now = now_ns(), before = std::exchange(last_move_ns_, now);
  const double dt_s = before == 0 ? 0 : std::min(kLongestStepS, 1e-9 * static_cast<double>(now - before));
  if (!controls_.fly) flight_ = {};
  bool moved = false;
  if (controls_.turntable) {
    turn_table(controls_.view, dt_s);
    moved = true;
  }
  const double size = controls_.bounds.empty() ? 1 : controls_.bounds.diagonal();
  const bool glides = norm(flight_.velocity) > 0 || flight_.zoom_rate != 0;
  if (keys.any() || glides) {
    fly(controls_.view, flight_, keys, size, controls_.fly_speed, dt_s);
    if (!keys.any() && flight_.rests(size)) flight_ = {};
    moved = true;
  }
  if (moved) pin();
  return moved;
}

bool Eye::is_moved() const {
  const render::View &a = controls_.view, &b = saved_;
  return a.position != b.position || a.target != b.target || a.up != b.up || a.fovy_deg != b.fovy_deg || a.orthographic != b.orthographic ||
         (a.orthographic && a.height != b.height);
}

}  // namespace catena::app
