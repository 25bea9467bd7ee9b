// SPDX-License-Identifier: MIT
/// catena replay SCENE --probe PATH.csv -o TICKS.csv [--details LINKS.csv] [--widgets W.csv] [--stats FILE.json]
/// catena replay [SCENE] --log FILE.catlog [-o TICKS.csv] ...: repeats a recording and compares the results bit by bit (log_replay.h)
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "engine/app/cli/command.h"
#include "engine/app/haptics/contact_summary.h"
#include "engine/app/haptics/log_replay.h"
#include "engine/app/haptics/probe_playback.h"
#include "engine/app/haptics/tick_csv.h"
#include "engine/app/tuning/choose/tracking_error.h"
#include "engine/app/tuning/choose/tune.h"
#include "engine/base/csv.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "haptics/build/build_program.h"
#include "haptics/device/registry.h"
#include "haptics/servo/device_limits.h"
#include "haptics/servo/replay.h"

namespace catena::app {

namespace {

// Returns the limits of the device that the scene names, so that the replay applies them; no limits if it names none.
Result<haptics::DeviceLimits> device_limits(const scene::Scene& scene, const std::string& path) {
  if (!scene.device) return haptics::DeviceLimits{};
  CATENA_TRY(const haptics::DeviceSettings settings, haptics::read_device_settings(*scene.device, path));
  return haptics::compute_device_limits(haptics::nominal_capabilities(settings.type), settings);
}

/// Tunes the links before the first tick; returns the tuning, if the scene or the options request one.
Result<std::optional<tuning::TickTuning>> plan_the_hand(scene::Scene& scene, const ReplayOptions& options) {
  const scene::TuningTargets wanted = options.targets.resolve(scene);
  double rate_hz = 1000;
  if (scene.device) {
    CATENA_TRY(const haptics::DeviceSettings settings, haptics::read_device_settings(*scene.device, scene.path));
    rate_hz = settings.rate_hz;
  }
  return tuning::tune_links(scene, wanted, rate_hz, options.fields,
                            [](const std::string& line) { fmt::print("{}\n", sanitize_for_terminal(line)); });
}

Outcome replay_scene(const ReplayOptions& options) {
  if (options.scene.empty()) return Error{"SCENE is required (see catena replay --help)"};
  if (options.probe.empty()) return Error{"--probe or --log is required (see catena replay --help)"};
  if (options.output.empty()) return Error{"--output is required (see catena replay --help)"};
  if (!is_scene_file(options.scene)) return Error{options.scene + ": a scene file (.json) with a chain was expected"};
  CATENA_TRY(scene::Scene scene, open_scene(options.scene, options.fields));
  IoConflictChecker named = replay_files(options);
  named.add_input(scene);
  CATENA_CHECK(named.check());
  CATENA_TRY(const haptics::DeviceLimits limits, device_limits(scene, options.scene));
  CATENA_TRY(const std::optional<tuning::TickTuning> plan, plan_the_hand(scene, options));
  CATENA_TRY(const std::shared_ptr<const haptics::HapticProgram> program, haptics::build_program(scene, limits));
  print_scene_notes(scene);
  CATENA_TRY(const std::vector<ProbePathRow> rows, read_probe_path(options.probe));
  const std::vector<haptics::ProbeSample> path = to_probe_samples(rows);
  const bool turns = rows.front().has_orientation;

  CATENA_TRY(OutputFile ticks, OutputFile::open(options.output));
  const LinkColumns columns(link_names(*program));
  const std::vector<std::string> modes = mode_names(*program);
  ticks.write(tick_header(columns, turns));
  std::optional<OutputFile> details, widgets, json;
  if (!options.details.empty()) {
    CATENA_TRY(OutputFile file, OutputFile::open(options.details));
    details.emplace(std::move(file));
    details->write(details_header(columns) + "\n");
  }
  if (!options.widgets.empty()) {
    CATENA_TRY(OutputFile file, OutputFile::open(options.widgets));
    widgets.emplace(std::move(file));
    widgets->write(widget_header(*program));
  }
  ContactSummary contacts;
  tuning::TrackingErrorMonitor observer(plan ? &*plan : nullptr, *program);
  WidgetUsage use;
  ProgressLine progress("replay", static_cast<double>(path.size()));
  std::string line;
  const haptics::ReplayStats stats = haptics::replay(*program, path, [&](const HapticState& state) {
    line.clear();
    append_tick(line, columns, state, turns);
    ticks.write(line);
    if (details) {
      line.clear();
      append_details(line, columns, modes, program->meters_per_unit, state);
      line += '\n';
      details->write(line);
    }
    if (widgets) {
      line.clear();
      append_widgets(line, *program, state);
      widgets->write(line);
    }
    contacts.add(state);
    observer.add(state);
    use.add(state);
    if (state.tick % 1024 == 0) progress.update(static_cast<double>(state.tick));
    return true;
  });

  std::vector<OutputFile*> files{&ticks};
  if (details) files.push_back(&*details);
  if (widgets) files.push_back(&*widgets);
  if (!options.stats.empty()) {
    CATENA_TRY(OutputFile file, OutputFile::open(options.stats));
    json.emplace(std::move(file));
    json->write(replay_stats_json(stats, use.to_json(*program)));
    files.push_back(&*json);
  }
  CATENA_CHECK(commit_all(files));
  if (!scene.workspace.is_explicit) fmt::print("{}", describe_scales({program->meters_per_unit}, false));
  if (!(program->coupling.ramp_s > 0))
    fmt::print("forces are not ramped (\"ramp_s\" is 0): they jump when a link is released or switched\n");
  fmt::print("{}", observer.summary(scene, 1e-3 * stats.tick_ns_p50));
  fmt::print("{}", contacts.report(*program, stats));
  fmt::print("{}", use.report(*program));
  return Done{};
}

}  // namespace

void add_replay(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command =
      program.add_subcommand("replay", "runs the chain along a probe path or a recording, with identical bits in every run");
  command->add_option("SCENE", options->scene, "scene (.json); with --log, the scene that replaces the recorded one")->type_name("SCENE");
  command->add_option("--probe", options->probe, "probe path: t,x,y,z[,buttons][,qw,qx,qy,qz]; required without --log")
      ->type_name("PROBE.csv");
  command->add_option("--log", options->log, "recording to replay; every bit is compared")->type_name("FILE.catlog");
  command->add_option("-o,--output", options->output, "tick table to write; required without --log")->type_name("FILE.csv");
  command->add_option("--details", options->details, "table of the details of each link to write: gap, release ratio, force, energy")
      ->type_name("FILE.csv");
  command->add_option("--widgets", options->widgets, "table of the modes and poses of the widgets to write")->type_name("FILE.csv");
  command->add_option("--stats", options->stats, "statistics to write")->type_name("FILE.json");
  options->targets.add_to(*command);
  command->add_option("--field", options->fields, "replaces a field of the scene")->type_name("NAME=FILE[:GRID]")->allow_extra_args(false);
  command->callback(
      [&chosen, options] { chosen = [options] { return options->log.empty() ? replay_scene(*options) : replay_log_file(*options); }; });
}

}  // namespace catena::app
