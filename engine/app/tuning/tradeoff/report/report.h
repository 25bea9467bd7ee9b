/// A run of `catena tradeoff SCENE`: its curves and where they come from. One file of JSON holds all of it; the page is made of one or two.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/tuning/tradeoff/measure/curve.h"
#include "engine/base/result.h"

namespace catena::app::tradeoff {

struct Report {
  std::string source;                                         ///< the scene's or data file's name, without its folder
  std::vector<std::pair<std::string, std::string>> metadata;  ///< version, processor, GPU, build, date, effort ..., in order
  std::vector<Curve> curves;
  std::vector<std::string> skipped;  ///< a sentence each
};

std::string to_json(const Report& report);
/// Error: FILE:LINE: what; what was expected.
Result<Report> read_report(const std::string& path);
/// Whether a JSON file says that it is one; false also where it cannot be read.
bool is_report(const std::string& path);

/// Of that id; null where there is none, or no report.
const Curve* find_curve(const Report* report, const std::string& id);

std::string to_csv(const Curve& curve);

/// One page that opens without a network. `plots`: SVG, none or more a curve. `other`: beside the first.
std::string to_html(const Report& report, const Report* other, const std::vector<std::vector<std::string>>& plots);

/// The gnuplot script of a curve's plots, one after the other into `files` (SVG): error against each cost that was measured, or the cost
/// alone where there is no error.
struct PlotScript {
  std::string text;
  std::vector<std::string> files;
};
PlotScript plot_script(const Curve& curve, const Curve* other, const std::string& prefix);

}  // namespace catena::app::tradeoff
