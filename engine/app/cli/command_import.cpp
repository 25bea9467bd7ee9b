// SPDX-License-Identifier: MIT
/// catena import IN -o OUT: converts any file that Catena reads to a format that it writes (engine/io/volume/write_field.h).
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/render/outputs.h"
#include "engine/base/console.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/write_field.h"
#include "engine/io/zarr/write_zarr.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

namespace {

struct ImportOptions {
  std::string input, output, grid, name;
  std::vector<int> shape;
  std::vector<double> spacing{1, 1, 1}, origin{0, 0, 0};
  std::string type = "float32";
  int step = -1;
};

/// Checks that no output is an input file; all files of a series are inputs, not only the file of one step.
Outcome check_outputs(const ImportOptions& o, const std::vector<std::string>& outputs) {
  IoConflictChecker files;
  files.add_input(o.input);
  for (const std::string& output : outputs) {
    if (has_extension(output, ".zarr")) CATENA_CHECK(field::check_new_store(output));
    files.add_output("-o", output);
  }
  return files.check();
}

/// Converts one step. `printed_notes` holds the notes of earlier steps, which are not repeated.
Outcome import_step(const ImportOptions& o, const field::LoadRequest& request, const std::string& output,
                    std::set<std::string>& printed_notes) {
  std::vector<std::string> notes;
  ProgressLine progress("import", 1);
  CATENA_TRY(const std::string name, field::convert_file(request, output, o.name, &notes, [&](double part) { progress.update(part); }));
  for (const std::string& note : notes)
    if (printed_notes.insert(note).second) print_message("note: " + request.path + ": " + note);
  fmt::print("{}: {}\n", sanitize_for_terminal(output), sanitize_for_terminal(name));
  return Done{};
}

Result<int> count_steps(const field::LoadRequest& request) {
  if (scene::is_pattern(request.path)) return static_cast<int>(scene::expand_pattern(request.path).size());
  if (const std::size_t steps = field::read_times(request.path).size(); steps > 1) return static_cast<int>(steps);
  CATENA_TRY(const field::AnyField first, field::load(request));
  return scene::list_time_steps(request.path, first).count;
}

/// Checks that one step is selected if there is one output.
Outcome check_one_step(const ImportOptions& o, const field::LoadRequest& request) {
  const bool pattern = scene::is_pattern(request.path);
  if (o.step < 0 && !pattern) return Done{};
  CATENA_TRY(const int steps, count_steps(request));
  if (o.step < 0)
    return Error{
        fmt::format("{}: {} files for one output; --step N was expected, or %03d in the output's name for all steps", o.input, steps)};
  return check_step(o.step, steps - 1, fmt::format("--step {}", o.step), o.input);
}

Outcome import_file(ImportOptions o) {
  while (o.output.size() > 1 && o.output.ends_with(".zarr/")) o.output.pop_back();  // a store is a folder
  if (io::find_writer(o.output, io::DataKind::volume) == nullptr && !o.output.starts_with("/dev/"))
    return Error{o.output + ": expected an output that ends in " + io::writable_extensions(io::DataKind::volume)};
  const bool raw_file = io::needs_layout(o.input);
  if (!raw_file && !o.shape.empty()) return Error{o.input + ": --shape applies only to .raw files"};
  field::LoadRequest request;
  request.path = o.input;
  request.grid = o.grid;
  if (raw_file) {
    if (o.shape.empty()) return Error{o.input + ": a .raw file needs --shape NX NY NZ"};
    field::RawLayout raw;
    raw.shape = {o.shape[0], o.shape[1], o.shape[2]};
    raw.spacing = Vec3(o.spacing[0], o.spacing[1], o.spacing[2]);
    raw.origin = Vec3(o.origin[0], o.origin[1], o.origin[2]);
    raw.type = o.type;
    request.raw = raw;
  }
  std::set<std::string> printed_notes;
  if (!is_numbered(o.output)) {
    CATENA_CHECK(check_one_step(o, request));
    CATENA_CHECK(check_outputs(o, {o.output}));
    CATENA_CHECK(import_step(o, scene::request_at(request, std::max(o.step, 0)), o.output, printed_notes));
    if (const std::size_t steps = field::read_times(o.input).size(); o.step < 0 && steps > 1)
      print_message(fmt::format(
          "note: {}: only step 0 of {} is written; --step N writes another step, %03d in the output's name writes all", o.input, steps));
    return Done{};
  }
  if (o.step >= 0)
    return Error{fmt::format("--step {}: applies only to a single output, but {} is a file for each step", o.step, o.output)};
  CATENA_TRY(const int steps, count_steps(request));
  std::vector<std::string> outputs;
  for (int step = 0; step < steps; ++step) outputs.push_back(numbered_path(o.output, step));
  CATENA_CHECK(check_outputs(o, outputs));
  for (int step = 0; step < steps; ++step) CATENA_CHECK(import_step(o, scene::request_at(request, step), outputs[step], printed_notes));
  return Done{};
}

}  // namespace

void add_import(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command = program.add_subcommand("import", "converts a data file to .vdb, .vti, .nrrd, NIfTI or OME-Zarr");
  add_source(*command, "IN", options->input, io::describe_expected(io::DataKind::volume))->type_name("DATA")->required();
  command
      ->add_option("-o,--output", options->output,
                   "grid to write: " + io::writable_extensions(io::DataKind::volume) +
                       "; with %03d in the name, one numbered file for each time step")
      ->type_name("GRIDFILE")
      ->required();
  command->add_option("--step", options->step, "time step, counted from 0 (default: the first of one file)")
      ->type_name("INDEX")
      ->check(CLI::Range(0, 1'000'000));
  command->add_option("--grid", options->grid, "grid to convert (default: the first usable grid)")->type_name("GRID");
  command->add_option("--name", options->name, "name of the grid in the output (default: the name in the input)")->type_name("GRID");
  command->add_option("--shape", options->shape, "number of voxels along x, y and z of a .raw file")
      ->type_name("NX NY NZ")
      ->check(accepted(">= 1"))
      ->expected(3);
  command->add_option("--spacing", options->spacing, "voxel edges of a .raw file, world units")
      ->type_name("X Y Z")
      ->check(accepted("> 0"))
      ->expected(3)
      ->capture_default_str();
  command->add_option("--origin", options->origin, "centre of the first voxel of a .raw file, world units")
      ->type_name("X Y Z")
      ->expected(3)
      ->capture_default_str();
  command->add_option("--type", options->type, "voxel type of a .raw file")->type_name("TYPE")->capture_default_str();
  command->callback([&chosen, options] { chosen = [options] { return import_file(*options); }; });
}

}  // namespace catena::app
