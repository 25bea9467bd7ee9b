/// catena replay SCENE --probe PATH.csv -o TICKS.csv [--details LINKS.csv] [--stats FILE.json]
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <optional>

#include "engine/app/command.h"
#include "engine/app/probe_samples.h"
#include "engine/base/csv_paths.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "haptics/device/registry.h"
#include "haptics/extract/extract.h"
#include "haptics/servo/limits_for.h"
#include "haptics/servo/replay.h"

namespace catena::app {

namespace {

struct Options {
  std::string scene, probe, output, details, stats;
  std::vector<std::string> fields;
};

std::string header(const haptics::Program& program) {
  std::string line = "t,probe_x,probe_y,probe_z";
  for (const haptics::Link& link : program.links)
    line += fmt::format(",{0}_x,{0}_y,{0}_z,{0}_active,{0}_status,{0}_evaluations", link.name);
  return line + ",force_x,force_y,force_z\n";
}

void append_vector(std::string& line, const Vec3& v) {
  for (int a = 0; a < 3; ++a) {
    line += ',';
    append_text(line, v[a]);
  }
}

void append_row(std::string& line, const exchange::HapticState& state) {
  append_text(line, state.t_s);
  append_vector(line, state.probe);
  for (int i = 0; i < state.link_count; ++i) {
    const exchange::LinkReport& link = state.links[static_cast<std::size_t>(i)];
    append_vector(line, link.proxy);
    line += link.active ? ",1," : ",0,";
    line += exchange::status_word(link.status);
    line += ',';
    line += std::to_string(link.evaluations);
  }
  append_vector(line, state.force_n);
  line += '\n';
}

// What every link tells beside its proxy: how far the hand is from leaving its feature, its share, its work.
std::string details_header(const haptics::Program& program) {
  std::string line = "t,mode";
  for (const haptics::Link& link : program.links)
    line += fmt::format(
        ",{0}_gap,{0}_leaving,{0}_left,{0}_residual,{0}_stiffness,{0}_weight,{0}_force_x,{0}_force_y,{0}_force_z,{0}_energy,{0}_booked",
        link.name);
  return line + "\n";
}

void append_details(std::string& line, const haptics::Program& program, const exchange::HapticState& state) {
  append_text(line, state.t_s);
  line += ',';
  if (state.mode >= 0) line += program.modes[static_cast<std::size_t>(state.mode)].name;
  for (int i = 0; i < state.link_count; ++i) {
    const exchange::LinkReport& link = state.links[static_cast<std::size_t>(i)];
    const auto number = [&](double value) {
      line += ',';
      append_text(line, value);
    };
    number(link.gap);
    number(link.leaving);
    line += link.left ? ",1" : ",0";
    number(link.residual);
    number(link.stiffness_n_per_m);
    number(link.weight);
    append_vector(line, link.force_n);
    number(link.energy_j(program.metres_per_unit));
    number(link.booked_j);
  }
  line += '\n';
}

// What the hand felt, for a person to read.
struct Felt {
  double max_force_n = 0, mean_force_n = 0;
  std::array<double, exchange::kMaxLinks> max_gap{};
  std::array<std::map<std::string, std::uint64_t>, exchange::kMaxLinks> statuses;

  void add(const exchange::HapticState& state) {
    const double force = norm(state.force_n);
    max_force_n = std::max(max_force_n, force);
    mean_force_n += force;
    for (std::size_t i = 0; i < static_cast<std::size_t>(state.link_count); ++i) {
      max_gap[i] = std::max(max_gap[i], state.links[i].gap);
      ++statuses[i][exchange::status_word(state.links[i].status)];
    }
  }
  void print(const haptics::Program& program, const haptics::ReplayStats& stats) const {
    fmt::print("{} ticks, {:.3f} us each (p99 {:.3f} us), force up to {:.3g} N, {:.3g} N on average\n", stats.ticks,
               1e-3 * stats.tick_ns_p50, 1e-3 * stats.tick_ns_p99, max_force_n,
               stats.ticks > 0 ? mean_force_n / static_cast<double>(stats.ticks) : 0.0);
    for (std::size_t i = 0; i < program.links.size(); ++i) {
      fmt::print("  {}: up to {:.4g} from its probe;", program.links[i].name, max_gap[i]);
      for (const auto& [word, count] : statuses[i]) fmt::print(" {} {}", word, count);
      fmt::print("\n");
    }
  }
};

std::string stats_json(const haptics::ReplayStats& s) {
  return fmt::format(
      "{{\n  \"ticks\": {},\n  \"tick_ns\": {{\"p50\": {:.0f}, \"p99\": {:.0f}, \"p999\": {:.0f}, \"max\": {:.0f}}},\n"
      "  \"evaluations\": {{\"p50\": {}, \"max\": {}}},\n  \"state_hash\": \"{:016x}\"\n}}\n",
      s.ticks, s.tick_ns_p50, s.tick_ns_p99, s.tick_ns_p999, s.tick_ns_max, s.evaluations_p50, s.evaluations_max, s.state_hash);
}

// A scene that names its device is replayed as that device would give it; without one nothing is limited.
Result<haptics::Limits> device_limits(const scene::Scene& scene, const std::string& path) {
  if (!scene.device) return haptics::Limits{};
  CATENA_TRY(const haptics::DeviceSettings settings, haptics::read_device_settings(*scene.device, path));
  return haptics::limits_for(haptics::nominal_capabilities(settings.type), settings);
}

Outcome replay_scene(const Options& options) {
  if (!is_scene_file(options.scene)) return Error{options.scene + ": expected a scene file (.json) with a chain to replay"};
  CATENA_TRY(scene::Scene scene, open_scene(options.scene, options.fields));
  std::vector<std::string> inputs = inputs_of(scene);
  inputs.push_back(options.probe);
  CATENA_CHECK(check_output(options.output, inputs));
  const std::pair<const char*, const std::string&> more[] = {{"--details", options.details}, {"--stats", options.stats}};
  for (const auto& [option, path] : more) {
    if (path.empty()) continue;
    CATENA_CHECK(check_output(path, inputs));
    if (same_file(path, options.output)) return Error{fmt::format("{}: {} and -o name one file: expected two", path, option)};
  }
  if (!options.details.empty() && !options.stats.empty() && same_file(options.details, options.stats))
    return Error{options.details + ": --details and --stats name one file: expected two"};
  CATENA_TRY(const haptics::Limits limits, device_limits(scene, options.scene));
  CATENA_TRY(const std::shared_ptr<const haptics::Program> program, haptics::extract_program(scene, limits));
  CATENA_TRY(const std::vector<ProbeRow> rows, read_probe_path(options.probe));
  const std::vector<haptics::ProbeSample> path = probe_samples(rows);

  CATENA_TRY(OutputFile ticks, OutputFile::open(options.output));
  ticks.write(header(*program));
  std::optional<OutputFile> details, json;
  if (!options.details.empty()) {
    CATENA_TRY(OutputFile file, OutputFile::open(options.details));
    details.emplace(std::move(file));
    details->write(details_header(*program));
  }
  Felt felt;
  Progress progress("replay", static_cast<double>(path.size()));
  std::string line;
  const haptics::ReplayStats stats = haptics::replay(*program, path, [&](const exchange::HapticState& state) {
    line.clear();
    append_row(line, state);
    ticks.write(line);
    if (details) {
      line.clear();
      append_details(line, *program, state);
      details->write(line);
    }
    felt.add(state);
    if (state.tick % 1024 == 0) progress.at(static_cast<double>(state.tick));
    return true;
  });

  std::vector<OutputFile*> files{&ticks};
  if (details) files.push_back(&*details);
  if (!options.stats.empty()) {
    CATENA_TRY(OutputFile file, OutputFile::open(options.stats));
    json.emplace(std::move(file));
    json->write(stats_json(stats));
    files.push_back(&*json);
  }
  CATENA_CHECK(commit_all(files));
  felt.print(*program, stats);
  return Done{};
}

}  // namespace

void add_replay(CLI::App& program, Work& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("replay", "drive the tick from a recorded probe path: deterministic, no thread");
  command->add_option("SCENE", options->scene, "the scene file (.json)")->required();
  command->add_option("--probe", options->probe, "probe path, CSV: t,x,y,z[,buttons]")->required();
  command->add_option("-o,--output", options->output, "ticks, CSV")->required();
  command->add_option("--details", options->details, "what every link tells beside: gap, leaving, share, energy; CSV");
  command->add_option("--stats", options->stats, "figures, JSON");
  command->add_option("--field", options->fields, "replace a field: NAME=FILE[:GRID]")->allow_extra_args(false);
  command->callback([&chosen, options] { chosen = [options] { return replay_scene(*options); }; });
}

}  // namespace catena::app
