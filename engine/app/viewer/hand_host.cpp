#include "engine/app/viewer/hand_host.h"

#include <fmt/format.h>

#include <cstdio>

#include "engine/app/hand/hand_setup.h"
#include "engine/scene/systems.h"
#include "haptics/extract/extract.h"

namespace catena::app {

namespace {

std::vector<std::string> names_of(const haptics::Program& program) {
  std::vector<std::string> names;
  for (const haptics::Link& link : program.links) names.push_back(link.name);
  return names;
}

/// Whether a picture of `now` would differ from one of `before`.
bool looks_different(const exchange::HapticState& before, const exchange::HapticState& now) {
  if (before.tick == 0 || before.probe != now.probe || before.force_n != now.force_n) return true;
  for (int i = 0; i < now.link_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (before.links[k].proxy != now.links[k].proxy || before.links[k].active != now.links[k].active ||
        before.links[k].status != now.links[k].status)
      return true;
  }
  for (int i = 0; i < now.widget_count; ++i) {
    const exchange::WidgetReport &a = before.widgets[static_cast<std::size_t>(i)], &b = now.widgets[static_cast<std::size_t>(i)];
    if (!(a.pose == b.pose) || a.mode != b.mode || a.handle != b.handle || a.held != b.held) return true;
  }
  return false;
}

}  // namespace

HandHost::~HandHost() { stop(); }

Outcome HandHost::load(scene::Scene& scene) {
  CATENA_CHECK(haptics::extract_program(scene));
  return Done{};
}

Outcome HandHost::open_device(const scene::Scene& scene) {
  if (options_.device == "mouse") return Done{};
  CATENA_TRY(hand_, open_hand(scene, options_.device, {}, options_.firmware));
  return Done{};
}

Outcome HandHost::prepare(scene::Scene& scene, const render::Bounds& bounds) {
  const bool is_mouse = !hand_.device;
  if (is_mouse) hand_.device = std::make_unique<haptics::MouseDevice>(Vec3(0.0));
  CATENA_TRY(program_, program_for(scene, hand_, bounds));
  first_probe_ = app::first_probe(scene, bounds);
  if (is_mouse) {
    auto mouse = std::make_unique<haptics::MouseDevice>(device_from_world(scene.workspace, first_probe_));
    mouse_ = mouse.get();
    hand_.device = std::move(mouse);
  }
  link_names_ = names_of(*program_);
  scene.world.get<scene::Cursor>(scene.cursor).names = link_names_;
  CATENA_TRY(recording_, Recording::open(options_.record, scene, options_.fields, hand_, *program_));
  haptics::ServoOptions servo;
  servo.rate_hz = hand_.settings.rate_hz;
  servo.forces = is_mouse || hand_.device->capabilities().max_force_n <= 0;
  servo.realtime = options_.realtime;
  if (is_mouse) servo.realtime.lock_memory = false;  // nothing pushes: a page fault does no harm
  servo.sink = recording_.sink();
  servo_ = std::make_unique<haptics::Servo>(*hand_.device, program_, servo);
  return Done{};
}

Outcome HandHost::take_over(scene::Scene& scene, const render::Bounds& bounds) {
  CATENA_TRY(program_, program_for(scene, hand_, bounds));
  first_probe_ = app::first_probe(scene, bounds);
  link_names_ = names_of(*program_);
  scene.world.get<scene::Cursor>(scene.cursor).names = link_names_;
  servo_->set_program(program_);
  move_mouse(scene, first_probe_, 0);
  return Done{};
}

void HandHost::start() {
  if (!is_mouse()) crash_guard_.emplace(*hand_.device);
  servo_->start();
  if (is_mouse()) return;
  if (!hand_.note.empty()) fmt::print(stderr, "catena: {}\n", hand_.note);
  for (const std::string& note : servo_->report().realtime.notes) fmt::print(stderr, "catena: {}\n", note);
  say_forces();
}

void HandHost::stop() {
  if (servo_) servo_->stop();
}

Outcome HandHost::finish(const std::string& servo_stats) {
  stop();
  CATENA_CHECK(recording_.finish());
  return write_servo_stats(servo_stats, *servo_, *hand_.device);
}

Outcome HandHost::publish(scene::Scene& scene) {
  CATENA_TRY(program_, haptics::extract_program(scene, hand_.limits));
  link_names_ = names_of(*program_);
  scene.world.get<scene::Cursor>(scene.cursor).names = link_names_;
  servo_->set_program(program_);
  return Done{};
}

bool HandHost::take(scene::Scene& scene) {
  const exchange::HapticState before = felt_;
  if (!servo_->take(felt_)) return false;
  // a state of an older program speaks of other links
  if (felt_.program_epoch != program_->epoch) return false;
  scene::update_cursor(scene, felt_);
  scene.world.get<scene::Cursor>(scene.cursor).pseudo_haptic = hand_.device->capabilities().max_force_n <= 0;
  scene::update_widgets(scene, felt_);
  return looks_different(before, felt_);
}

void HandHost::move_mouse(const scene::Scene& scene, const Vec3& world, std::uint32_t buttons) {
  if (mouse_ != nullptr) mouse_->move_to(device_from_world(scene.workspace, world), buttons);
}

void HandHost::set_forces(bool on) {
  if (is_mouse()) return;
  servo_->set_forces(on);
  say_forces();
}

void HandHost::say_forces() const {
  fmt::print("{}: forces {} (F turns them {})\n", hand_.device->capabilities().name, servo_->forces() ? "on" : "off",
             servo_->forces() ? "off" : "on");
  std::fflush(stdout);
}

}  // namespace catena::app
