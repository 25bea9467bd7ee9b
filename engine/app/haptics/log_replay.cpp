// SPDX-License-Identifier: MIT
#include "engine/app/haptics/log_replay.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <cmath>
#include <filesystem>
#include <optional>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/plugins.h"
#include "engine/app/haptics/tick_csv.h"
#include "engine/app/tuning/choose/tick_tuning.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "haptics/build/build_program.h"
#include "haptics/servo/log/log_replay.h"
#include "haptics/servo/log/reader.h"

namespace catena::app {

namespace log = haptics::log;

IoConflictChecker replay_files(const ReplayOptions& options) {
  IoConflictChecker files;
  for (const std::string* path : {&options.scene, &options.probe, &options.log}) files.add_input(*path);
  files.add_output("-o", options.output);
  files.add_output("--details", options.details);
  files.add_output("--widgets", options.widgets);
  files.add_output("--stats", options.stats);
  return files;
}

std::string replay_stats_json(const haptics::ReplayStats& s, const std::string& more) {
  return fmt::format(
      "{{\n  \"ticks\": {},\n  \"tick_ns\": {{\"p50\": {:.0f}, \"p99\": {:.0f}, \"p999\": {:.0f}, \"max\": {:.0f}}},\n"
      "  \"evaluations\": {{\"p50\": {}, \"max\": {}}},\n  \"state_hash\": \"{:016x}\"{}\n}}\n",
      s.ticks, s.tick_ns_p50, s.tick_ns_p99, s.tick_ns_p999, s.tick_ns_max, s.evaluations_p50, s.evaluations_max, s.state_hash,
      more.empty() ? more : ",\n  " + more);
}

std::string describe_scales(const std::vector<double>& metres_per_unit, bool recorded) {
  std::string scales;
  for (const double scale : metres_per_unit) scales += (scales.empty() ? "" : ", then ") + to_text(scale);
  return fmt::format("the scene states no workspace: 1 world unit is {} m of the device{}\n", scales, recorded ? ", as recorded" : "");
}

namespace {

// Prints "12 ticks, all bit-identical", or throws MachineFailure with the first difference or the gap that ended the replay.
Outcome verdict(const ReplayOptions& options, const log::LogReader& reader, const log::LogReplay& result) {
  const std::string& by = reader.header().catena_version;
  if (result.differing > 0)
    throw MachineFailure{fmt::format("{}: first differs at tick {}: {} ({} of {} ticks differ{})", options.log, result.first_differing,
                                     result.difference, result.differing, result.stats.ticks,
                                     by == kVersion ? "" : "; recorded by catena " + by + ", and this is " + kVersion)};
  fmt::print("{}: {} ticks, all bit-identical; {}\n", sanitize_for_terminal(options.log), result.stats.ticks,
             result.stop_reason.empty() ? sanitize_for_terminal(reader.end_summary()) : "then the recording has a gap");
  if (!result.stop_reason.empty())
    throw MachineFailure{fmt::format("{}: {}; the rest cannot be replayed", options.log, result.stop_reason)};
  return Done{};
}

}  // namespace

Outcome replay_log_file(const ReplayOptions& options) {
  if (!options.probe.empty()) return Error{"--probe and --log exclude each other: the recording contains the probe path"};
  if (options.targets.is_given())
    return Error{"--max-proxy-error and --max-tick-us exclude --log: the recording contains the settings of the links"};
  CATENA_TRY(log::LogReader reader, log::LogReader::open(options.log));
  LogProgramBuilder scene(reader.header(), options.scene, options.fields);
  CATENA_TRY(const LinkColumns all_links, read_log_columns(options.log));
  LinkColumns columns = all_links;

  // inputs of the first program must not be overwritten; they are known after its scene has been read
  CATENA_TRY(const std::vector<std::string> inputs, scene.input_files());
  IoConflictChecker named = replay_files(options);
  named.add_input(inputs);
  CATENA_CHECK(named.check());
  std::optional<OutputFile> ticks, details, widgets, json;
  const auto open = [](std::optional<OutputFile>& file, const std::string& path, const std::string& header) -> Outcome {
    if (path.empty()) return Done{};
    CATENA_TRY(OutputFile opened, OutputFile::open(path));
    file.emplace(std::move(opened));
    file->write(header);
    return Done{};
  };
  CATENA_CHECK(open(ticks, options.output, tick_header(columns)));
  CATENA_CHECK(open(details, options.details, details_header(columns) + "\n"));

  log::LogReplayHooks hooks;
  std::string line;
  std::shared_ptr<const haptics::HapticProgram> running;
  WidgetUsage use;
  std::vector<double> scales;
  hooks.build = [&](const log::LogProgram& program) -> Result<std::shared_ptr<const haptics::HapticProgram>> {
    columns.bind(program.link_names());
    CATENA_TRY(std::shared_ptr<const haptics::HapticProgram> built, scene.build(program));
    if (!running) {
      CATENA_CHECK(open(widgets, options.widgets, widget_header(*built)));
    } else if (widgets && widget_header(*running) != widget_header(*built)) {
      return Error{options.widgets + ": the widgets change within the recording; a table has one set of columns"};
    }
    running = built;
    if (!scene.has_workspace() && (scales.empty() || scales.back() != built->meters_per_unit)) scales.push_back(built->meters_per_unit);
    return built;
  };
  hooks.on_tick = [&](const log::LogProgram& program, const HapticState& state) {
    line.clear();
    append_tick(line, columns, state);
    if (ticks) ticks->write(line);
    use.add(state);
    line.clear();
    if (widgets) append_widgets(line, *running, state), widgets->write(line);
    if (!details) return;
    line.clear();
    append_details(line, columns, program.modes, program.meters_per_unit, state);
    details->write(line + "\n");
  };
  const Result<log::LogReplay> replayed = log::replay_log(reader, hooks);
  if (!replayed) return Error{options.log + ": " + replayed.error().message, replayed.error().system_failure};
  const log::LogReplay& result = *replayed;

  CATENA_CHECK(open(json, options.stats, replay_stats_json(result.stats, running ? use.to_json(*running) : std::string())));
  std::vector<OutputFile*> files;
  for (auto* file : {&ticks, &details, &widgets, &json})
    if (*file) files.push_back(&**file);
  CATENA_CHECK(commit_all(files));
  if (!scales.empty()) fmt::print("{}", describe_scales(scales, true));
  return verdict(options, reader, result);
}

namespace log = haptics::log;
namespace fs = std::filesystem;

Result<log::LogHeader> make_log_header(const std::string& scene_path, const std::vector<std::string>& field_options,
                                       const std::string& device, double rate_hz) {
  log::LogHeader header;
  header.scene_path = scene_path;
  if (is_scene_file(scene_path)) {
    CATENA_TRY(header.scene_text, read_text_file(scene_path, "a scene file (JSON)", kMaxJsonBytes));
  }
  header.fields = field_options;
  header.device = device;
  header.catena_version = kVersion;
  header.rate_hz = rate_hz;
  header.plugins = plugins_for_log();
  return header;
}

Result<LinkColumns> read_log_columns(const std::string& path) {
  CATENA_TRY(log::LogReader reader, log::LogReader::open(path));
  LinkColumns columns;
  for (log::LogEvent event = reader.next(); event != log::LogEvent::done; event = reader.next())
    if (event == log::LogEvent::program) columns.add(reader.program().link_names());
  return columns;
}

namespace {

std::string from_folder(const std::string& folder, const std::string& path) {
  return fs::path(path).is_absolute() ? path : (fs::path(folder) / path).string();
}

// NAME=FILE[:GRID]; a relative FILE is relative to the working folder of the recording
std::string field_from_folder(const std::string& folder, const std::string& option) {
  const auto equals = option.find('=');
  return equals == std::string::npos ? option : option.substr(0, equals + 1) + from_folder(folder, option.substr(equals + 1));
}

}  // namespace

LogProgramBuilder::LogProgramBuilder(log::LogHeader header, std::string scene_path, std::vector<std::string> field_options)
    : header_(std::move(header)), from_file_(!scene_path.empty()), field_options_(std::move(field_options)) {
  scene_path_ = from_file_ ? std::move(scene_path) : from_folder(header_.working_folder, header_.scene_path);
  for (const std::string& option : header_.fields) {
    const std::string name = option.substr(0, option.find('='));
    bool replaced = false;
    for (const std::string& other : field_options_) replaced = replaced || other.starts_with(name + "=");
    if (!replaced) field_options_.push_back(field_from_folder(header_.working_folder, option));
  }
}

Outcome LogProgramBuilder::reload_scene(const std::optional<std::string>& scene_text) {
  if (scene_ && scene_text_ == scene_text) return Done{};
  scene_text_ = scene_text;
  if (!scene_text && (from_file_ || !is_scene_file(scene_path_))) {
    CATENA_TRY(scene_, open_scene(scene_path_, field_options_));
    // applies the recorded tuning: tuning again would depend on the cost curves and on the speed of this computer
    if (scene_->tuning.has_haptic_targets() && is_scene_file(header_.scene_path))
      return tuning::apply_recorded_settings(header_.scene_text, *scene_);
    return Done{};
  }
  CATENA_TRY(const std::vector<scene::FieldOverride> overrides, parse_field_overrides(field_options_));
  CATENA_TRY(scene_, scene::parse_scene(scene_text ? *scene_text : header_.scene_text, scene_path_, overrides));
  return Done{};
}

Result<std::shared_ptr<const haptics::HapticProgram>> LogProgramBuilder::build(const log::LogProgram& program) {
  CATENA_CHECK(reload_scene(program.scene_text));
  CATENA_CHECK(check_plugins(header_.plugins, *scene_));
  scene::Coupling& coupling = scene_->coupling;
  // an explicitly given scene keeps its explicit settings; the others take the recorded values, which were fitted at that time
  if (!from_file_) {
    coupling.stiffness_n_per_m = program.coupling.stiffness_n_per_m;
    coupling.damping_ns_per_m = program.coupling.damping_ns_per_m;
    coupling.max_force_n = program.coupling.max_force_n;
    coupling.method = static_cast<CouplingMethod>(program.coupling.method);
  }
  if (!from_file_ || !coupling.ramp_s) coupling.ramp_s = program.coupling.ramp_s;
  if (!from_file_ || !scene_->workspace.is_explicit)
    scene_->workspace = {program.meters_per_unit, program.workspace_origin, program.workspace_rotation, scene_->workspace.is_explicit};
  // links that are bound to a widget were built with its pose at that time
  for (const log::LogProgram::Widget& from : program.widgets) {
    const scene::Entity found = scene::find_widget(*scene_, from.name);
    if (!found) continue;
    CATENA_CHECK(scene::resolve_widget(*scene_, found));
    scene::Widget& widget = scene_->entities.get<scene::Widget>(found);
    widget.spec.revision = widget.report.revision = from.revision;
    widget.report.pose = from.pose;
    widget.report.value = from.value;
  }
  return haptics::build_program(*scene_, program.limits);
}

Result<std::vector<std::string>> LogProgramBuilder::input_files() {
  CATENA_CHECK(reload_scene({}));
  return scene_input_files(*scene_);
}

namespace log = haptics::log;

Outcome print_log_info(const std::string& path) {
  CATENA_TRY(log::LogReader reader, log::LogReader::open(path));
  const log::LogHeader& header = reader.header();
  const auto seconds = static_cast<std::time_t>(header.started_unix_ns / 1'000'000'000);
  fmt::print("{}: recording of {}\n", sanitize_for_terminal(path),
             header.scene_path.empty() ? "an unnamed scene" : sanitize_for_terminal(header.scene_path));
  if (!header.about.empty()) fmt::print("  about        {}\n", sanitize_for_terminal(header.about));
  for (const std::string& field : header.fields) fmt::print("  field        {}\n", sanitize_for_terminal(field));
  for (const log::LogPlugin& plugin : header.plugins) fmt::print("  plug-in      {}\n", plugin_label(plugin));
  fmt::print("  recorded     {:%Y-%m-%d %H:%M:%S} UTC by catena {}\n", fmt::gmtime(seconds), sanitize_for_terminal(header.catena_version));
  fmt::print("  device       {} at {} Hz\n", sanitize_for_terminal(header.device), to_text(header.rate_hz));
  std::uint64_t ticks = 0;
  double first_s = 0, last_s = 0;
  for (log::LogEvent event = reader.next(); event != log::LogEvent::done; event = reader.next()) {
    if (event == log::LogEvent::gap) fmt::print("  gap          {}\n", sanitize_for_terminal(reader.gap().description()));
    if (event == log::LogEvent::state) fmt::print("  begins       after tick {}, with the state after that tick\n", reader.state().tick);
    if (event == log::LogEvent::program) {
      std::string names;
      for (const std::string& name : reader.program().link_names()) names += (names.empty() ? "" : ", ") + name;
      fmt::print("  program      from tick {}: {}{}\n", reader.program().first_tick,
                 names.empty() ? "no links" : sanitize_for_terminal(names),
                 reader.program().is_known ? "" : " (their definitions are not in the recording)");
    }
    if (event != log::LogEvent::tick) continue;
    // ticks without a device have no valid time
    const double t_s = reader.tick().input.t_s;
    if (ticks++ == 0) first_s = t_s;
    if (std::isfinite(t_s)) last_s = t_s;
  }
  fmt::print("  ticks        {} in {} s\n", ticks, to_text(last_s - first_s));
  fmt::print("  end          {}\n", sanitize_for_terminal(reader.end_summary()));
  return Done{};
}

}  // namespace catena::app
