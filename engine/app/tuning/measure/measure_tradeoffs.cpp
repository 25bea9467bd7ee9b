// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/measure_tradeoffs.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "engine/app/batch/run_key.h"
#include "engine/app/batch/tradeoff_parts.h"
#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/tuning/measure/pareto_choice.h"
#include "engine/app/tuning/measure/registry.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "engine/app/tuning/report/report_folder.h"
#include "engine/app/tuning/report/system_info.h"
#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/scene/prepare.h"

namespace catena::app {

namespace {

using tuning::Curve;
using tuning::Report;
using tuning::Workload;

/// Returns an Error if an output is also an input.
Outcome check_files(const MeasureOptions& options, IoConflictChecker files) {
  files.add_input(options.compare);
  files.add_input(options.probe);
  if (std::filesystem::is_directory(options.output))
    for (const char* name : {"report.html", "tradeoff.json"}) files.add_output("-o", options.output + "/" + name);
  return files.check();
}

/// The measurements that the options ask for, in the order of the registry.
std::vector<tuning::Measurement> wanted_measurements(const MeasureOptions& options) {
  std::vector<tuning::Measurement> wanted;
  for (const tuning::Measurement& m : tuning::measurements())
    if (options.only.empty() || std::ranges::find(options.only, m.name) != options.only.end()) wanted.push_back(m);
  return wanted;
}

Result<scene::Scene> open_workload_scene(const MeasureOptions& options) {
  return open_scene(options.source, options.fields, {}, options.grid);
}

/// Runs the measurements that apply to the scene, of the given items of wanted_measurements().
Result<MeasuredReport> measure(const MeasureOptions& options, scene::Scene scene, const std::vector<std::size_t>& items) {
  CATENA_CHECK(scene::prepare(scene));
  print_scene_notes(scene);
  Workload workload{std::move(scene), tuning::select_effort(options.effort), {}, {}, 1000, {}, {}};
  CATENA_CHECK(tuning::add_haptics(workload, options.probe));
  const auto has_part = [&](const tuning::Measurement& m) {
    const std::string_view part = m.category;
    return part == "data" || (part == "hand" ? workload.program != nullptr : workload.rendering != nullptr);
  };
  const std::vector<tuning::Measurement> wanted = wanted_measurements(options);
  const tuning::Effort whole = workload.effort;
  const std::int64_t began = now_ns();
  MeasuredReport measured;
  Report& report = measured.report;
  report.source = std::filesystem::path(options.source).filename().string();
  report.metadata = system_info();
  const bool sees = std::ranges::any_of(items, [&](std::size_t item) { return std::string_view(wanted[item].category) == "eye"; });
  constexpr double kBefore = 3;  // in units of one measurement: the effort of preparing the renderer
  ProgressLine progress("tradeoff", static_cast<double>(items.size()) + kBefore);
  double done = 0;
  if (sees) {
    CATENA_CHECK(tuning::add_rendering(workload));
    if (workload.rendering) {
      report.metadata.emplace_back("GPU",
                                   workload.rendering->renderer->stats().device + ", " + workload.rendering->renderer->stats().driver);
      report.metadata.emplace_back("images", fmt::format("{}x{}", workload.effort.width, workload.effort.height));
    }
  }
  progress.update(done += kBefore);
  report.metadata.emplace_back("effort", workload.effort.name);
  if (workload.program)
    report.metadata.emplace_back(
        "hand", fmt::format("{}, {:g} s at {:g} Hz", workload.motion.description, workload.motion.seconds, workload.rate_hz));
  measured.skipped_items.assign(workload.skipped.size(), -1);
  for (const std::size_t item : items) {
    const tuning::Measurement& m = wanted[item];
    if (has_part(m)) {
      progress.update(done, m.name);
      workload.effort = tuning::reduce_if_late(whole, 1e-3 * ms_since(began), (done - kBefore) / static_cast<double>(items.size()));
      auto curves = m.measure(workload);
      if (!curves) workload.skipped.push_back(std::string(m.name) + ": " + curves.error().message + ".");
      if (curves)
        for (Curve& curve : *curves) {
          curve.category = m.category;
          if (!curve.error_name.empty() && curve.choice_reason.empty()) tuning::choose_setting(curve);
          report.curves.push_back(std::move(curve));
          measured.curve_items.push_back(static_cast<int>(item));
        }
      measured.skipped_items.resize(workload.skipped.size(), static_cast<int>(item));
    }
    progress.update(++done);
  }
  report.skipped = std::move(workload.skipped);
  return measured;
}

/// Measures all that the options ask for.
Result<Report> measure_all(const MeasureOptions& options) {
  CATENA_TRY(scene::Scene scene, open_workload_scene(options));
  CATENA_CHECK(check_files(options, IoConflictChecker(scene)));
  CATENA_TRY(MeasuredReport measured, measure(options, std::move(scene), Shard{}.items(wanted_measurements(options).size())));
  if (!measured.report.curves.empty()) return std::move(measured.report);
  const std::vector<std::string>& skipped = measured.report.skipped;
  return Error{options.source +
               ": there is nothing to measure: " + (skipped.empty() ? "the scene has no items of this kind." : skipped.front())};
}

/// Runs the measurements of a shard and writes them as a part into the output folder, which other shards may create at the same time.
Outcome measure_shard(const MeasureOptions& options, const Shard& shard) {
  if (!options.compare.empty())
    return Error{"--compare: excludes --shard; after catena merge, catena tradeoff " + options.output +
                 "/tradeoff.json --compare makes the page"};
  CATENA_TRY(scene::Scene scene, open_workload_scene(options));
  IoConflictChecker files(scene);
  CATENA_CHECK(check_files(options, files));
  RunKey key("tradeoff");
  key.add(options.grid).add(options.effort);
  for (const std::string& name : options.only) key.add(name);
  for (const std::string& field : options.fields) key.add(field.substr(0, field.find('=')));
  files.add_input(options.probe);
  key.add_files(files.inputs());

  std::error_code code;
  std::filesystem::create_directories(options.output, code);
  if (code) return system_error(options.output + ": cannot create the folder", code.value());
  CATENA_TRY(PartWriter part, PartWriter::open(tradeoff_part_base(options.output), shard, "tradeoff", key.text()));
  const std::size_t count = wanted_measurements(options).size();
  const std::vector<std::size_t> items = shard.items(count);
  CATENA_TRY(const MeasuredReport measured, measure(options, std::move(scene), items));
  write_tradeoff_part(part, measured);
  part.end();
  CATENA_CHECK(part.file().commit());
  if (items.empty())
    fmt::print("{}\n", empty_shard_message(shard, count, "measurements"));
  else
    fmt::print("{}: {} curve{} of {} of {} measurements\n", sanitize_for_terminal(part_path(tradeoff_part_base(options.output), shard)),
               measured.report.curves.size(), measured.report.curves.size() == 1 ? "" : "s", items.size(), count);
  return Done{};
}

}  // namespace

std::vector<std::string> measurement_names() {
  std::vector<std::string> names;
  for (const tuning::Measurement& m : tuning::measurements()) names.emplace_back(m.name);
  return names;
}

Outcome measure_tradeoffs(const MeasureOptions& options) {
  CATENA_TRY(const std::optional<Shard> shard, parse_shard(options.shard));
  const bool again = tuning::is_report(options.source);
  if (shard && again)
    return Error{options.source + ": is a report, of which nothing is measured; with --shard, a scene or a data file was expected"};
  if (shard) return measure_shard(options, *shard);
  std::optional<Report> other;
  if (!options.compare.empty()) {
    CATENA_TRY(other, tuning::read_report(options.compare));
  }
  if (again) {
    IoConflictChecker files;
    files.add_input(options.source);
    CATENA_CHECK(check_files(options, std::move(files)));
  }
  CATENA_TRY(ResultsDir folder, ResultsDir::open(options.output));
  CATENA_TRY(const Report report, again ? tuning::read_report(options.source) : measure_all(options));
  CATENA_CHECK(tuning::write_report(folder, report, other ? &*other : nullptr));
  tuning::print_report(folder, options.output, report);
  return Done{};
}

}  // namespace catena::app
