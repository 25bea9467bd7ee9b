// SPDX-License-Identifier: MIT
/// catena export FILE.catlog -o TICKS.csv [--details FILE.csv] [--poses FILE.csv]: a recording as tables, without the scene's files.
/// catena export SCENE --isosurface I|--slice I|--streamlines I|--mesh M|--field F|--probe PATH.csv -o OUT: a part of a scene.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "engine/app/cli/command.h"
#include "engine/app/cli/export_scene.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/haptics/log_replay.h"
#include "engine/base/console.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"
#include "engine/io/mesh/write_mesh.h"
#include "engine/io/volume/write_field.h"
#include "haptics/servo/log/reader.h"

namespace catena::app {

namespace {

namespace log = haptics::log;

struct ExportOptions {
  std::string log, output, details, poses;
  SceneExport part;
};

void append_quat(std::string& line, const Quat& q) {
  for (const double v : {q.w, q.x, q.y, q.z}) {
    line += ',';
    append_number(line, v);
  }
}

// Returns the column names of the recorded values that `replay --details` does not write.
std::string recorded_header(const LinkColumns& columns) {
  std::string line =
      ",tick,probe_time,buttons,condition,forces_on,force_state,orientation_w,orientation_x,orientation_y,orientation_z,"
      "coupling_x,coupling_y,coupling_z,torque_x,torque_y,torque_z,observer_energy,dissipated,"
      "missed_deadlines,period_us,compute_us,device_us";
  for (const std::string& name : columns.names())
    line += fmt::format(",{0}_orientation_w,{0}_orientation_x,{0}_orientation_y,{0}_orientation_z,{0}_torque_x,{0}_torque_y,{0}_torque_z",
                        name);
  return line + "\n";
}

void append_recorded(std::string& line, const LinkColumns& columns, const log::LogTick& tick) {
  const HapticState& state = tick.output;
  const auto number = [&](double value) {
    line += ',';
    append_number(line, value);
  };
  line += fmt::format(",{},{},{},{},{},{}", state.tick, to_text(tick.input.t_s), state.buttons, to_string(state.condition),
                      tick.input.forces_on ? 1 : 0, to_string(state.force_state));
  append_quat(line, state.orientation);
  append_vector(line, state.coupling_force_n);
  append_vector(line, state.torque_nm);
  number(state.energy_j);
  number(state.dissipated_j);
  line += fmt::format(",{}", state.missed_deadlines);
  for (const double v : {state.period_us, state.compute_us, state.device_us}) number(v);
  for (std::size_t c = 0; c < columns.names().size(); ++c) {
    if (columns.link_at(c) < 0) {
      line += ",,,,,,,";
      continue;
    }
    const LinkReport& link = state.links[static_cast<std::size_t>(columns.link_at(c))];
    append_quat(line, link.orientation);
    append_vector(line, link.torque_nm);
  }
  line += '\n';
}

Outcome export_log(const ExportOptions& options) {
  CATENA_TRY(log::LogReader reader, log::LogReader::open(options.log));
  IoConflictChecker files;
  files.add_input(options.log);
  files.add_output("-o", options.output);
  files.add_output("--details", options.details);
  files.add_output("--poses", options.poses);
  CATENA_CHECK(files.check());
  CATENA_TRY(LinkColumns columns, read_log_columns(options.log));
  CATENA_TRY(OutputFile ticks, OutputFile::open(options.output));
  ticks.write(tick_header(columns));
  std::optional<OutputFile> details;
  if (!options.details.empty()) {
    CATENA_TRY(OutputFile file, OutputFile::open(options.details));
    details.emplace(std::move(file));
    details->write(details_header(columns) + recorded_header(columns));
  }

  std::optional<OutputFile> poses;
  if (!options.poses.empty()) {
    CATENA_TRY(OutputFile file, OutputFile::open(options.poses));
    poses.emplace(std::move(file));
    poses->write(log::poses_csv_header());
  }

  std::string line;
  std::uint64_t count = 0;
  for (log::LogEvent event = reader.next(); event != log::LogEvent::done; event = reader.next()) {
    if (event == log::LogEvent::program) columns.bind(reader.program().link_names());
    if (event == log::LogEvent::gap) print_line(options.log + ": " + reader.gap().description());
    if (event == log::LogEvent::poses && poses) {
      line.clear();
      for (const log::LogPoses& one : reader.poses()) append_poses_csv(line, one);
      poses->write(line);
    }
    if (event != log::LogEvent::tick) continue;
    ++count;
    line.clear();
    append_tick(line, columns, reader.tick().output);
    ticks.write(line);
    if (!details) continue;
    line.clear();
    append_details(line, columns, reader.program().modes, reader.program().meters_per_unit, reader.tick().output);
    append_recorded(line, columns, reader.tick());
    details->write(line);
  }
  std::vector<OutputFile*> written{&ticks};
  if (details) written.push_back(&*details);
  if (poses) written.push_back(&*poses);
  CATENA_CHECK(commit_all(written));
  fmt::print("{}: {} ticks; {}\n", sanitize_for_terminal(options.log), count, sanitize_for_terminal(reader.end_summary()));
  return Done{};
}

constexpr const char* kParts = "--isosurface, --slice, --streamlines, --mesh, --field or --probe";

Outcome export_any(const ExportOptions& options) {
  const SceneExport& part = options.part;
  const int parts = int(part.isosurface.has_value()) + int(part.slice.has_value()) + int(part.streamlines.has_value()) +
                    int(!part.mesh.empty()) + int(!part.field.empty()) + int(!part.probe.empty());
  if (is_log_file(options.log)) {
    if (!part.grid.empty()) return Error{options.log + ": is a recording; --grid applies only to a data file"};
    if (parts > 0) return Error{options.log + ": is a recording; " + kParts + " apply only to a scene"};
    if (part.step >= 0) return Error{options.log + ": --step applies only to a scene or a data file"};
    return export_log(options);
  }
  if (!options.details.empty()) return Error{options.log + ": --details applies only to a recording (.catlog)"};
  if (!options.poses.empty()) return Error{options.log + ": --poses applies only to a recording (.catlog)"};
  if (parts != 1) return Error{options.log + ": one of " + kParts + " was expected, for the part of the scene to write"};
  SceneExport request = part;
  request.source = options.log;
  request.output = options.output;
  return export_scene(request);
}

}  // namespace

void add_export(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<ExportOptions>();
  SceneExport& part = options->part;
  CLI::App* command = program.add_subcommand("export", "writes a recording as tables, or one part of a scene for other programs");
  add_source(*command, "FILE", options->log, "recording (.catlog), scene (.json) or data file")->type_name("FILE")->required();
  command
      ->add_option("-o,--output", options->output,
                   "file to write: the tick table (CSV) of a recording, or a part of a scene in the format of the file's extension")
      ->type_name("OUT")
      ->required();
  command->add_option("--details", options->details, "table of the details of each link and of the servo to write, for a recording")
      ->type_name("FILE.csv");
  command
      ->add_option("--poses", options->poses,
                   "table of the poses of head, hands and gaze per image to write, for a recording with a headset")
      ->type_name("FILE.csv");
  const auto number = CLI::Range(0, 1'000'000);
  command
      ->add_option("--isosurface", part.isosurface,
                   "index of the isosurface to write, counted from 0: " + io::writable_extensions(io::DataKind::mesh))
      ->type_name("INDEX")
      ->check(number);
  command->add_option("--slice", part.slice, "index of the slice to write with the values of all fields, counted from 0: .csv or .vtp")
      ->type_name("INDEX")
      ->check(number);
  command->add_option("--streamlines", part.streamlines, "index of the streamlines to write, counted from 0: .vtp or .csv")
      ->type_name("INDEX")
      ->check(number);
  command->add_option("--mesh", part.mesh, "mesh to write: " + io::writable_extensions(io::DataKind::mesh))->type_name("MESH");
  command
      ->add_option("--grid", part.grid,
                   "field of a data file for the default scene (default: the first scalar field, or else the first field)")
      ->type_name("GRID");
  command->add_option("--step", part.step, "time step, counted from 0 (default: the scene's)")->type_name("INDEX")->check(number);
  command->add_option("--field", part.field, "field to write: " + io::writable_extensions(io::DataKind::volume))->type_name("FIELD");
  command->add_option("--probe", part.probe, "probe path at whose positions the values of all fields are written: .csv")
      ->type_name("PROBE.csv");
  command->add_option("--spacing", part.spacing, "distance between samples of a slice (default: the smallest voxel edge)")
      ->type_name("DISTANCE")
      ->check(number_above_zero());
  command
      ->add_option("--outside", part.outside,
                   "side to which the normals of an isosurface point: lower or higher values; auto: higher for a level set, or else lower")
      ->type_name("WORD")
      ->check(CLI::IsMember({"auto", "lower", "higher"}))
      ->capture_default_str();
  command->callback([&chosen, options] { chosen = [options] { return export_any(*options); }; });
}

}  // namespace catena::app
