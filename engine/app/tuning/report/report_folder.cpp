// SPDX-License-Identifier: MIT
#include "engine/app/tuning/report/report_folder.h"

#include <fmt/core.h>

#include "engine/base/text.h"

namespace catena::app::tuning {

Outcome write_report(ResultsDir& folder, const Report& report, const Report* other) {
  std::vector<std::vector<std::string>> plots;
  for (const Curve& curve : report.curves) {
    const PlotScript script = plot_script(curve, find_curve(other, curve.id), "plot");
    CATENA_TRY(std::vector<std::string> drawn, folder.draw_svg(script.text, script.files));
    plots.push_back(std::move(drawn));
  }
  CATENA_CHECK(folder.add("report.html", to_html(report, other, plots)));
  for (const Curve& curve : report.curves) CATENA_CHECK(folder.add(curve.id + ".csv", to_csv(curve)));
  CATENA_CHECK(folder.add("tradeoff.json", to_json(report)));
  return folder.commit();
}

void print_report(const ResultsDir& folder, const std::string& path, const Report& report) {
  for (const Curve& curve : report.curves)
    if (curve.chosen >= 0)
      fmt::print("{}: {}. {}\n", sanitize_for_terminal(curve.title), sanitize_for_terminal(curve.points[curve.chosen].setting),
                 sanitize_for_terminal(curve.choice_reason));
  for (const std::string& sentence : report.skipped) fmt::print("not measured: {}\n", sanitize_for_terminal(sentence));
  fmt::print("{}:", sanitize_for_terminal(path));
  for (const std::string& name : folder.file_names()) fmt::print(" {}", name);
  fmt::print("\n");
}

}  // namespace catena::app::tuning
