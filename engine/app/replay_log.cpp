#include "engine/app/replay_log.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <cmath>
#include <filesystem>
#include <optional>

#include "engine/app/plan/hand_plan.h"
#include "engine/app/plugins.h"
#include "engine/app/run_files.h"
#include "engine/app/tick_csv.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "haptics/extract/extract.h"
#include "haptics/servo/log/log_replay.h"
#include "haptics/servo/log/reader.h"

namespace catena::app {

namespace log = haptics::log;

RunFiles replay_files(const ReplayOptions& options) {
  RunFiles files;
  for (const std::string* path : {&options.scene, &options.probe, &options.log}) files.reads(*path);
  files.writes("-o", options.output);
  files.writes("--details", options.details);
  files.writes("--widgets", options.widgets);
  files.writes("--stats", options.stats);
  return files;
}

std::string replay_stats_json(const haptics::ReplayStats& s, const std::string& more) {
  return fmt::format(
      "{{\n  \"ticks\": {},\n  \"tick_ns\": {{\"p50\": {:.0f}, \"p99\": {:.0f}, \"p999\": {:.0f}, \"max\": {:.0f}}},\n"
      "  \"evaluations\": {{\"p50\": {}, \"max\": {}}},\n  \"state_hash\": \"{:016x}\"{}\n}}\n",
      s.ticks, s.tick_ns_p50, s.tick_ns_p99, s.tick_ns_p999, s.tick_ns_max, s.evaluations_p50, s.evaluations_max, s.state_hash,
      more.empty() ? more : ",\n  " + more);
}

std::string scale_sentence(const std::vector<double>& metres_per_unit, bool recorded) {
  std::string scales;
  for (const double scale : metres_per_unit) scales += (scales.empty() ? "" : ", then ") + to_text(scale);
  return fmt::format("the scene states no workspace: 1 world unit is {} m of the hand{}\n", scales, recorded ? ", as recorded" : "");
}

namespace {

// "12 ticks, all equal to the bit", or where they are not.
Outcome verdict(const ReplayOptions& options, const log::LogReader& reader, const log::LogReplay& result) {
  const std::string& by = reader.header().catena_version;
  if (result.differing > 0)
    throw MachineFailure{fmt::format("{}: first differs at tick {}: {} ({} of {} ticks differ{})", options.log, result.first_differing,
                                     result.difference, result.differing, result.stats.ticks,
                                     by == kVersion ? "" : "; recorded by catena " + by + ", and this is " + kVersion)};
  fmt::print("{}: {} ticks, all equal to the bit; {}\n", printable(options.log), result.stats.ticks,
             result.stopped.empty() ? printable(reader.ending()) : "then the recording has a hole");
  if (!result.stopped.empty()) throw MachineFailure{fmt::format("{}: {}; what follows cannot be run again", options.log, result.stopped)};
  return Done{};
}

}  // namespace

Outcome replay_log_file(const ReplayOptions& options) {
  if (!options.probe.empty()) return Error{"--probe and --log exclude each other: the recording has its own probe"};
  if (!options.plan.empty()) return Error{"--plan and --log exclude each other: the recording has the plan that was felt"};
  CATENA_TRY(log::LogReader reader, log::LogReader::open(options.log));
  LogScene scene(reader.header(), options.scene, options.fields);
  CATENA_TRY(const LinkColumns all_links, columns_of_log(options.log));
  LinkColumns columns = all_links;

  // what the first program needs must not be overwritten; it is known once its scene has been read
  CATENA_TRY(const std::vector<std::string> inputs, scene.inputs());
  RunFiles named = replay_files(options);
  named.reads(inputs);
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
  std::shared_ptr<const haptics::Program> running;
  WidgetUse use;
  std::vector<double> scales;
  hooks.build = [&](const log::LogProgram& program) -> Result<std::shared_ptr<const haptics::Program>> {
    columns.bind(program.link_names());
    CATENA_TRY(std::shared_ptr<const haptics::Program> built, scene.build(program));
    if (!running) {
      CATENA_CHECK(open(widgets, options.widgets, widget_header(*built)));
    } else if (widgets && widget_header(*running) != widget_header(*built)) {
      return Error{options.widgets + ": the recording goes on with other widgets; expected one set of columns"};
    }
    running = built;
    if (!scene.states_workspace() && (scales.empty() || scales.back() != built->metres_per_unit)) scales.push_back(built->metres_per_unit);
    return built;
  };
  hooks.on_tick = [&](const log::LogProgram& program, const exchange::HapticState& state) {
    line.clear();
    append_tick(line, columns, state);
    if (ticks) ticks->write(line);
    use.add(state);
    line.clear();
    if (widgets) append_widgets(line, *running, state), widgets->write(line);
    if (!details) return;
    line.clear();
    append_details(line, columns, program.modes, program.metres_per_unit, state);
    details->write(line + "\n");
  };
  const Result<log::LogReplay> replayed = log::replay_log(reader, hooks);
  if (!replayed) return Error{options.log + ": " + replayed.error().message, replayed.error().machine};
  const log::LogReplay& result = *replayed;

  CATENA_CHECK(open(json, options.stats, replay_stats_json(result.stats, running ? use.json(*running) : std::string())));
  std::vector<OutputFile*> files;
  for (auto* file : {&ticks, &details, &widgets, &json})
    if (*file) files.push_back(&**file);
  CATENA_CHECK(commit_all(files));
  if (!scales.empty()) fmt::print("{}", scale_sentence(scales, true));
  return verdict(options, reader, result);
}

namespace log = haptics::log;
namespace fs = std::filesystem;

Result<log::LogHeader> log_header(const std::string& scene_path, const std::vector<std::string>& field_options, const std::string& device,
                                  double rate_hz) {
  log::LogHeader header;
  header.scene_path = scene_path;
  if (is_scene_file(scene_path)) {
    CATENA_TRY(header.scene_text, read_text(scene_path, "a scene file (JSON)", kMaxJsonBytes));
  }
  header.fields = field_options;
  header.device = device;
  header.catena_version = kVersion;
  header.rate_hz = rate_hz;
  header.plugins = plugins_for_log();
  return header;
}

Result<LinkColumns> columns_of_log(const std::string& path) {
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

// NAME=FILE[:GRID], FILE as seen from where the recording was made
std::string field_from_folder(const std::string& folder, const std::string& option) {
  const auto equals = option.find('=');
  return equals == std::string::npos ? option : option.substr(0, equals + 1) + from_folder(folder, option.substr(equals + 1));
}

}  // namespace

LogScene::LogScene(log::LogHeader header, std::string scene_path, std::vector<std::string> field_options)
    : header_(std::move(header)), from_file_(!scene_path.empty()), field_options_(std::move(field_options)) {
  scene_path_ = from_file_ ? std::move(scene_path) : from_folder(header_.working_folder, header_.scene_path);
  for (const std::string& option : header_.fields) {
    const std::string name = option.substr(0, option.find('='));
    bool replaced = false;
    for (const std::string& other : field_options_) replaced = replaced || other.starts_with(name + "=");
    if (!replaced) field_options_.push_back(field_from_folder(header_.working_folder, option));
  }
}

Outcome LogScene::read(const std::optional<std::string>& own_text) {
  if (scene_ && own_text_ == own_text) return Done{};
  own_text_ = own_text;
  if (!own_text && (from_file_ || !is_scene_file(scene_path_))) {
    CATENA_TRY(scene_, open_scene(scene_path_, field_options_));
    // no curve and no clock has a say in what was felt
    if (scene_->plan.of_hand() && is_scene_file(header_.scene_path)) return plan::take_recorded(header_.scene_text, *scene_);
    return Done{};
  }
  CATENA_TRY(const std::vector<scene::FieldOverride> overrides, field_overrides(field_options_));
  CATENA_TRY(scene_, scene::parse_scene(own_text ? *own_text : header_.scene_text, scene_path_, overrides));
  return Done{};
}

Result<std::shared_ptr<const haptics::Program>> LogScene::build(const log::LogProgram& program) {
  CATENA_CHECK(read(program.scene_text));
  CATENA_CHECK(check_plugins(header_.plugins, *scene_));
  scene::Coupling& coupling = scene_->coupling;
  // a scene from outside keeps what it states; what it leaves open was fitted when it was recorded
  if (!from_file_) {
    coupling.stiffness_n_per_m = program.coupling.stiffness_n_per_m;
    coupling.damping_ns_per_m = program.coupling.damping_ns_per_m;
    coupling.max_force_n = program.coupling.max_force_n;
    coupling.method = static_cast<scene::CouplingMethod>(program.coupling.method);
  }
  if (!from_file_ || !coupling.ramp_s) coupling.ramp_s = program.coupling.ramp_s;
  if (!from_file_ || !scene_->workspace.given)
    scene_->workspace = {program.metres_per_unit, program.workspace_origin, program.workspace_rotation, scene_->workspace.given};
  // links that follow a widget were made where it was then
  for (const log::LogProgram::Widget& from : program.widgets) {
    const scene::Entity found = scene::find_widget(*scene_, from.name);
    if (!found) continue;
    CATENA_CHECK(scene::use_widget(*scene_, found));
    scene::Widget& widget = scene_->world.get<scene::Widget>(found);
    widget.spec.revision = widget.state.revision = from.revision;
    widget.state.pose = from.pose;
    widget.state.value = from.value;
  }
  return haptics::extract_program(*scene_, program.limits);
}

Result<std::vector<std::string>> LogScene::inputs() {
  CATENA_CHECK(read({}));
  return inputs_of(*scene_);
}

namespace log = haptics::log;

Outcome describe_log(const std::string& path) {
  CATENA_TRY(log::LogReader reader, log::LogReader::open(path));
  const log::LogHeader& header = reader.header();
  const auto seconds = static_cast<std::time_t>(header.started_unix_ns / 1'000'000'000);
  fmt::print("{}: recording of {}\n", printable(path), header.scene_path.empty() ? "a scene without a name" : printable(header.scene_path));
  if (!header.about.empty()) fmt::print("  about        {}\n", printable(header.about));
  for (const std::string& field : header.fields) fmt::print("  field        {}\n", printable(field));
  for (const log::LogPlugin& plugin : header.plugins) fmt::print("  plug-in      {}\n", text_of(plugin));
  fmt::print("  recorded     {:%Y-%m-%d %H:%M:%S} UTC by catena {}\n", fmt::gmtime(seconds), printable(header.catena_version));
  fmt::print("  device       {} at {} Hz\n", printable(header.device), to_text(header.rate_hz));
  std::uint64_t ticks = 0;
  double first_s = 0, last_s = 0;
  for (log::LogEvent event = reader.next(); event != log::LogEvent::done; event = reader.next()) {
    if (event == log::LogEvent::gap) fmt::print("  gap          {}\n", printable(reader.gap().text()));
    if (event == log::LogEvent::state) fmt::print("  begins       after tick {}, with the state of that moment\n", reader.state().tick);
    if (event == log::LogEvent::program) {
      std::string names;
      for (const std::string& name : reader.program().link_names()) names += (names.empty() ? "" : ", ") + name;
      fmt::print("  program      from tick {}: {}{}\n", reader.program().first_tick, names.empty() ? "no links" : printable(names),
                 reader.program().known ? "" : " (the recording does not say what they are)");
    }
    if (event != log::LogEvent::tick) continue;
    // a device that is not there has no time of its own
    const double t_s = reader.tick().input.t_s;
    if (ticks++ == 0) first_s = t_s;
    if (std::isfinite(t_s)) last_s = t_s;
  }
  fmt::print("  ticks        {} in {} s\n", ticks, to_text(last_s - first_s));
  fmt::print("  end          {}\n", printable(reader.ending()));
  return Done{};
}

}  // namespace catena::app
