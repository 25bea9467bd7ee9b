// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/camera_controller.h"

#include <algorithm>
#include <utility>

#include "engine/app/viewer/input/commands.h"
#include "engine/base/clock.h"

namespace catena::app {

namespace {
constexpr double kLongestStepS = 0.1;  // maximum time step: a slow frame causes no jump
}

scene::Camera to_scene_camera(const render::View& v) { return {v.position, v.target, v.up, v.fovy_deg, v.orthographic, v.height, true}; }

void CameraController::adopt_scene(const LoadedScene& loaded) {
  navigation_.probe = haptic_session_.initial_probe();
  navigation_.view = navigation_.home = saved_view_ = loaded.packet.view;
  navigation_.bounds = loaded.bounds.scaled(loaded.packet.view.stretch);
  saved_planes_ = scene_.scene().orthogonal_views;
  const bool was_on = navigation_.ortho.is_on;
  navigation_.ortho = {saved_planes_.value_or(scene::OrthogonalViews{}), was_on || saved_planes_};
  flight_ = {};
  pin_camera();
}

void CameraController::pin_camera() { scene_.scene().camera = to_scene_camera(navigation_.view); }

bool CameraController::handle(Action action, double aspect) {
  if (stops_turntable(action)) navigation_.turntable = false;
  if (action == Action::toggle_turntable) navigation_.turntable = !navigation_.turntable;
  if (action == Action::toggle_fly) navigation_.fly = !navigation_.fly;
  if (!apply(navigation_, action, aspect)) return false;
  pin_camera();
  return true;
}

bool CameraController::update(const FlyKeys& keys) {
  const std::int64_t now = now_ns(), before = std::exchange(last_update_ns_, now);
  const double dt_s = before == 0 ? 0 : std::min(kLongestStepS, 1e-9 * static_cast<double>(now - before));
  if (!navigation_.fly) flight_ = {};
  bool moved = false;
  if (navigation_.turntable) {
    advance_turntable(navigation_.view, dt_s);
    moved = true;
  }
  const double size = navigation_.bounds.empty() ? 1 : navigation_.bounds.diagonal();
  const bool glides = norm(flight_.velocity) > 0 || flight_.zoom_rate != 0;
  if (keys.any() || glides) {
    fly(navigation_.view, flight_, keys, size, navigation_.fly_speed, dt_s);
    if (!keys.any() && flight_.is_at_rest(size)) flight_ = {};
    moved = true;
  }
  if (moved) pin_camera();
  return moved;
}

bool CameraController::has_unsaved_view() const {
  const render::View &a = navigation_.view, &b = saved_view_;
  return a.position != b.position || a.target != b.target || a.up != b.up || a.fovy_deg != b.fovy_deg || a.orthographic != b.orthographic ||
         (a.orthographic && a.height != b.height);
}

std::optional<scene::OrthogonalViews> CameraController::shown_planes() const {
  return navigation_.ortho.is_on ? std::optional<scene::OrthogonalViews>(navigation_.ortho) : std::nullopt;
}

void CameraController::mark_saved() {
  saved_view_ = navigation_.view;
  saved_planes_ = shown_planes();
}

}  // namespace catena::app
