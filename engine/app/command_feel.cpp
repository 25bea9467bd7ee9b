/// catena feel SCENE [--device NAME] [--seconds S] [--rate HZ] [--forces on|off] [--stats FILE.json]: the hand without a window.
#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "engine/app/command.h"
#include "engine/app/felt.h"
#include "engine/app/hand/open_hand.h"
#include "engine/app/hand/recording.h"
#include "engine/app/hand/signals.h"
#include "engine/app/options.h"
#include "engine/app/plan/make_plan.h"
#include "engine/app/plan/observe.h"
#include "engine/app/run_files.h"
#include "engine/base/clock.h"
#include "engine/base/tell.h"
#include "engine/base/text.h"
#include "engine/scene/prepare.h"
#include "haptics/extract/extract.h"

namespace catena::app {

namespace {

struct FeelOptions {
  std::string scene, device, firmware, forces = "off", stats, record, plan;
  std::vector<std::string> fields;
  double seconds = 0;
  std::optional<double> rate_hz;
  RealtimeChoice realtime;
};

/// What the workspace is fitted to; not needed where the scene states its own.
Result<Bounds> bounds_of(scene::Scene& scene) {
  if (scene.workspace.given) return Bounds();
  CATENA_TRY([[maybe_unused]] const auto felt, haptics::extract_program(scene));
  CATENA_CHECK(scene::prepare(scene));
  return scene::prepared_bounds(scene);
}

constexpr int kPatienceMs = 500;  // with a terminal that takes nothing, once the device is off

/// From here on a hand may be held: nothing waits for a terminal.
void print_out(std::string_view text, int wait_ms = 0) { print_now(STDOUT_FILENO, text, wait_ms); }

/// "1000 Hz  curve OK  surface FREE  0.53 N  ON  0 missed", once a second on a terminal.
class StatusLine {
 public:
  explicit StatusLine(const haptics::Program& program) : program_(program), terminal_(isatty(STDOUT_FILENO) == 1) {}

  void show(const exchange::HapticState& state, double rate_hz) {
    if (!terminal_) return;
    std::string line = fmt::format("{:.0f} Hz", rate_hz);
    for (std::size_t i = 0; i < program_.links.size(); ++i)
      line += fmt::format("  {} {}", program_.links[i].name, exchange::status_word(state.links[i].status));
    line += fmt::format("  {:.2f} N  {}", norm(state.force_n), exchange::force_state_word(state.force_state));
    if (state.condition != exchange::Condition::normal) line += fmt::format("  {}", exchange::condition_word(state.condition));
    print_out(fmt::format("\r{}  {} missed\033[K", printable(line), state.missed_deadlines));
    shown_ = true;
  }
  /// What the device asks of the person, when it changes; not only on a terminal.
  void tell(const std::string& text) {
    if (text == told_) return;
    told_ = text;
    if (!text.empty()) say(text);
  }
  void say(const std::string& text) {
    end();
    print_out(printable(text) + "\n");
  }
  void end() {
    if (shown_) print_out("\n");
    shown_ = false;
  }

 private:
  const haptics::Program& program_;
  bool terminal_, shown_ = false;
  std::string told_;
};

/// Until the time is over or somebody asks to end.
void wait(haptics::Servo& servo, const haptics::Device& device, const Recording& recording, const FeelOptions& options,
          const Interrupt& interrupt, StatusLine& line, Felt& felt, plan::HandObserver& observer) {
  constexpr double kStep = 0.02, kLine = 1;
  const std::int64_t start = now_ns();
  exchange::HapticState state;
  double shown = 0;
  std::uint64_t shown_ticks = 0;
  bool told_of_recording = false;
  while (!interrupt.asked()) {
    const double t = 1e-3 * ms_since(start);
    if (options.seconds > 0 && t >= options.seconds) return;
    if (servo.take(state) && state.condition != exchange::Condition::no_device) {
      felt.add(state);
      observer.add(state);
    }
    line.tell(device.status_text());
    if (recording.failed() && !std::exchange(told_of_recording, true))
      line.say(options.record + ": the recording has stopped; the rest is felt only");
    if (t - shown >= kLine) {
      line.show(state, static_cast<double>(state.tick - shown_ticks) / (t - shown));
      shown = t;
      shown_ticks = state.tick;
    }
    const double left = options.seconds > 0 ? options.seconds - t : kStep;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, kStep)));
  }
}

Outcome feel(const FeelOptions& options) {
  if (!is_scene_file(options.scene)) return Error{options.scene + ": expected a scene file (.json) with a chain to feel"};
  CATENA_TRY(scene::Scene scene, open_scene(options.scene, options.fields));
  RunFiles files(scene);
  files.reads_device(options.device);
  files.reads(options.firmware);
  files.writes("--stats", options.stats);
  files.writes("--record", options.record);
  CATENA_CHECK(files.check());
  CATENA_TRY(const scene::Plan wanted, plan::wanted_hand_plan(scene, options.plan));
  CATENA_TRY(OpenHand hand, open_hand(scene, options.device, options.rate_hz, options.firmware));
  // the plan stands before the first tick, and is part of the text that is recorded
  CATENA_TRY(std::string text, plan::text_of(scene));
  CATENA_TRY(const std::optional<plan::HandPlan> plan,
             plan::plan_links(scene, text, wanted, hand.settings.rate_hz, options.fields,
                              [](const std::string& said) { print_out(printable(said) + "\n"); }));
  if (plan) {
    CATENA_TRY(text, plan->apply(text, options.scene));
  }
  // from here on: while it opens there is no force, and Ctrl-C ends at once
  const Interrupt interrupt;
  const CrashGuard crash_guard(*hand.device);
  if (!hand.note.empty()) tell_from_catena(hand.note);
  CATENA_TRY(const Bounds bounds, bounds_of(scene));
  CATENA_TRY(const std::shared_ptr<const haptics::Program> program, program_for(scene, hand, bounds));
  tell_notes(scene);

  haptics::ServoOptions servo_options;
  servo_options.rate_hz = hand.settings.rate_hz;
  servo_options.forces = options.forces == "on";
  servo_options.realtime = options.realtime.options();
  CATENA_TRY(Recording recording, Recording::open(options.record, {options.scene, text, options.fields, inputs_of(scene)}, hand, *program));
  servo_options.sink = recording.sink();
  haptics::Servo servo(*hand.device, program, servo_options);
  CATENA_CHECK(servo.start());
  for (const std::string& note : servo.report().realtime.notes) tell_from_catena(note);
  print_out(fmt::format("{} at {:g} Hz, forces {}; 1 world unit is {:.4g} m of the hand{}\n", printable(hand.device->capabilities().name),
                        servo_options.rate_hz, options.forces, program->metres_per_unit, options.seconds > 0 ? "" : "; Ctrl-C ends"));
  StatusLine line(*program);
  Felt felt;
  plan::HandObserver observer(plan ? &*plan : nullptr, *program);
  wait(servo, *hand.device, recording, options, interrupt, line, felt, observer);
  servo.stop();
  line.end();
  CATENA_CHECK(recording.finish());
  CATENA_CHECK(write_servo_stats(options.stats, servo, *hand.device));
  if (!servo_options.forces && !program->links.empty())
    print_out("the forces were off: nothing was pushed, the shares are what the links asked for\n", kPatienceMs);
  print_out(observer.sentence(scene, servo.report().compute.p50_us), kPatienceMs);
  print_out(felt.sentences(*program), kPatienceMs);
  print_out(haptics::servo_summary(servo.report(), printable(hand.device->capabilities().name)), kPatienceMs);
  CATENA_CHECK(hand.device->files_written());
  return interrupt.outcome();
}

}  // namespace

void add_feel(CLI::App& program, Work& chosen) {
  auto options = std::make_shared<FeelOptions>();
  CLI::App* command = program.add_subcommand("feel", "feel a scene with a haptic device, without a window");
  command->add_option("SCENE", options->scene, "the scene file (.json)")->required();
  command->add_option("--device", options->device, "NAME or NAME:DETAIL; default: the scene's \"device\", or else simulated");
  command->add_option("--seconds", options->seconds, "end after so long; default: until Ctrl-C")->check(number_at_least(0));
  command->add_option("--rate", options->rate_hz, "ticks a second; default: the device's, or else 1000")
      ->check(number_between(haptics::ServoOptions::kMinRateHz, haptics::ServoOptions::kMaxRateHz));
  command->add_option("--firmware", options->firmware, "falcon: the vendor's image, sent when the device has none");
  command->add_option("--record", options->record, "every tick, .catlog (replay --log, export, info read it)");
  command->add_option("--plan", options->plan,
                      "hand_error=E (world units) or hand_time=US (a tick): links that say no setting get theirs by it");
  command->add_option("--forces", options->forces, "on: the device may push. Off at first, for a simulated device too")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  command->add_option("--stats", options->stats, "ticks, missed deadlines, histograms, JSON");
  command->add_option("--field", options->fields, "replace a field: NAME=FILE[:GRID]")->allow_extra_args(false);
  add_realtime_options(*command, options->realtime);
  command->callback([&chosen, options] { chosen = [options] { return feel(*options); }; });
}

}  // namespace catena::app
