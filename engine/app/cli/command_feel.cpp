// SPDX-License-Identifier: MIT
/// catena feel SCENE [--device NAME] [--seconds S] [--rate HZ] [--forces on|off] [--stats FILE.json]: haptics without a window.
#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/haptics/contact_summary.h"
#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/app/haptics/recording.h"
#include "engine/app/haptics/signal_handlers.h"
#include "engine/app/tuning/choose/tracking_error.h"
#include "engine/app/tuning/choose/tune.h"
#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/text.h"
#include "engine/scene/prepare.h"
#include "haptics/build/build_program.h"

namespace catena::app {

namespace {

struct FeelOptions {
  std::string scene, device, firmware, forces = "off", stats, record;
  HapticTargetOptions targets;
  std::vector<std::string> fields;
  double seconds = 0;
  std::optional<double> rate_hz;
  RealtimeChoice realtime;
};

/// Returns the bounds to which the workspace is fitted; empty if the scene has an explicit workspace.
Result<Bounds> bounds_of(scene::Scene& scene) {
  if (scene.workspace.is_explicit) return Bounds();
  CATENA_TRY([[maybe_unused]] const auto program, haptics::build_program(scene));
  CATENA_CHECK(scene::prepare(scene));
  return scene::scene_bounds(scene);
}

constexpr int kPatienceMs = 500;  // maximum wait for a blocked terminal after the device is off

/// Prints without blocking: the device may be exerting force, so nothing may wait for a terminal.
void print_out(std::string_view text, int wait_ms = 0) { print_nonblocking(STDOUT_FILENO, text, wait_ms); }

/// Status line "1000 Hz  curve OK  surface FREE  0.53 N  ON  0 missed", updated once a second on a terminal.
class StatusLine {
 public:
  explicit StatusLine(const haptics::HapticProgram& program) : program_(program), terminal_(isatty(STDOUT_FILENO) == 1) {}

  void show(const HapticState& state, double rate_hz) {
    if (!terminal_) return;
    std::string line = fmt::format("{:.0f} Hz", rate_hz);
    for (std::size_t i = 0; i < program_.links.size(); ++i)
      line += fmt::format("  {} {}", program_.links[i].name, to_string(state.links[i].status));
    line += fmt::format("  {:.2f} N  {}", norm(state.force_n), to_string(state.force_state));
    if (state.condition != TickCondition::normal) line += fmt::format("  {}", to_string(state.condition));
    print_out(fmt::format("\r{}  {} missed\033[K", sanitize_for_terminal(line), state.missed_deadlines));
    shown_ = true;
  }
  /// Prints the device's request to the user when it changes, also if the output is no terminal.
  void print(const std::string& text) {
    if (text == last_text_) return;
    last_text_ = text;
    if (!text.empty()) write_line(text);
  }
  void write_line(const std::string& text) {
    end();
    print_out(sanitize_for_terminal(text) + "\n");
  }
  void end() {
    if (shown_) print_out("\n");
    shown_ = false;
  }

 private:
  const haptics::HapticProgram& program_;
  bool terminal_, shown_ = false;
  std::string last_text_;
};

/// Collects statistics until the time is over or an end is requested.
void wait(haptics::Servo& servo, const haptics::Device& device, const Recording& recording, const FeelOptions& options,
          const InterruptHandler& interrupt, StatusLine& line, ContactSummary& contacts, tuning::TrackingErrorMonitor& observer) {
  constexpr double kStep = 0.02, kLine = 1;
  const std::int64_t start = now_ns();
  HapticState state;
  double shown = 0;
  std::uint64_t shown_ticks = 0;
  bool told_of_recording = false;
  while (!interrupt.is_requested()) {
    const double t = 1e-3 * ms_since(start);
    if (options.seconds > 0 && t >= options.seconds) return;
    if (servo.receive(state) && state.condition != TickCondition::no_device) {
      contacts.add(state);
      observer.add(state);
    }
    line.print(device.status_text());
    if (recording.has_failed() && !std::exchange(told_of_recording, true))
      line.write_line(options.record + ": the recording has stopped; the session continues without it");
    if (t - shown >= kLine) {
      line.show(state, static_cast<double>(state.tick - shown_ticks) / (t - shown));
      shown = t;
      shown_ticks = state.tick;
    }
    const double left = options.seconds > 0 ? options.seconds - t : kStep;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, kStep)));
  }
}

Outcome run_feel(const FeelOptions& options) {
  if (!is_scene_file(options.scene)) return Error{options.scene + ": a scene file (.json) with a chain was expected"};
  CATENA_TRY(scene::Scene scene, open_scene(options.scene, options.fields));
  IoConflictChecker files(scene);
  files.add_device_files(options.device);
  files.add_input(options.firmware);
  files.add_output("--stats", options.stats);
  files.add_output("--record", options.record);
  CATENA_CHECK(files.check());
  const scene::TuningTargets wanted = options.targets.resolve(scene);
  CATENA_TRY(HapticDeviceSetup hand, open_haptic_device(scene, options.device, options.rate_hz, options.firmware));
  // the links are tuned before the first tick, and the tuned text is the one that is recorded
  CATENA_TRY(std::string text, tuning::read_scene_text(scene));
  CATENA_TRY(const std::optional<tuning::TickTuning> plan,
             tuning::tune_links(scene, text, wanted, hand.settings.rate_hz, options.fields,
                                [](const std::string& message) { print_out(sanitize_for_terminal(message) + "\n"); }));
  if (plan) {
    CATENA_TRY(text, plan->apply(text, options.scene));
  }
  // Ctrl-C before this point ends the program at once: no force is exerted yet
  const InterruptHandler interrupt;
  const CrashGuard crash_guard(*hand.device);
  if (!hand.note.empty()) print_message(hand.note);
  CATENA_TRY(const Bounds bounds, bounds_of(scene));
  CATENA_TRY(const std::shared_ptr<const haptics::HapticProgram> program, make_device_program(scene, hand, bounds));
  print_scene_notes(scene);

  haptics::ServoOptions servo_options;
  servo_options.rate_hz = hand.settings.rate_hz;
  servo_options.forces_enabled = options.forces == "on";
  servo_options.realtime = options.realtime.options();
  CATENA_TRY(Recording recording,
             Recording::open(options.record, {options.scene, text, options.fields, scene_input_files(scene)}, hand, *program));
  servo_options.sink = recording.sink();
  haptics::Servo servo(*hand.device, program, servo_options);
  CATENA_CHECK(servo.start());
  for (const std::string& note : servo.stats().realtime.notes) print_message(note);
  print_out(fmt::format("{} at {:g} Hz, forces {}; 1 world unit is {:.4g} m of the device{}\n",
                        sanitize_for_terminal(hand.device->capabilities().name), servo_options.rate_hz, options.forces,
                        program->meters_per_unit, options.seconds > 0 ? "" : "; Ctrl-C ends the session"));
  StatusLine line(*program);
  ContactSummary contacts;
  tuning::TrackingErrorMonitor observer(plan ? &*plan : nullptr, *program);
  wait(servo, *hand.device, recording, options, interrupt, line, contacts, observer);
  servo.stop();
  line.end();
  CATENA_CHECK(recording.finish());
  CATENA_CHECK(write_servo_stats(options.stats, servo, *hand.device));
  if (!servo_options.forces_enabled && !program->links.empty())
    print_out("the forces were off: the device exerted none; the forces below are those that the links requested\n", kPatienceMs);
  print_out(observer.summary(scene, servo.stats().compute.p50_us), kPatienceMs);
  print_out(contacts.link_lines(*program), kPatienceMs);
  print_out(haptics::servo_summary(servo.stats(), sanitize_for_terminal(hand.device->capabilities().name)), kPatienceMs);
  CATENA_CHECK(hand.device->check_output_files());
  return interrupt.outcome();
}

}  // namespace

void add_feel(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<FeelOptions>();
  CLI::App* command = program.add_subcommand("feel", "runs a haptic device in a scene, without a window");
  command->add_option("SCENE", options->scene, "scene (.json)")->type_name("SCENE")->required();
  command->add_option("--device", options->device, "haptic device, NAME or NAME:DETAIL (default: the scene's, or simulated)")
      ->type_name("DEVICE");
  command->add_option("--seconds", options->seconds, "duration (default: until Ctrl-C)")->type_name("S")->check(number_at_least(0));
  command->add_option("--rate", options->rate_hz, "tick rate (default: the device's, or 1000)")
      ->type_name("HZ")
      ->check(number_between(haptics::ServoOptions::kMinRateHz, haptics::ServoOptions::kMaxRateHz));
  command->add_option("--firmware", options->firmware, "firmware image of the vendor, sent to a Falcon without firmware")
      ->type_name("FIRMWARE");
  command->add_option("--record", options->record, "recording of every tick to write, for replay --log, export and info")
      ->type_name("FILE.catlog");
  options->targets.add_to(*command);
  command->add_option("--forces", options->forces, "whether the device may exert forces")
      ->type_name("WORD")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  command->add_option("--stats", options->stats, "statistics of the servo to write")->type_name("FILE.json");
  command->add_option("--field", options->fields, "replaces a field of the scene")->type_name("NAME=FILE[:GRID]")->allow_extra_args(false);
  add_realtime_options(*command, options->realtime);
  command->callback([&chosen, options] { chosen = [options] { return run_feel(*options); }; });
}

}  // namespace catena::app
