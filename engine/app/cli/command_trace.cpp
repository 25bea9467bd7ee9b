// SPDX-License-Identifier: MIT
/// catena trace SCENE|FILE --field NAME --seeds CSV|PATTERN -o LINES.{csv,vtp} [--lines stream|path|streak] [--tolerance T] [--shard I/N]
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "engine/app/batch/line_parts.h"
#include "engine/app/batch/run_key.h"
#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/base/clock.h"
#include "engine/base/csv.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/geometry/flow/batch_tracer.h"
#include "engine/io/formats.h"
#include "engine/io/volume/load_field.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/unsteady_lines.h"

namespace catena::app {

namespace {

struct TraceOptions {
  std::string source, field, seeds, output, kind = "vector", stats;
  std::optional<std::string> shard;
  int repeat = 1, time_step = -1;
  std::string lines = "stream", time_interpolation = "linear";
  std::vector<double> times;
  double length = 0, min_speed = 0, tolerance = 0, step = 0;
};

std::int64_t process_cpu_ns() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1'000'000'000 * static_cast<std::int64_t>(t.tv_sec) + t.tv_nsec;
}

/// Returns the scene, or one created from a data file with the grids that the options name.
Result<scene::Scene> scene_of(const TraceOptions& options) {
  scene::Scene scene;
  scene.path = options.source;
  if (is_scene_file(options.source)) {
    CATENA_TRY(scene, open_scene(options.source));
    CATENA_CHECK(go_to_step(scene, options.time_step, fmt::format("--time-step {}", options.time_step)));
  } else {
    scene.time.step = std::max(options.time_step, 0);
  }
  return scene;
}

scene::Entity add_grid(scene::Scene& scene, const std::string& grid) {
  const scene::Entity entity = scene.entities.create();
  scene::FieldSource source;
  field::LoadRequest request;
  request.path = scene.path;
  request.grid = grid;
  source.file = scene::request_at(request, scene.time.step);
  if (scene::is_pattern(scene.path)) {
    source.pattern = scene.path;
    source.series = scene::expand_pattern(scene.path);
  }
  source.where.file = std::make_shared<const std::string>(scene.path);
  scene.entities.emplace<scene::Name>(entity, {grid});
  scene.entities.emplace<scene::FieldSource>(entity, std::move(source));
  return entity;
}

Result<field::VectorFieldPtr> vector_field(scene::Scene& scene, const TraceOptions& options) {
  field::AnyField any;
  if (is_scene_file(options.source)) {
    const scene::Entity entity = scene::find_field(scene, options.field);
    if (!entity) {
      std::vector<std::string_view> known;
      scene.entities.each<scene::FieldSource>(
          [&](scene::Entity e, const scene::FieldSource&) { known.push_back(scene.entities.get<scene::Name>(e).value); });
      return Error{options.source + ": there is no field \"" + options.field +
                   "\"; known fields: " + (known.empty() ? "none" : join_words(known))};
    }
    CATENA_TRY(any, scene::resolve_field(scene, entity, scene.entities.get<scene::FieldSource>(entity).where));
  } else {
    field::LoadRequest request;
    request.path = options.source;
    request.grid = options.field;
    CATENA_TRY(any, field::load(scene::request_at(request, scene.time.step)));
    CATENA_CHECK(check_step(options.time_step, scene::list_time_steps(options.source, any).count - 1,
                            fmt::format("--time-step {}", options.time_step), options.source));
    print_scene_notes(options.source, any.notes);
  }
  print_scene_notes(scene);
  if (!any.vector) return Error{options.source + ": field \"" + options.field + "\" is a scalar field: expected a vector field to trace"};
  return any.vector;
}

using Curves = std::vector<flow::CurvePtr>;

/// The seeds to trace: every `stride`-th of a command, from `first` on.
struct SeedShare {
  std::size_t first = 0, stride = 1;
};

/// Wall time and CPU time of each repetition of the tracing, without reading and writing files.
struct Timing {
  std::vector<double> wall_ms, cpu_ms;

  template <class Work>
  auto measure(Work&& work) {
    const std::int64_t start = now_ns(), start_cpu = process_cpu_ns();
    auto result = work();
    wall_ms.push_back(ms_since(start));
    cpu_ms.push_back(1e-6 * static_cast<double>(process_cpu_ns() - start_cpu));
    return result;
  }
};

/// Traces the seeds of a CSV table on all cores.
Result<SeededLines> trace_table(const TraceOptions& options, const flow::Flow& flow, const SeedShare& share, Timing& timing) {
  CATENA_TRY(const std::vector<Vec3> all_seeds, read_seeds(options.seeds));
  SeededLines lines;
  std::vector<Vec3> seeds;
  for (std::size_t i = share.first; i < all_seeds.size(); i += share.stride) {
    seeds.push_back(all_seeds[i]);
    lines.seeds.push_back(i);
  }
  flow::TraceOptions exact;
  exact.length = options.length;
  exact.max_step = options.step * flow.field->max_voxel_edge();
  flow::BatchOptions batch;
  batch.length = options.length;
  batch.tolerance = options.tolerance;
  batch.max_step = options.step;
  const bool exactly = options.tolerance <= 1e-9;
  const flow::BatchTracer tracer(flow, batch);
  const std::size_t at_once = exactly ? 64 : 4096;  // seeds between two updates of the progress line
  const auto trace_all = [&]() -> Result<Curves> {
    Curves curves;
    curves.reserve(seeds.size());
    ProgressLine progress("trace", static_cast<double>(seeds.size()));
    std::size_t knots = 0;
    const std::size_t max_knots = scene::knot_limit();
    for (std::size_t first = 0; first < seeds.size(); first += at_once) {
      const std::span block(seeds.data() + first, std::min(at_once, seeds.size() - first));
      const auto traced = exactly ? flow::trace_all(flow, block, exact) : tracer.trace(block);
      for (std::size_t i = 0; i < traced.size(); ++i) {
        if (!traced[i])
          // + 2: 1-based, after the header
          return Error{fmt::format("{}:{}: {}", options.seeds, lines.seeds[first + i] + 2, traced[i].error().message)};
        curves.push_back(*traced[i]);
        knots += curves.back()->knots().size();
      }
      if (knots > max_knots)
        return Error{options.seeds + ": " + scene::too_many_knots_message(seeds.size(), first + block.size(), max_knots)};
      progress.update(static_cast<double>(first + block.size()));
    }
    return curves;
  };
  for (int n = 1; n < options.repeat; ++n) CATENA_CHECK(timing.measure(trace_all));
  CATENA_TRY(lines.curves, timing.measure(trace_all));
  return lines;
}

bool is_pattern(const std::string& seeds) { return seeds.starts_with("{") || seeds.ends_with(".json"); }

/// Reads a seed pattern in the format of a scene's "seeds": JSON text, or the name of a JSON file.
Result<json::Node> pattern_of(const std::string& seeds) {
  return seeds.starts_with("{") ? json::parse(seeds, "--seeds") : json::read(seeds);
}

Result<SeededLines> trace_pattern(const TraceOptions& options, const json::Node& node, const flow::Flow& flow, const SeedShare& share,
                                  scene::Scene& scene) {
  // other grids of the data file are added when a pattern refers to them by name
  if (const json::Node* surface = node.find("isosurface"); surface != nullptr && !is_scene_file(options.source))
    if (const json::Node* name = surface->find("field"); name != nullptr && name->kind == json::Kind::string) add_grid(scene, name->string);
  CATENA_TRY(const scene::Seeds seeds, scene::read_seeds(scene, node));
  const bool is_evenly_spaced = seeds.pattern && seeds.pattern->kind == scene::SeedPattern::Kind::evenly_spaced;
  if (options.shard && is_evenly_spaced)
    return Error{"--shard: evenly spaced lines depend on each other; a table of seeds or another pattern was expected"};
  SeededLines lines;
  std::optional<ProgressLine> shown;
  const auto progress = [&](std::size_t done, std::size_t of) {
    if (!shown) shown.emplace("trace", static_cast<double>(of));
    shown->update(static_cast<double>(done));
  };
  scene::LineRequest request{flow, options.length, options.tolerance, options.step, scene::knot_limit(), progress};
  // the scene's box limits only evenly spaced lines, which would otherwise fill the whole space; other lines are traced to their end
  const scene::Entity field = scene::find_field(scene, options.field);
  if (field && is_evenly_spaced) request.box = scene.entities.get<scene::FieldSource>(field).box;
  request.first_seed = share.first;
  request.seed_stride = share.stride;
  request.line_seeds = &lines.seeds;
  CATENA_TRY(lines.curves, scene::trace_lines(scene, seeds, request, node));
  return lines;
}

/// Traces path lines or streak lines, which need all time steps of the field.
Result<SeededLines> trace_unsteady(const TraceOptions& options, const json::Node& pattern, const flow::Flow& flow, const SeedShare& share,
                                   scene::Scene& scene, Timing& timing) {
  scene::Seeds seeds;
  if (is_pattern(options.seeds)) {
    CATENA_TRY(seeds, scene::read_seeds(scene, pattern));
  } else {
    CATENA_TRY(seeds.points, read_seeds(options.seeds));
  }
  SeededLines lines;
  std::optional<ProgressLine> shown;
  scene::LineRequest request{flow};
  request.progress = [&](std::size_t done, std::size_t of) {
    if (!shown) shown.emplace("trace", static_cast<double>(of));
    shown->update(static_cast<double>(done));
  };
  request.first_seed = share.first;
  request.seed_stride = share.stride;
  request.line_seeds = &lines.seeds;
  request.lines = options.lines == "path" ? scene::LineKind::path : scene::LineKind::streak;
  request.field = scene::find_field(scene, options.field);
  if (!request.field) request.field = add_grid(scene, options.field);
  if (!options.times.empty()) request.times = std::array{options.times[0], options.times[1]};
  request.is_cubic_in_time = options.time_interpolation == "cubic";
  request.tolerance = options.tolerance;
  if (request.lines == scene::LineKind::streak && !request.times && options.time_step < 0 && scene.time.step == 0) {
    CATENA_CHECK(scene::resolve_field(scene, request.field, pattern));
    const std::vector<double> times = scene::times_of_field(scene, request.field);
    if (times.size() > 1) request.times = std::array{times.front(), times.back()};
  }
  json::Node where = pattern;
  if (!is_pattern(options.seeds)) {
    where.file = std::make_shared<const std::string>(options.source);
    request.seed_table = options.seeds;
  }
  for (int n = 1; n < options.repeat; ++n) {
    scene.traced_paths.clear();
    lines.seeds.clear();
    CATENA_CHECK(timing.measure([&] { return scene::trace_lines(scene, seeds, request, where); }));
  }
  scene.traced_paths.clear();
  lines.seeds.clear();
  CATENA_TRY(lines.curves, timing.measure([&] { return scene::trace_lines(scene, seeds, request, where); }));
  return lines;
}

/// Key of a run with these inputs.
std::string run_key_of(const TraceOptions& options, const IoConflictChecker& files) {
  RunKey key("trace");
  key.add(options.field)
      .add(options.kind)
      .add(options.lines)
      .add(options.time_interpolation)
      .add(options.seeds.starts_with("{") ? options.seeds : "");
  for (const double time : options.times) key.add(time);
  for (const double number : {options.length, options.min_speed, options.tolerance, options.step, double(options.time_step)})
    key.add(number);
  return key.add_files(files.inputs()).text();
}

/// Names of the outputs: of a shard, its own ones.
TraceOptions with_output_names(TraceOptions options, const std::optional<Shard>& shard) {
  if (shard && !options.stats.empty()) options.stats = part_path(options.stats, *shard);
  return options;
}

Outcome trace_lines(const TraceOptions& given) {
  CATENA_TRY(const std::optional<Shard> shard, parse_shard(given.shard));
  const TraceOptions options = with_output_names(given, shard);
  for (const auto& [name, value] :
       {std::pair{"--length", options.length}, {"--min-speed", options.min_speed}, {"--tolerance", options.tolerance}})
    if (!std::isfinite(value)) return Error{fmt::format("{}: expected a finite number", name)};
  const io::Format* format = io::find_writer(options.output.starts_with("/dev/") ? "stream.csv" : options.output, io::DataKind::curves);
  if (format == nullptr)
    return Error{options.output + ": expected an output that ends in " + io::writable_extensions(io::DataKind::curves)};
  if (shard && (!options.output.ends_with(".csv") || options.output.starts_with("/dev/")))
    return Error{options.output + ": with --shard, a file that ends in .csv was expected, which catena merge makes of the parts"};
  if (shard && options.lines == "streak")
    return Error{"--shard: streak lines may have several pieces; streamlines or path lines were expected"};
  for (const double time : options.times)
    if (!std::isfinite(time)) return Error{"--times: expected finite numbers"};
  if (options.lines != "stream" && options.kind == "line")
    return Error{"--kind line: fibres do not move particles; --lines stream was expected"};
  if (options.lines == "stream" && (!options.times.empty() || options.time_interpolation != "linear"))
    return Error{"--times and --time-interpolation: --lines path or --lines streak was expected with them"};
  CATENA_TRY(scene::Scene scene, scene_of(options));
  IoConflictChecker files(scene);
  if (!options.seeds.starts_with("{")) files.add_input(options.seeds);
  files.add_output("-o", options.output);
  if (shard) files.add_output("-o", part_path(options.output, *shard));
  files.add_output("--stats", options.stats);
  CATENA_CHECK(files.check());
  json::Node pattern;
  if (is_pattern(options.seeds)) {
    CATENA_TRY(pattern, pattern_of(options.seeds));
  }
  CATENA_TRY(const field::VectorFieldPtr field, vector_field(scene, options));

  const flow::Flow flow{field.get(), options.kind == "line", options.min_speed};
  const SeedShare share = shard ? SeedShare{shard->first_item(), shard->count} : SeedShare{};
  Timing timing;
  CATENA_TRY(const SeededLines lines, options.lines != "stream" ? trace_unsteady(options, pattern, flow, share, scene, timing)
                                      : is_pattern(options.seeds)
                                          ? timing.measure([&] { return trace_pattern(options, pattern, flow, share, scene); })
                                          : trace_table(options, flow, share, timing));
  const Curves& curves = lines.curves;
  std::map<std::string, int> ends;
  std::size_t knots = 0;
  for (const flow::CurvePtr& curve : curves) {
    knots += curve->knots().size();
    ++ends[flow::to_string(curve->first_end().termination)];
    ++ends[flow::to_string(curve->last_end().termination)];
  }

  std::optional<PartWriter> part;
  std::optional<OutputFile> whole;
  if (shard) {
    CATENA_TRY(PartWriter opened, PartWriter::open(options.output, *shard, "trace", run_key_of(options, files)));
    part.emplace(std::move(opened));
    write_line_part(*part, lines);
    part->end();
  } else {
    CATENA_TRY(OutputFile opened, OutputFile::open(options.output));
    whole.emplace(std::move(opened));
    format->write_curves(*whole, curves, *field);
  }
  OutputFile& out = shard ? part->file() : *whole;
  const double first_cpu_ms = timing.cpu_ms.front();
  if (options.stats.empty()) {
    CATENA_CHECK(out.commit());
  } else {
    CATENA_TRY(OutputFile stats, OutputFile::open(options.stats));
    stats.write(
        fmt::format("{{\n  \"lines\": {},\n  \"knots\": {},\n  \"trace_ms\": {:.3f},\n  \"trace_cpu_ms\": {:.3f},\n  "
                    "\"first_trace_cpu_ms\": {:.3f}\n}}\n",
                    curves.size(), knots, quantile(timing.wall_ms, 0.5), quantile(timing.cpu_ms, 0.5), first_cpu_ms));
    CATENA_CHECK(commit_all({&out, &stats}));
  }
  if (shard && curves.empty()) {
    fmt::print("shard {}: none of its seeds starts a line: the part is empty\n", shard->text());
    return Done{};
  }
  fmt::print("{} line{}, {} knots; ends:", curves.size(), curves.size() == 1 ? "" : "s", knots);
  for (const auto& [word, count] : ends) fmt::print(" {} {}", word, count);
  fmt::print("\n");
  return Done{};
}

}  // namespace

void add_trace(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<TraceOptions>();
  CLI::App* command =
      program.add_subcommand("trace", "traces streamlines, path lines or streak lines from seeds as curves parametrized by arc length");
  add_source(*command, "SOURCE", options->source, "scene (.json) or data file")->type_name("FILE")->required();
  command->add_option("--field", options->field, "vector field of the scene, or grid of the data file")->type_name("FIELD")->required();
  command
      ->add_option("--seeds", options->seeds,
                   "seeds: a table x,y,z (CSV), or a pattern as in a scene's \"seeds\", '{\"line\": ...}' or a .json file")
      ->type_name("SEEDS")
      ->required();
  command->add_option("-o,--output", options->output, "streamlines to write: .vtp or .csv")->type_name("LINES")->required();
  command->add_option("--length", options->length, "maximum arc length in each direction (default: 10 L)")
      ->type_name("LENGTH")
      ->check(number_above_zero());
  command
      ->add_option("--tolerance", options->tolerance,
                   "error of a step; above 1e-9, lines are traced in batches with one knot per step (default: 1e-10; for patterns 1e-7; "
                   "for path lines and streak lines 1e-11)")
      ->type_name("TOLERANCE")
      ->check(CLI::Range(0.0, 0.01));
  command
      ->add_option("--step", options->step,
                   "maximum step, in world units for a formula (default: 0.5; chosen from the error if the tolerance is at most 1e-9)")
      ->type_name("VOXELS")
      ->check(CLI::Range(0.01, 4.0));
  command->add_option("--time-step", options->time_step, "time step, counted from 0 (default: the scene's)")
      ->type_name("INDEX")
      ->check(CLI::Range(0, 1'000'000));
  command->add_option("--repeat", options->repeat, "number of repetitions for a table of seeds, for the medians of --stats (default: 1)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  command->add_option("--stats", options->stats, "statistics to write")->type_name("FILE.json");
  command
      ->add_option("--kind", options->kind, "vector: a direction v differs from -v; line: v and -v are the same direction, as for fibres")
      ->type_name("WORD")
      ->check(CLI::IsMember({"vector", "line"}))
      ->capture_default_str();
  command->add_option("--min-speed", options->min_speed, "speed at or below which a streamline ends (default: 0)")
      ->type_name("SPEED")
      ->check(number_at_least(0));
  command
      ->add_option("--lines", options->lines,
                   "stream: streamlines of one time step; path: ways of particles; streak: the particles that have passed a seed")
      ->type_name("WORD")
      ->check(CLI::IsMember({"stream", "path", "streak"}))
      ->capture_default_str();
  command
      ->add_option("--times", options->times,
                   "start and end of path lines (backward in time if the end is first) and streak lines (default: all time steps)")
      ->type_name("START END")
      ->expected(2);
  command->add_option("--time-interpolation", options->time_interpolation, "between time steps, of path lines and streak lines")
      ->type_name("WORD")
      ->check(CLI::IsMember({"linear", "cubic"}))
      ->capture_default_str();
  add_shard_option(*command, options->shard, "seeds");
  command->callback([&chosen, options] { chosen = [options] { return trace_lines(*options); }; });
}

}  // namespace catena::app
