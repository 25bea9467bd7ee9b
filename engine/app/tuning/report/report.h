// SPDX-License-Identifier: MIT
/// Report of one run of `catena tradeoff SCENE`: its curves and their origin. One JSON file holds all of it; an HTML page is made of one
/// report or two.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/tuning/measure/curve.h"
#include "engine/base/result.h"

namespace catena::app::tuning {

/// The result of one run.
struct Report {
  std::string source;                                         ///< File name of the scene or data file, without its folder.
  std::vector<std::pair<std::string, std::string>> metadata;  ///< Version, processor, GPU, build, date, effort ..., in order.
  std::vector<Curve> curves;
  std::vector<std::string> skipped;  ///< Measurements that were skipped, a sentence each.
};

/// Returns the report as JSON; read_report() reads it back.
std::string to_json(const Report& report);
/// Reads a report. An Error, "FILE:LINE: problem; what was expected", if the file cannot be read or is not a valid report.
Result<Report> read_report(const std::string& path);
/// As above, of a text; `file`: name for messages.
Result<Report> parse_report(std::string_view text, const std::string& file);
/// Returns whether the file is JSON and identifies itself as a report; false if it cannot be read.
bool is_report(const std::string& path);

/// Returns the curve with that id; null if there is none or `report` is null.
const Curve* find_curve(const Report* report, const std::string& id);

/// Returns the points of the curve as a CSV table.
std::string to_csv(const Curve& curve);

/// Returns one HTML page that opens without network access. `plots`: SVG texts per curve, possibly none. `other`: report to compare with,
/// shown next to the first; may be null.
std::string to_html(const Report& report, const Report* other, const std::vector<std::vector<std::string>>& plots);

/// A gnuplot script that draws the plots of a curve one after the other into `files` (SVG): error against each measured cost, or the cost
/// alone where no error was measured.
struct PlotScript {
  std::string text;
  std::vector<std::string> files;
};
/// Returns the script for `curve`, with `other` (may be null) drawn for comparison; file names start with `prefix`.
PlotScript plot_script(const Curve& curve, const Curve* other, const std::string& prefix);

}  // namespace catena::app::tuning
