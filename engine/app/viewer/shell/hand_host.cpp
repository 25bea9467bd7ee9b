#include "engine/app/viewer/shell/hand_host.h"

#include <fmt/format.h>
#include <unistd.h>

#include "engine/app/hand/open_hand.h"
#include "engine/app/viewer/shell/controls.h"
#include "engine/base/tell.h"
#include "engine/base/text.h"
#include "engine/scene/prepare.h"
#include "haptics/extract/extract.h"
#include "haptics/servo/limits_for.h"
#include "haptics/servo/step.h"

namespace catena::app {

namespace {

constexpr const char* kController = "controller";

std::vector<std::string> names_of(const haptics::Program& program) {
  std::vector<std::string> names;
  for (const haptics::Link& link : program.links) names.push_back(link.name);
  return names;
}

/// The last proxy that something holds away from the hand.
std::optional<Vec3> held_place(const exchange::HapticState& felt) {
  std::optional<Vec3> place;
  for (int i = 0; i < felt.link_count; ++i) {
    const exchange::LinkReport& link = felt.links[static_cast<std::size_t>(i)];
    if (link.active && link.gap > 0) place = link.proxy;
  }
  return place;
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

Result<OpenHand> HandHost::open(const scene::Scene& scene, const std::string& name) const {
  if (name == kController && options_.headset) {
    OpenHand hand;
    hand.settings.type = kController;
    haptics::ControllerParameters parameters;
    parameters.rate_hz = hand.settings.rate_hz;
    hand.device = std::make_unique<haptics::Controller>(parameters);
    hand.limits = haptics::limits_for(hand.device->capabilities(), hand.settings);
    return hand;
  }
  if (name != "mouse") return open_hand(scene, name, {}, options_.firmware);
  OpenHand mouse;
  mouse.device = std::make_unique<haptics::MouseDevice>(Vec3(0.0));
  return mouse;
}

Outcome HandHost::open_device(const scene::Scene& scene) {
  std::string name = options_.device;
  if (name.empty() && scene.device) {
    CATENA_TRY(const haptics::DeviceSettings settings, haptics::read_device_settings(*scene.device, scene.path));
    // what is simulated would only keep the hand off the probe
    if (haptics::is_hardware(settings.type)) name = settings.type;
  }
  if (name.empty()) name = options_.headset ? kController : "mouse";
  auto opened = open(scene, name);
  if (!opened) {
    if (!options_.or_mouse || !haptics::is_hardware(haptics::device_type_of(name))) return opened.error();
    const std::string why = opened.error().message;
    name = "mouse";
    opened = open(scene, name);
    opened->note = why + "; the mouse holds the probe";
  }
  hand_ = std::move(*opened);
  device_name_ = name;
  return Done{};
}

void HandHost::name_links(scene::Scene& scene) {
  link_names_ = names_of(*program_);
  scene.world.get<scene::Cursor>(scene.cursor).names = link_names_;
}

/// A mouse begins at the probe: it has been made where nothing is known of the workspace yet.
void HandHost::use(OpenHand hand, const scene::Scene& scene, const Vec3& probe) {
  hand_ = std::move(hand);
  mouse_ = nullptr;
  if (device_name_ != "mouse") return;
  auto mouse = std::make_unique<haptics::MouseDevice>(device_from_world(scene.workspace, probe));
  mouse_ = mouse.get();
  hand_.device = std::move(mouse);
}

void HandHost::make_servo() {
  haptics::ServoOptions servo;
  servo.rate_hz = hand_.settings.rate_hz;
  servo.forces = options_.forces || is_mouse() || hand_.device->capabilities().max_force_n <= 0;
  servo.realtime = options_.realtime;
  if (is_mouse()) servo.realtime.lock_memory = false;  // nothing pushes: a page fault does no harm
  servo.sink = recording_.sink();
  forces_ = servo.forces;
  held_off_ = false;
  servo_ = std::make_unique<haptics::Servo>(*hand_.device, program_, servo);
}

Outcome HandHost::prepare(scene::Scene& scene, const Bounds& bounds, const RecordedScene& text) {
  stated_ = scene.workspace;
  CATENA_TRY(program_, program_for(scene, hand_, bounds));
  first_probe_ = app::first_probe(scene, bounds);
  use(std::move(hand_), scene, first_probe_);
  name_links(scene);
  CATENA_TRY(recording_, Recording::open(options_.record, text, hand_, *program_));
  make_servo();
  return Done{};
}

Outcome HandHost::take_over(scene::Scene& scene, const Bounds& bounds) {
  const scene::Workspace stated = scene.workspace;
  CATENA_TRY(program_, program_for(scene, hand_, bounds));
  const Outcome recorded = stop_recording();
  stated_ = stated;
  first_probe_ = app::first_probe(scene, bounds);
  name_links(scene);
  servo_->set_program(program_);
  move_mouse(scene, first_probe_, 0);
  return recorded;
}

Outcome HandHost::switch_device(scene::Scene& scene, const std::string& name, const Bounds& bounds) {
  CATENA_TRY(OpenHand hand, open(scene, name));
  const scene::Workspace fitted = scene.workspace;
  scene.workspace = stated_;
  auto program = program_for(scene, hand, bounds);
  if (!program) {
    scene.workspace = fitted;
    return program.error();
  }
  const Outcome recorded = stop_recording();
  servo_->stop();
  crash_guard_.reset();
  const auto before = std::move(servo_);
  const std::unique_ptr<haptics::Device> old = std::move(hand_.device);
  program_ = std::move(*program);
  device_name_ = name;
  use(std::move(hand), scene, felt_.tick > 0 ? felt_.probe : first_probe_);
  name_links(scene);
  make_servo();
  servo_->go_on_from(*before);
  CATENA_CHECK(start());
  return recorded;
}

Outcome HandHost::record(const std::string& path, RecordedScene scene, const Around& around) {
  CATENA_CHECK(stop_recording());
  CATENA_TRY(recording_, Recording::open(path, std::move(scene), hand_, *program_));
  if (servo_->set_sink(around ? around(recording_.sink()) : recording_.sink())) return Done{};
  CATENA_CHECK(stop_recording());
  return Error{path + ": the servo does not answer; nothing is recorded"};
}

Outcome HandHost::stop_recording() {
  if (!recording_.running()) return Done{};
  // a servo that does not let go is stopped: its recording must not be written to any more
  if (servo_ && !servo_->set_sink(nullptr)) {
    servo_->stop();
    CATENA_CHECK(servo_->start());
  }
  return recording_.finish();
}

Outcome HandHost::start() {
  if (!is_mouse()) crash_guard_.emplace(*hand_.device);
  CATENA_CHECK(servo_->start());
  if (!hand_.note.empty()) tell_from_catena(hand_.note);
  if (is_mouse()) return Done{};
  for (const std::string& note : servo_->report().realtime.notes) tell_from_catena(note);
  say_forces();
  return Done{};
}

void HandHost::stop() {
  if (servo_) servo_->stop();
}

Outcome HandHost::finish(const std::string& servo_stats) {
  stop();
  CATENA_CHECK(recording_.finish());
  CATENA_CHECK(hand_.device->files_written());
  return write_servo_stats(servo_stats, *servo_, *hand_.device);
}

Outcome HandHost::check(scene::Scene& scene) const {
  CATENA_CHECK(haptics::extract_program(scene, hand_.limits));
  return Done{};
}

Outcome HandHost::publish(scene::Scene& scene, const std::string& text) {
  CATENA_TRY(program_, haptics::extract_program(scene, hand_.limits));
  name_links(scene);
  recording_.add_program(*program_, text);
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

void HandHost::hold_back(const scene::Scene& scene, Controls& controls) const {
  controls.force_n = is_mouse() ? felt_.force_n : Vec3(0.0);
  controls.max_force_n = scene.coupling.max_force_n;
  controls.held = is_mouse() ? held_place(felt_) : std::nullopt;
}

void HandHost::set_forces(bool on) {
  if (is_mouse()) return;
  forces_ = on;
  servo_->set_forces(on && !held_off_);
  say_forces();
}

bool HandHost::hold_off(bool off) {
  if (hand_.device->capabilities().max_force_n <= 0) return true;
  // the state of the program that was handed over last
  const bool newest = felt_.program_epoch == program_->epoch;
  if (off != held_off_ && (off || newest)) {
    held_off_ = off;
    servo_->set_forces(forces_ && !off);
  }
  return off ? felt_.tick == 0 || !forces_ || felt_.force_state == exchange::ForceState::off ||
                   felt_.force_state == exchange::ForceState::stopped
             : !held_off_;
}

std::optional<Vec3> HandHost::place_m() const {
  const bool ready = felt_.condition == exchange::Condition::normal || felt_.condition == exchange::Condition::late;
  if (felt_.tick == 0 || !ready || felt_.program_epoch != program_->epoch || !is_finite(felt_.probe)) return std::nullopt;
  return haptics::device_from_world(*program_, felt_.probe);
}

void HandHost::say_forces() const {
  const bool on = servo_->forces();
  const std::string how = options_.forces ? "" : fmt::format(" (F turns them {})", on ? "off" : "on");
  print_now(STDOUT_FILENO, fmt::format("{}: forces {}{}\n", printable(hand_.device->capabilities().name), on ? "on" : "off", how));
}

}  // namespace catena::app
