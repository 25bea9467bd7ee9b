#include "engine/app/viewer/shell/tracked_head.h"

#include <fmt/format.h>

#include "engine/app/render/options.h"
#include "haptics/device/registry.h"
#include "render/stereo/eyes.h"

namespace catena::app {
namespace {

Outcome before_screen(const scene::DisplayScreen& screen, const Vec3& head) {
  CATENA_CHECK(render::screen_view({screen.lower_left, screen.lower_right, screen.upper_left}, head));
  return Done{};
}

double diagonal(const scene::DisplayScreen& screen) { return norm(screen.lower_right - screen.upper_left); }

}  // namespace

std::optional<Vec3> ShownHead::step(double t_s, const std::optional<Vec3>& tracked) {
  const double dt_s = std::clamp(t_s - last_s_, 0.0, kLongest_s);
  last_s_ = t_s;
  const bool was_lost = std::exchange(lost_, !tracked || !is_finite(*tracked) || !before_screen(screen_, *tracked));
  if (lost_) return shown_;
  const bool leaps = tracked_ && norm(*tracked - *tracked_) > (kLeap + kFast_per_s * dt_s) * diagonal(screen_);
  if (shown_ && (leaps || was_lost)) {
    offset_ = *shown_ - *tracked;
    glide_from_s_ = t_s;
  }
  tracked_ = tracked;
  const double u = (t_s - glide_from_s_) / kGlide_s;
  shown_ = *tracked;
  if (u >= 0 && u < 1) {
    const Vec3 between = *tracked + (1 - u * u * (3 - 2 * u)) * offset_;
    if (before_screen(screen_, between)) shown_ = between;
  }
  return shown_;
}

Result<std::unique_ptr<TrackedHead>> TrackedHead::open(const std::string& words, const scene::Scene& scene) {
  if (!scene.stereo.through) return Error{"--head " + words + ": expected --screen, before which the head is"};
  const scene::DisplayScreen& screen = scene.stereo.screens[*scene.stereo.through];
  std::unique_ptr<TrackedHead> self(new TrackedHead(screen));
  const std::string type = haptics::device_type_of(words);
  if (type != "recorded" && haptics::is_device_type(type)) {
    if (!scene.workspace.given)
      return Error{"--head " + words + ": where a device's metres are in the world is not said; the scene's \"workspace\" was expected"};
    CATENA_TRY(self->device_, open_hand(scene, words));
    auto program = std::make_shared<haptics::Program>();
    program->metres_per_unit = scene.workspace.metres_per_unit;
    program->workspace_origin = scene.workspace.origin;
    program->workspace_rotation = scene.workspace.rotation;
    haptics::ServoOptions options;
    options.rate_hz = self->device_.settings.rate_hz;
    options.forces = false;
    options.watchdog_s = 0;  // it never pushes
    options.realtime = {.fifo = false, .lock_memory = false, .cpu = haptics::RealtimeOptions::kUnbound};
    self->servo_ = std::make_unique<haptics::Servo>(*self->device_.device, std::move(program), options);
    return self;
  }
  CATENA_TRY(self->path_, read_head_path(type == "recorded" ? words.substr(words.find(':') + 1) : words));
  if (const Outcome seen = before_screen(screen, *self->tracked(0)); !seen)
    return Error{fmt::format("--head {}: its first place: screen \"{}\": {}", words, screen.name, seen.error().message)};
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

std::optional<Vec3> TrackedHead::tracked(double t_s) {
  if (path_) return path_->at({}, path_->start_s() + (t_s - start_s_)).position;
  servo_->take(state_);
  if (state_.tick == 0 || state_.condition == exchange::Condition::no_device) return std::nullopt;
  return state_.probe;
}

bool TrackedHead::was_lost() {
  const bool told = std::exchange(told_, shown_.lost());
  return told_ && !told;
}

}  // namespace catena::app
