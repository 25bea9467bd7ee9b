// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/tracked_head.h"

#include <fmt/format.h>

#include "engine/app/render/render_options.h"
#include "haptics/device/registry.h"
#include "render/stereo/stereo_views.h"

namespace catena::app {
namespace {

Outcome before_screen(const scene::DisplayScreen& screen, const Vec3& head) {
  CATENA_CHECK(render::make_screen_view({screen.lower_left, screen.lower_right, screen.upper_left}, head));
  return Done{};
}

double diagonal(const scene::DisplayScreen& screen) { return norm(screen.lower_right - screen.upper_left); }

}  // namespace

std::optional<Vec3> SmoothedHead::update(double t_s, const std::optional<Vec3>& tracked) {
  const double dt_s = std::clamp(t_s - last_s_, 0.0, kMaxStepS);
  last_s_ = t_s;
  const bool was_lost = std::exchange(is_lost_, !tracked || !is_finite(*tracked) || !before_screen(screen_, *tracked));
  if (is_lost_) return smoothed_;
  const bool leaps = tracked_ && norm(*tracked - *tracked_) > (kJumpDiagonals + kMaxDiagonalsPerS * dt_s) * diagonal(screen_);
  if (smoothed_ && (leaps || was_lost)) {
    glide_offset_ = *smoothed_ - *tracked;
    glide_start_s_ = t_s;
  }
  tracked_ = tracked;
  const double u = (t_s - glide_start_s_) / kGlideS;
  smoothed_ = *tracked;
  if (u >= 0 && u < 1) {
    const Vec3 between = *tracked + (1 - u * u * (3 - 2 * u)) * glide_offset_;
    if (before_screen(screen_, between)) smoothed_ = between;
  }
  return smoothed_;
}

Result<std::unique_ptr<TrackedHead>> TrackedHead::open(const std::string& words, const scene::Scene& scene) {
  if (!scene.stereo.screen_index) return Error{"--head " + words + ": a display screen was expected (--screen)"};
  const scene::DisplayScreen& screen = scene.stereo.screens[*scene.stereo.screen_index];
  std::unique_ptr<TrackedHead> self(new TrackedHead(screen));
  const std::string type = haptics::parse_device_type(words);
  if (type != "recorded" && haptics::is_device_type(type)) {
    if (!scene.workspace.is_explicit)
      return Error{"--head " + words + ": device metres are not mapped to the world; the scene's \"workspace\" was expected"};
    CATENA_TRY(self->device_, open_haptic_device(scene, words));
    auto program = std::make_shared<haptics::HapticProgram>();
    program->meters_per_unit = scene.workspace.meters_per_unit;
    program->workspace_origin = scene.workspace.origin;
    program->workspace_rotation = scene.workspace.rotation;
    haptics::ServoOptions options;
    options.rate_hz = self->device_.settings.rate_hz;
    options.forces_enabled = false;
    options.watchdog_s = 0;  // a head tracker exerts no force
    options.realtime = {.fifo = false, .lock_memory = false, .cpu = haptics::RealtimeOptions::kUnbound};
    self->servo_ = std::make_unique<haptics::Servo>(*self->device_.device, std::move(program), options);
    return self;
  }
  CATENA_TRY(self->path_, read_head_path(type == "recorded" ? words.substr(words.find(':') + 1) : words));
  if (const Outcome seen = before_screen(screen, *self->tracked_position(0)); !seen)
    return Error{fmt::format("--head {}: first position: screen \"{}\": {}", words, screen.name, seen.error().message)};
  return self;
}

TrackedHead::~TrackedHead() {
  if (servo_) servo_->stop();
}

Outcome TrackedHead::start(double t_s) {
  start_s_ = t_s;
  if (servo_) CATENA_CHECK(servo_->start());
  return Done{};
}

std::optional<Vec3> TrackedHead::tracked_position(double t_s) {
  if (path_) return path_->at({}, path_->start_s() + (t_s - start_s_)).position;
  servo_->receive(state_);
  if (state_.tick == 0 || state_.condition == TickCondition::no_device) return std::nullopt;
  return state_.probe;
}

bool TrackedHead::take_lost() {
  const bool was_reported = std::exchange(loss_reported_, smoothed_.is_lost());
  return loss_reported_ && !was_reported;
}

}  // namespace catena::app
