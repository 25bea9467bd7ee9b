// SPDX-License-Identifier: MIT
/// catena measure LABELS [--values FILE]: volume, surface and statistics of each label.
/// catena measure FILE --level V | --line A:B | --point P | --histogram N: an isosurface and its parts, profiles, values over time, counts.
/// catena measure [FILE] --distance A:B | --angle A:B:C: lengths and angles.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <optional>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/measure_data.h"
#include "engine/app/cli/options.h"
#include "engine/base/output_file.h"
#include "engine/base/point_text.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

struct MeasureCommand {
  MeasureRequest request;
  std::string output;
  std::optional<std::string> line, distance, angle;
  std::vector<std::string> points;
  std::vector<double> range;
  bool json = false;
};

/// Reads `count` points of an option. Error: another form, or two points so far apart that their distance is no finite number.
Result<std::vector<Vec3>> read_option(const std::string& option, const std::string& text, std::size_t count) {
  const auto points = parse_points(text, count);
  if (!points) {
    const std::string form = count == 1 ? "x,y,z" : count == 2 ? "x,y,z:x,y,z" : "x,y,z:x,y,z:x,y,z";
    return Error{option + " " + in_quotes(text) + ": expected " + form + " with finite numbers"};
  }
  for (std::size_t n = 1; n < count; ++n)
    if (!std::isfinite(norm((*points)[n] - (*points)[n - 1])))
      return Error{option + " " + in_quotes(text) + ": the distance of the points is no finite number"};
  return *points;
}

Outcome read_points(MeasureCommand& options) {
  const auto add = [&](const char* name, const std::string& text, std::size_t count) -> Outcome {
    CATENA_TRY(const std::vector<Vec3> points, read_option(name, text, count));
    options.request.points.insert(options.request.points.end(), points.begin(), points.end());
    return Done{};
  };
  for (const std::string& point : options.points) CATENA_CHECK(add("--point", point, 1));
  if (options.line) CATENA_CHECK(add("--line", *options.line, 2));
  if (options.distance) CATENA_CHECK(add("--distance", *options.distance, 2));
  if (options.angle) CATENA_CHECK(add("--angle", *options.angle, 3));
  return Done{};
}

Result<MeasureReport> measure_chosen(const MeasureCommand& options) {
  const MeasureRequest& request = options.request;
  if (options.distance || options.angle) return measure_geometry(request);
  if (request.source.empty()) return Error{"measure: expected a data file (see catena measure --help)"};
  if (request.level) return measure_level(request);
  if (options.line) return measure_profile(request);
  if (!options.points.empty()) return measure_at_points(request);
  if (request.bins > 0) return measure_histogram(request);
  return measure_label_map(request);
}

Outcome run_measure(MeasureCommand& options) {
  const int kinds = int(options.request.level.has_value()) + int(options.line.has_value()) + int(!options.points.empty()) +
                    int(options.request.bins > 0) + int(options.distance.has_value()) + int(options.angle.has_value());
  if (kinds > 1)
    return Error{"measure: --level, --line, --point, --histogram, --distance and --angle exclude each other; one of them was expected"};
  if (options.request.level && !std::isfinite(*options.request.level)) return Error{"--level: a finite number was expected"};
  const bool has_regions = kinds == 0 || options.request.level;
  if (!has_regions && !options.request.values.empty()) return Error{"measure: --values applies only to labels and to --level"};
  if (!options.range.empty() && options.request.bins == 0) return Error{"measure: --range applies only to --histogram"};
  if (!options.output.empty() && !has_extension(options.output, ".csv") && !options.output.starts_with("/dev/"))
    return Error{options.output + ": expected an output that ends in .csv"};
  if (!options.range.empty()) {
    if (!(options.range[0] < options.range[1]) || !std::isfinite(options.range[1] - options.range[0]))
      return Error{"--range: LO < HI was expected, finite numbers"};
    options.request.range = {options.range[0], options.range[1]};
  }
  CATENA_CHECK(read_points(options));
  IoConflictChecker files;
  files.add_input(options.request.source);
  files.add_input(options.request.values);
  files.add_output("-o", options.output);
  CATENA_CHECK(files.check());
  CATENA_TRY(const MeasureReport report, measure_chosen(options));
  if (!options.output.empty()) {
    CATENA_TRY(OutputFile out, OutputFile::open(options.output));
    out.write(report_to_csv(report));
    CATENA_CHECK(out.commit());
  }
  if (options.json) {
    fmt::print("{}\n", report_to_json(report));
  } else if (options.output.empty()) {
    fmt::print("{}", format_report(report));
  } else {
    fmt::print("{}: {} row{}\n", sanitize_for_terminal(options.output), report.rows.size(), report.rows.size() == 1 ? "" : "s");
  }
  return Done{};
}

}  // namespace

void add_measure(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<MeasureCommand>();
  MeasureRequest& request = options->request;
  CLI::App* command = program.add_subcommand(
      "measure", "measures the labels of a label map, or an isosurface, connected parts, a profile, points or a histogram of a data file");
  add_source(*command, "FILE", request.source, "label map, or data file for the options below; not needed for --distance and --angle")
      ->type_name("FILE");
  command->add_option("--grid", request.grid, "name of a grid of the data file (default: its only one)")->type_name("GRID");
  command->add_option("--step", request.step, "time step, counted from 0 (default: 0)")
      ->type_name("INDEX")
      ->check(CLI::Range(0, 1'000'000));
  command->add_option("--values", request.values, "data file with the values for mean and deviation (default: for --level, FILE itself)")
      ->type_name("DATA");
  command->add_option("--values-grid", request.values_grid, "name of a grid of the file of --values (default: its only one)")
      ->type_name("GRID");
  command
      ->add_option("--level", request.level, "measures the isosurface at this level, and the connected parts of the voxels at or above it")
      ->type_name("VALUE");
  command
      ->add_option("--neighbors", request.neighbors,
                   "connection of voxels in a part: 6 for a common face, 26 also for a common edge or corner")
      ->type_name("N")
      ->check(CLI::IsMember({6, 26}))
      ->capture_default_str();
  command->add_option("--parts", request.parts, "number of the largest parts with their own row; one more row is for the others")
      ->type_name("N")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command->add_option("--line", options->line, "values along a line between two points")->type_name("X,Y,Z:X,Y,Z");
  command->add_option("--samples", request.samples, "number of equidistant samples of a line, its ends included")
      ->type_name("SAMPLES")
      ->check(CLI::Range(2, 10'000'000))
      ->capture_default_str();
  command->add_option("--point", options->points, "values at a point, at every time step of the data")
      ->type_name("X,Y,Z")
      ->allow_extra_args(false);
  command->add_option("--histogram", request.bins, "number of bins of equal width in which the values are counted")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--range", options->range, "lowest and highest edge of the histogram (default: the range of the values)")
      ->type_name("LO HI")
      ->check(accepted("LO < HI"))
      ->expected(2);
  command->add_option("--distance", options->distance, "distance between two points")->type_name("X,Y,Z:X,Y,Z");
  command->add_option("--angle", options->angle, "angle at the second of three points")->type_name("X,Y,Z:X,Y,Z:X,Y,Z");
  command->add_flag("--json", options->json, "prints the result as one JSON object");
  command->add_option("-o,--output", options->output, "table to write")->type_name("FILE.csv");
  command->callback([&chosen, options] { chosen = [options] { return run_measure(*options); }; });
}

}  // namespace catena::app
