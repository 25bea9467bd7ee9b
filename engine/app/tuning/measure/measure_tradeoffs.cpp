// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/measure_tradeoffs.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/tuning/measure/pareto_choice.h"
#include "engine/app/tuning/measure/registry.h"
#include "engine/app/tuning/measure/rendering/render_workload.h"
#include "engine/app/tuning/report/report.h"
#include "engine/app/tuning/report/system_info.h"
#include "engine/base/clock.h"
#include "engine/base/console.h"
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

/// Runs all measurements that apply to the scene, in the order of the registry.
Result<Report> measure(const MeasureOptions& options) {
  CATENA_TRY(scene::Scene scene, open_scene(options.source, options.fields, {}, options.grid));
  CATENA_CHECK(check_files(options, IoConflictChecker(scene)));
  CATENA_CHECK(scene::prepare(scene));
  print_scene_notes(scene);
  Workload workload{std::move(scene), tuning::select_effort(options.effort), {}, {}, 1000, {}, {}};
  CATENA_CHECK(tuning::add_haptics(workload, options.probe));
  const auto wanted = [&](const tuning::Measurement& m) {
    return options.only.empty() || std::find(options.only.begin(), options.only.end(), m.name) != options.only.end();
  };
  const auto has_part = [&](const tuning::Measurement& m) {
    const std::string_view part = m.category;
    return part == "data" || (part == "hand" ? workload.program != nullptr : workload.rendering != nullptr);
  };
  const auto all = tuning::measurements();
  const tuning::Effort whole = workload.effort;
  const std::int64_t began = now_ns();
  Report report;
  report.source = std::filesystem::path(options.source).filename().string();
  report.metadata = system_info();
  const bool sees = std::any_of(all.begin(), all.end(), [&](const auto& m) { return wanted(m) && std::string_view(m.category) == "eye"; });
  constexpr double kBefore = 3;  // in units of one measurement: the effort of preparing the renderer
  ProgressLine progress("tradeoff", static_cast<double>(all.size()) + kBefore);
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
  for (const tuning::Measurement& m : all) {
    if (wanted(m) && has_part(m)) {
      progress.update(done, m.name);
      workload.effort = tuning::reduce_if_late(whole, 1e-3 * ms_since(began), (done - kBefore) / static_cast<double>(all.size()));
      auto curves = m.measure(workload);
      if (!curves) workload.skipped.push_back(std::string(m.name) + ": " + curves.error().message + ".");
      if (curves)
        for (Curve& curve : *curves) {
          curve.category = m.category;
          if (!curve.error_name.empty() && curve.choice_reason.empty()) tuning::choose_setting(curve);
          report.curves.push_back(std::move(curve));
        }
    }
    progress.update(++done);
  }
  report.skipped = std::move(workload.skipped);
  if (!report.curves.empty()) return report;
  const std::string why = report.skipped.empty() ? "the scene has no items of this kind." : report.skipped.front();
  return Error{options.source + ": there is nothing to measure: " + why};
}

}  // namespace

std::vector<std::string> measurement_names() {
  std::vector<std::string> names;
  for (const tuning::Measurement& m : tuning::measurements()) names.emplace_back(m.name);
  return names;
}

Outcome measure_tradeoffs(const MeasureOptions& options) {
  std::optional<Report> other;
  if (!options.compare.empty()) {
    CATENA_TRY(other, tuning::read_report(options.compare));
  }
  const bool again = tuning::is_report(options.source);
  if (again) {
    IoConflictChecker files;
    files.add_input(options.source);
    CATENA_CHECK(check_files(options, std::move(files)));
  }
  CATENA_TRY(ResultsDir folder, ResultsDir::open(options.output));
  CATENA_TRY(const Report report, again ? tuning::read_report(options.source) : measure(options));
  std::vector<std::vector<std::string>> plots;
  for (const Curve& curve : report.curves) {
    const tuning::PlotScript script = tuning::plot_script(curve, tuning::find_curve(other ? &*other : nullptr, curve.id), "plot");
    CATENA_TRY(std::vector<std::string> drawn, folder.draw_svg(script.text, script.files));
    plots.push_back(std::move(drawn));
  }
  CATENA_CHECK(folder.add("report.html", tuning::to_html(report, other ? &*other : nullptr, plots)));
  for (const Curve& curve : report.curves) CATENA_CHECK(folder.add(curve.id + ".csv", tuning::to_csv(curve)));
  CATENA_CHECK(folder.add("tradeoff.json", tuning::to_json(report)));
  CATENA_CHECK(folder.commit());
  for (const Curve& curve : report.curves)
    if (curve.chosen >= 0)
      fmt::print("{}: {}. {}\n", sanitize_for_terminal(curve.title), sanitize_for_terminal(curve.points[curve.chosen].setting),
                 sanitize_for_terminal(curve.choice_reason));
  for (const std::string& sentence : report.skipped) fmt::print("not measured: {}\n", sanitize_for_terminal(sentence));
  fmt::print("{}:", sanitize_for_terminal(options.output));
  for (const std::string& name : folder.file_names()) fmt::print(" {}", name);
  fmt::print("\n");
  return Done{};
}

}  // namespace catena::app
