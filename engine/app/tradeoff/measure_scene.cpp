#include "engine/app/tradeoff/measure_scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "engine/app/command.h"
#include "engine/app/report/machine.h"
#include "engine/app/run_files.h"
#include "engine/app/tradeoff/measure/choice.h"
#include "engine/app/tradeoff/measure/eye/eye.h"
#include "engine/app/tradeoff/measure/registry.h"
#include "engine/app/tradeoff/report/report.h"
#include "engine/base/clock.h"
#include "engine/base/tell.h"
#include "engine/base/text.h"
#include "engine/scene/prepare.h"

namespace catena::app {

namespace {

using tradeoff::Curve;
using tradeoff::Report;
using tradeoff::Subject;

/// No output is one of the inputs.
Outcome check_files(const MeasureOptions& options, RunFiles files) {
  files.reads(options.compare);
  files.reads(options.probe);
  if (std::filesystem::is_directory(options.output))
    for (const char* name : {"report.html", "tradeoff.json"}) files.writes("-o", options.output + "/" + name);
  return files.check();
}

/// All that the scene has, in the order of the registry.
Result<Report> measure(const MeasureOptions& options) {
  CATENA_TRY(scene::Scene scene, open_scene(options.source, options.fields, {}, options.grid));
  CATENA_CHECK(check_files(options, RunFiles(scene)));
  CATENA_CHECK(scene::prepare(scene));
  tell_notes(scene);
  Subject subject{std::move(scene), tradeoff::effort(options.quick, options.thorough), {}, {}, 1000, {}, {}};
  CATENA_CHECK(tradeoff::add_hand(subject, options.probe));
  const auto wanted = [&](const tradeoff::Measurement& m) {
    return options.only.empty() || std::find(options.only.begin(), options.only.end(), m.name) != options.only.end();
  };
  const auto has_part = [&](const tradeoff::Measurement& m) {
    const std::string_view part = m.part;
    return part == "data" || (part == "hand" ? subject.program != nullptr : subject.eye != nullptr);
  };
  const auto all = tradeoff::measurements();
  const tradeoff::Effort whole = subject.effort;
  const std::int64_t began = now_ns();
  Report report;
  report.source = std::filesystem::path(options.source).filename().string();
  report.about = about_this_machine();
  const bool sees = std::any_of(all.begin(), all.end(), [&](const auto& m) { return wanted(m) && std::string_view(m.part) == "eye"; });
  constexpr double kBefore = 3;  // of what a measurement takes: to open the eye
  Progress progress("tradeoff", static_cast<double>(all.size()) + kBefore);
  double done = 0;
  if (sees) {
    CATENA_CHECK(tradeoff::open_eye(subject));
    if (subject.eye) {
      report.about.emplace_back("GPU", subject.eye->renderer->stats().device + ", " + subject.eye->renderer->stats().driver);
      report.about.emplace_back("pictures", fmt::format("{}x{}", subject.effort.width, subject.effort.height));
    }
  }
  progress.at(done += kBefore);
  report.about.emplace_back("effort", subject.effort.word);
  if (subject.program)
    report.about.emplace_back("hand", fmt::format("{}, {:g} s at {:g} Hz", subject.motion.words, subject.motion.seconds, subject.rate_hz));
  for (const tradeoff::Measurement& m : all) {
    if (wanted(m) && has_part(m)) {
      progress.at(done, m.name);
      subject.effort = tradeoff::in_time(whole, 1e-3 * ms_since(began), (done - kBefore) / static_cast<double>(all.size()));
      auto curves = m.measure(subject);
      if (!curves) subject.left_out.push_back(std::string(m.name) + ": " + curves.error().message + ".");
      if (curves)
        for (Curve& curve : *curves) {
          curve.part = m.part;
          if (!curve.error_name.empty() && curve.why.empty()) tradeoff::choose(curve);
          report.curves.push_back(std::move(curve));
        }
    }
    progress.at(++done);
  }
  report.left_out = std::move(subject.left_out);
  if (!report.curves.empty()) return report;
  const std::string why = report.left_out.empty() ? "the scene has nothing of that kind." : report.left_out.front();
  return Error{options.source + ": there is nothing to measure: " + why};
}

}  // namespace

std::vector<std::string> measurement_names() {
  std::vector<std::string> names;
  for (const tradeoff::Measurement& m : tradeoff::measurements()) names.emplace_back(m.name);
  return names;
}

Outcome measure_scene(const MeasureOptions& options) {
  if (options.quick && options.thorough) return Error{"--quick goes without --thorough"};
  std::optional<Report> other;
  if (!options.compare.empty()) {
    CATENA_TRY(other, tradeoff::read_report(options.compare));
  }
  const bool again = tradeoff::is_report(options.source);
  if (again) {
    RunFiles files;
    files.reads(options.source);
    CATENA_CHECK(check_files(options, std::move(files)));
  }
  CATENA_TRY(ResultFolder folder, ResultFolder::open(options.output));
  CATENA_TRY(const Report report, again ? tradeoff::read_report(options.source) : measure(options));
  std::vector<std::vector<std::string>> plots;
  for (const Curve& curve : report.curves) {
    const tradeoff::PlotScript script = tradeoff::plot_script(curve, tradeoff::curve_of(other ? &*other : nullptr, curve.id), "plot");
    CATENA_TRY(std::vector<std::string> drawn, folder.draw(script.text, script.files));
    plots.push_back(std::move(drawn));
  }
  CATENA_CHECK(folder.add("report.html", tradeoff::to_html(report, other ? &*other : nullptr, plots)));
  for (const Curve& curve : report.curves) CATENA_CHECK(folder.add(curve.id + ".csv", tradeoff::to_csv(curve)));
  CATENA_CHECK(folder.add("tradeoff.json", tradeoff::to_json(report)));
  CATENA_CHECK(folder.commit());
  for (const Curve& curve : report.curves)
    if (curve.chosen >= 0)
      fmt::print("{}: {}. {}\n", printable(curve.title), printable(curve.points[curve.chosen].setting), printable(curve.why));
  for (const std::string& sentence : report.left_out) fmt::print("left out: {}\n", printable(sentence));
  fmt::print("{}:", printable(options.output));
  for (const std::string& name : folder.names()) fmt::print(" {}", name);
  fmt::print("\n");
  return Done{};
}

}  // namespace catena::app
