#include "engine/app/replay_log.h"

#include <fmt/core.h>

#include <optional>

#include "engine/app/log_scene.h"
#include "engine/app/tick_csv.h"
#include "engine/app/widget_csv.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "haptics/servo/log/log_replay.h"

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

namespace {

// "12 ticks, all equal to the bit", or where they are not.
Outcome verdict(const ReplayOptions& options, const log::LogReader& reader, const log::LogReplay& result) {
  if (result.differing > 0)
    throw MachineFailure{fmt::format("{}: first differs at tick {}: {} ({} of {} ticks differ)", options.log, result.first_differing,
                                     result.difference, result.differing, result.stats.ticks)};
  fmt::print("{}: {} ticks, all equal to the bit; {}\n", printable(options.log), result.stats.ticks,
             result.stopped.empty() ? printable(reader.ending()) : "then the recording has a hole");
  if (!result.stopped.empty()) throw MachineFailure{fmt::format("{}: {}; what follows cannot be run again", options.log, result.stopped)};
  return Done{};
}

}  // namespace

Outcome replay_log_file(const ReplayOptions& options) {
  if (!options.probe.empty()) return Error{"--probe and --log exclude each other: the recording has its own probe"};
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
  hooks.build = [&](const log::LogProgram& program) -> Result<std::shared_ptr<const haptics::Program>> {
    columns.bind(program.link_names());
    CATENA_TRY(std::shared_ptr<const haptics::Program> built, scene.build(program));
    if (!running) {
      CATENA_CHECK(open(widgets, options.widgets, widget_header(*built)));
    } else if (widgets && widget_header(*running) != widget_header(*built)) {
      return Error{options.widgets + ": the recording goes on with other widgets; expected one set of columns"};
    }
    running = built;
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
  if (!replayed) return Error{options.log + ": " + replayed.error().message};
  const log::LogReplay& result = *replayed;

  CATENA_CHECK(open(json, options.stats, replay_stats_json(result.stats, running ? use.json(*running) : std::string())));
  std::vector<OutputFile*> files;
  for (auto* file : {&ticks, &details, &widgets, &json})
    if (*file) files.push_back(&**file);
  CATENA_CHECK(commit_all(files));
  return verdict(options, reader, result);
}

}  // namespace catena::app
