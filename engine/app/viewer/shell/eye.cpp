#include "engine/app/viewer/shell/eye.h"

#include <algorithm>
#include <utility>

#include "engine/base/clock.h"

namespace catena::app {

namespace {
constexpr double kLongestStepS = 0.1;  // a slow picture is no leap
}

scene::Camera camera_of(const render::View& v) { return {v.position, v.target, v.up, v.fovy_deg, v.orthographic, v.height, true}; }

void Eye::look_at(const LoadedScene& loaded) {
  Controls& controls = shared_.controls;
  controls.hand = shared_.hand.first_probe();
  controls.view = controls.home = saved_ = loaded.packet.view;
  controls.bounds = loaded.bounds;
  flight_ = {};
  pin();
}

void Eye::pin() { shared_.scene.scene().camera = camera_of(shared_.controls.view); }

bool Eye::act(Action action) {
  Controls& controls = shared_.controls;
  if (takes_hold(action)) controls.turntable = false;
  if (action == Action::turntable) controls.turntable = !controls.turntable;
  if (action == Action::fly) controls.fly = !controls.fly;
  if (!apply(controls, action, shared_.state.area.width / shared_.state.area.height)) return false;
  pin();
  return true;
}

bool Eye::move(const FlyKeys& keys) {
  const std::int64_t now = now_ns(), before = std::exchange(last_move_ns_, now);
  const double dt_s = before == 0 ? 0 : std::min(kLongestStepS, 1e-9 * static_cast<double>(now - before));
  Controls& controls = shared_.controls;
  if (!controls.fly) flight_ = {};
  bool moved = false;
  if (controls.turntable) {
    turn_table(controls.view, dt_s);
    moved = true;
  }
  const double size = controls.bounds.empty() ? 1 : controls.bounds.diagonal();
  const bool glides = norm(flight_.velocity) > 0 || flight_.zoom_rate != 0;
  if (keys.any() || glides) {
    fly(controls.view, flight_, keys, size, controls.fly_speed, dt_s);
    if (!keys.any() && flight_.rests(size)) flight_ = {};
    moved = true;
  }
  if (moved) pin();
  return moved;
}

bool Eye::is_moved() const {
  const render::View &a = shared_.controls.view, &b = saved_;
  return a.position != b.position || a.target != b.target || a.up != b.up || a.fovy_deg != b.fovy_deg || a.orthographic != b.orthographic ||
         (a.orthographic && a.height != b.height);
}

}  // namespace catena::app
