// SPDX-License-Identifier: MIT
/// catena generate NAME -o OUT.vdb --resolution N [--box LO HI]; an OUT.zarr may be larger than memory
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <memory>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/analytic/analytic.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/voxel_source.h"
#include "engine/io/zarr/write_zarr.h"

namespace catena::app {

namespace {

constexpr int kMaxResolution = 1024, kMaxZarrResolution = 32768;

struct GenerateOptions {
  std::string name, output;
  int resolution = 0;
  std::array<double, 2> box{-2, 2};
  double scale = 1;
  std::vector<double> direction{1, 0, 0};
  bool direction_given = false;
};

Outcome check(const GenerateOptions& o) {
  if (!field::is_analytic(o.name)) {
    const auto names = field::analytic_names();
    return Error{"no analytic field " + in_quotes(o.name) + suggestion(o.name, names) + "; known: " + join_words(names)};
  }
  const int max_resolution = has_extension(o.output, ".zarr") ? kMaxZarrResolution : kMaxResolution;
  if (o.resolution < 2 || o.resolution > max_resolution)
    return Error{fmt::format("--resolution {}: expected 2 to {} nodes along each axis{}", o.resolution, max_resolution,
                             max_resolution == kMaxResolution ? fmt::format(" ({} for .zarr)", kMaxZarrResolution) : "")};
  if (!std::isfinite(o.box[0]) || !std::isfinite(o.box[1]) || !(o.box[0] < o.box[1]))
    return Error{fmt::format("--box {} {}: expected two finite numbers, LO < HI", to_text(o.box[0]), to_text(o.box[1]))};
  if (!std::isfinite(o.scale) || o.scale == 0)
    return Error{fmt::format("--scale {}: expected a finite number other than 0", to_text(o.scale))};
  if (o.direction_given && o.name != "uniform") return Error{"--direction: applies only to uniform, not to " + o.name};
  const Vec3 d(o.direction[0], o.direction[1], o.direction[2]);
  if (!is_finite(d) || norm(d) == 0) return Error{"--direction: expected three finite numbers, not all zero"};
  if (has_extension(o.output, ".zarr")) {
    if (const auto parts = field::analytic_parts(o.name); parts.size() > 1)
      return Error{
          fmt::format("{}: {} consists of {} fields, expected one for .zarr (.vdb stores several)", o.output, o.name, parts.size())};
    return Done{};  // write_zarr() checks the rest
  }
  if (!o.output.ends_with(".vdb") && !o.output.starts_with("/dev/"))
    return Error{o.output + ": expected an output that ends in .vdb or .zarr"};
  IoConflictChecker files;
  files.add_output("-o", o.output);
  return files.check();
}

field::AnalyticParameters parameters_of(const GenerateOptions& o) {
  field::AnalyticParameters parameters;
  parameters.scale = o.scale;
  parameters.direction = Vec3(o.direction[0], o.direction[1], o.direction[2]);
  return parameters;
}

Outcome generate_zarr(const GenerateOptions& o) {
  CATENA_TRY(const field::AnyField exact, field::make_analytic(o.name, parameters_of(o)));
  CATENA_TRY(field::VoxelSource source, field::voxels_of_formula(exact, o.resolution, o.box[0], o.box[1]));
  source.name = o.name;
  source.identity += fmt::format("formula {}, scale {}\n", o.name, to_text(o.scale));
  ProgressLine progress("generate", 1);
  CATENA_CHECK(field::write_zarr(o.output, std::move(source), [&](double part) { progress.update(part); }));
  return Done{};
}

Outcome generate_vdb(const GenerateOptions& o) {
  std::vector<field::NamedGrid> items;
  const auto parts = field::analytic_parts(o.name);
  ProgressLine progress("generate", static_cast<double>(parts.size()));
  for (const std::string_view part : parts) {
    field::AnalyticParameters parameters = parameters_of(o);
    if (parts.size() > 1) parameters.part = std::string(part);
    CATENA_TRY(const field::AnyField exact, field::make_analytic(o.name, parameters));
    CATENA_TRY(const field::AnyField sampled, field::try_sample_on_grid(exact, o.resolution, o.box[0], o.box[1]));
    items.push_back({sampled, std::string(part)});
    progress.update(static_cast<double>(items.size()));
  }
  return field::write_vdb(o.output, items);
}

Outcome generate(const GenerateOptions& o) {
  CATENA_CHECK(check(o));
  const bool as_zarr = has_extension(o.output, ".zarr");
  CATENA_CHECK(as_zarr ? generate_zarr(o) : generate_vdb(o));
  fmt::print("{}:", sanitize_for_terminal(o.output));
  const auto parts = as_zarr ? std::vector<std::string_view>{o.name} : field::analytic_parts(o.name);
  for (const std::string_view part : parts) fmt::print(" {}", sanitize_for_terminal(part));
  fmt::print(", {0} x {0} x {0} nodes, spacing {1}\n", o.resolution, to_text((o.box[1] - o.box[0]) / (o.resolution - 1)));
  return Done{};
}

}  // namespace

void add_generate(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<GenerateOptions>();
  CLI::App* command = program.add_subcommand("generate", "samples a formula on a grid");
  command->add_option("NAME", options->name, "formula to sample")
      ->type_name("FORMULA")
      ->check(accepted_words(join_words(field::analytic_names(), field::analytic_names().size())))
      ->required();
  command->add_option("-o,--output", options->output, "grid to write: .vdb, or .zarr, which may be larger than memory")
      ->type_name("FORMULAFILE")
      ->required();
  command
      ->add_option("--resolution", options->resolution,
                   fmt::format("nodes along each axis, both ends included (.zarr: up to {})", kMaxZarrResolution))
      ->type_name("NODES")
      ->check(accepted("2 to " + std::to_string(kMaxResolution)))
      ->required();
  command->add_option("--box", options->box, "extent of the cube along each axis, world units")
      ->type_name("LO HI")
      ->check(accepted("LO < HI"))
      ->capture_default_str();
  command->add_option("--scale", options->scale, "factor of the values")
      ->type_name("FACTOR")
      ->check(accepted("finite, not 0"))
      ->capture_default_str();
  CLI::Option* direction = command->add_option("--direction", options->direction, "direction of the formula uniform")
                               ->type_name("X Y Z")
                               ->check(accepted("not all 0"))
                               ->expected(3)
                               ->capture_default_str();
  command->callback([&chosen, options, direction] {
    options->direction_given = direction->count() > 0;
    chosen = [options] { return generate(*options); };
  });
}

}  // namespace catena::app
