// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/haptic_session.h"

#include <fmt/format.h>
#include <unistd.h>

#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/app/viewer/input/navigation.h"
#include "engine/base/console.h"
#include "engine/base/text.h"
#include "engine/scene/prepare.h"
#include "haptics/build/build_program.h"
#include "haptics/servo/device_limits.h"
#include "haptics/servo/servo_tick.h"

namespace catena::app {

namespace {

constexpr const char* kController = "controller";

std::vector<std::string> names_of(const haptics::HapticProgram& program) {
  std::vector<std::string> names;
  for (const haptics::Link& link : program.links) names.push_back(link.name);
  return names;
}

/// The last proxy that is held away from the probe; std::nullopt if there is none.
std::optional<Vec3> held_place(const HapticState& haptic_state) {
  std::optional<Vec3> place;
  for (int i = 0; i < haptic_state.link_count; ++i) {
    const LinkReport& link = haptic_state.links[static_cast<std::size_t>(i)];
    if (link.active && link.gap > 0) place = link.proxy;
  }
  return place;
}

/// Returns whether a frame of `now` would differ from a frame of `before`.
bool looks_different(const HapticState& before, const HapticState& now) {
  if (before.tick == 0 || before.probe != now.probe || before.force_n != now.force_n) return true;
  for (int i = 0; i < now.link_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (before.links[k].proxy != now.links[k].proxy || before.links[k].active != now.links[k].active ||
        before.links[k].status != now.links[k].status)
      return true;
  }
  for (int i = 0; i < now.widget_count; ++i) {
    const WidgetReport &a = before.widgets[static_cast<std::size_t>(i)], &b = now.widgets[static_cast<std::size_t>(i)];
    if (!(a.pose == b.pose) || a.mode != b.mode || a.handle != b.handle || a.active_planes != b.active_planes) return true;
  }
  return false;
}

}  // namespace

HapticSession::~HapticSession() { stop(); }

Outcome HapticSession::load(scene::Scene& scene) {
  CATENA_CHECK(haptics::build_program(scene));
  return Done{};
}

Result<HapticDeviceSetup> HapticSession::open(const scene::Scene& scene, const std::string& name) const {
  if (name == kController && options_.use_xr_controller) {
    HapticDeviceSetup hand;
    hand.settings.type = kController;
    haptics::ControllerParameters parameters;
    parameters.rate_hz = hand.settings.rate_hz;
    hand.device = std::make_unique<haptics::TrackedController>(parameters);
    hand.limits = haptics::compute_device_limits(hand.device->capabilities(), hand.settings);
    return hand;
  }
  if (name != "mouse") return open_haptic_device(scene, name, {}, options_.firmware);
  HapticDeviceSetup mouse;
  mouse.device = std::make_unique<haptics::MouseDevice>(Vec3(0.0));
  return mouse;
}

Outcome HapticSession::open_device(const scene::Scene& scene) {
  std::string name = options_.device;
  if (name.empty() && scene.device) {
    CATENA_TRY(const haptics::DeviceSettings settings, haptics::read_device_settings(*scene.device, scene.path));
    // a simulated device would only keep the user from moving the probe with the mouse
    if (haptics::is_hardware(settings.type)) name = settings.type;
  }
  if (name.empty()) name = options_.use_xr_controller ? kController : "mouse";
  auto opened = open(scene, name);
  if (!opened) {
    if (!options_.fall_back_to_mouse || !haptics::is_hardware(haptics::parse_device_type(name))) return opened.error();
    const std::string why = opened.error().message;
    name = "mouse";
    opened = open(scene, name);
    opened->note = why + "; the mouse moves the probe";
  }
  device_ = std::move(*opened);
  device_name_ = name;
  return Done{};
}

void HapticSession::update_link_names(scene::Scene& scene) {
  link_names_ = names_of(*program_);
  scene.entities.get<scene::Cursor>(scene.cursor).names = link_names_;
}

/// Takes over the device. A mouse starts at the probe: it was created before the workspace was known.
void HapticSession::adopt_device(HapticDeviceSetup hand, const scene::Scene& scene, const Vec3& probe) {
  device_ = std::move(hand);
  mouse_ = nullptr;
  if (device_name_ != "mouse") return;
  auto mouse = std::make_unique<haptics::MouseDevice>(device_from_world(scene.workspace, probe));
  mouse_ = mouse.get();
  device_.device = std::move(mouse);
}

void HapticSession::make_servo() {
  haptics::ServoOptions servo;
  servo.rate_hz = device_.settings.rate_hz;
  servo.forces_enabled = options_.start_with_forces || is_mouse() || device_.device->capabilities().max_force_n <= 0;
  servo.realtime = options_.realtime;
  if (is_mouse()) servo.realtime.lock_memory = false;  // a mouse exerts no force: a page fault does no harm
  servo.sink = recording_.sink();
  forces_enabled_ = servo.forces_enabled;
  forces_suspended_ = false;
  servo_ = std::make_unique<haptics::Servo>(*device_.device, program_, servo);
}

Outcome HapticSession::prepare(scene::Scene& scene, const Bounds& bounds, const RecordedScene& text) {
  scene_workspace_ = scene.workspace;
  CATENA_TRY(program_, make_device_program(scene, device_, bounds));
  initial_probe_ = app::initial_probe_position(scene, bounds);
  adopt_device(std::move(device_), scene, initial_probe_);
  update_link_names(scene);
  CATENA_TRY(recording_, Recording::open(options_.recording_path, text, device_, *program_));
  make_servo();
  return Done{};
}

Outcome HapticSession::switch_scene(scene::Scene& scene, const Bounds& bounds) {
  const scene::Workspace stated = scene.workspace;
  CATENA_TRY(program_, make_device_program(scene, device_, bounds));
  const Outcome recorded = stop_recording();
  scene_workspace_ = stated;
  initial_probe_ = app::initial_probe_position(scene, bounds);
  update_link_names(scene);
  servo_->set_program(program_);
  move_mouse(scene, initial_probe_, 0);
  mouse_has_moved_ = false;
  return recorded;
}

Outcome HapticSession::switch_device(scene::Scene& scene, const std::string& name, const Bounds& bounds) {
  CATENA_TRY(HapticDeviceSetup hand, open(scene, name));
  const scene::Workspace fitted = scene.workspace;
  scene.workspace = scene_workspace_;
  auto program = make_device_program(scene, hand, bounds);
  if (!program) {
    scene.workspace = fitted;
    return program.error();
  }
  const Outcome recorded = stop_recording();
  servo_->stop();
  crash_guard_.reset();
  const auto before = std::move(servo_);
  const std::unique_ptr<haptics::Device> old = std::move(device_.device);
  program_ = std::move(*program);
  device_name_ = name;
  adopt_device(std::move(hand), scene, latest_state_.tick > 0 ? latest_state_.probe : initial_probe_);
  update_link_names(scene);
  make_servo();
  servo_->resume_from(*before);
  CATENA_CHECK(start());
  return recorded;
}

Outcome HapticSession::record(const std::string& path, RecordedScene scene, const WrapSink& around) {
  CATENA_CHECK(stop_recording());
  CATENA_TRY(recording_, Recording::open(path, std::move(scene), device_, *program_));
  if (servo_->set_sink(around ? around(recording_.sink()) : recording_.sink())) return Done{};
  CATENA_CHECK(stop_recording());
  return Error{path + ": the servo does not answer; nothing is recorded"};
}

Outcome HapticSession::stop_recording() {
  if (!recording_.is_recording()) return Done{};
  // a servo that does not release the sink is stopped: nothing may write to its recording from here on
  if (servo_ && !servo_->set_sink(nullptr)) {
    servo_->stop();
    CATENA_CHECK(servo_->start());
  }
  return recording_.finish();
}

Outcome HapticSession::start() {
  if (!is_mouse()) crash_guard_.emplace(*device_.device);
  CATENA_CHECK(servo_->start());
  if (!device_.note.empty()) print_message(device_.note);
  if (is_mouse()) return Done{};
  for (const std::string& note : servo_->stats().realtime.notes) print_message(note);
  report_forces();
  return Done{};
}

void HapticSession::stop() {
  if (servo_) servo_->stop();
}

Outcome HapticSession::finish(const std::string& servo_stats) {
  stop();
  CATENA_CHECK(recording_.finish());
  CATENA_CHECK(device_.device->check_output_files());
  return write_servo_stats(servo_stats, *servo_, *device_.device);
}

Outcome HapticSession::validate(scene::Scene& scene) const {
  CATENA_CHECK(haptics::build_program(scene, device_.limits));
  return Done{};
}

Outcome HapticSession::publish(scene::Scene& scene, const std::string& text) {
  CATENA_TRY(program_, haptics::build_program(scene, device_.limits));
  update_link_names(scene);
  recording_.add_program(*program_, text);
  servo_->set_program(program_);
  return Done{};
}

bool HapticSession::pull_state(scene::Scene& scene) {
  const HapticState before = latest_state_;
  if (!servo_->receive(latest_state_)) return false;
  // a state of an older program refers to other links
  if (latest_state_.program_epoch != program_->epoch) return false;
  const auto cursor = [&]() -> scene::Cursor& { return scene.entities.get<scene::Cursor>(scene.cursor); };
  const bool was_visible = cursor().visible;  // initially true if the scene states a position
  if (!was_visible && is_mouse() && !mouse_has_moved_) {
    // a mouse that has not been used feels nothing
    latest_state_.force_n = Vec3(0.0);
    for (LinkReport& link : latest_state_.links) link.active = false;
    return false;
  }
  scene::update_cursor(scene, latest_state_);
  cursor().pseudo_haptic = device_.device->capabilities().max_force_n <= 0;
  scene::update_widgets(scene, latest_state_);
  return looks_different(before, latest_state_);
}

void HapticSession::move_mouse(const scene::Scene& scene, const Vec3& world, std::uint32_t buttons) {
  mouse_has_moved_ = true;
  if (mouse_ != nullptr) mouse_->move_to(device_from_world(scene.workspace, world), buttons);
}

void HapticSession::update_resistance(const scene::Scene& scene, Navigation& controls) const {
  controls.force_n = is_mouse() ? latest_state_.force_n : Vec3(0.0);
  controls.max_force_n = scene.coupling.max_force_n;
  controls.last_proxy = is_mouse() ? held_place(latest_state_) : std::nullopt;
}

void HapticSession::set_forces_enabled(bool on) {
  if (is_mouse()) return;
  forces_enabled_ = on;
  servo_->set_forces_enabled(on && !forces_suspended_);
  report_forces();
}

bool HapticSession::suspend_forces(bool off) {
  if (device_.device->capabilities().max_force_n <= 0) return true;
  // whether the state belongs to the program that was handed over last
  const bool newest = latest_state_.program_epoch == program_->epoch;
  if (off != forces_suspended_ && (off || newest)) {
    forces_suspended_ = off;
    servo_->set_forces_enabled(forces_enabled_ && !off);
  }
  return off ? latest_state_.tick == 0 || !forces_enabled_ || latest_state_.force_state == ForceState::off ||
                   latest_state_.force_state == ForceState::stopped
             : !forces_suspended_;
}

std::optional<Vec3> HapticSession::handle_position_m() const {
  const bool ready = latest_state_.condition == TickCondition::normal || latest_state_.condition == TickCondition::late;
  if (latest_state_.tick == 0 || !ready || latest_state_.program_epoch != program_->epoch || !is_finite(latest_state_.probe))
    return std::nullopt;
  return haptics::device_from_world(*program_, latest_state_.probe);
}

void HapticSession::report_forces() const {
  const bool on = servo_->forces_enabled();
  const std::string how = options_.start_with_forces ? "" : fmt::format(" (F turns them {})", on ? "off" : "on");
  print_nonblocking(STDOUT_FILENO,
                    fmt::format("{}: forces {}{}\n", sanitize_for_terminal(device_.device->capabilities().name), on ? "on" : "off", how));
}

}  // namespace catena::app
