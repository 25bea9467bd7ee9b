// SPDX-License-Identifier: MIT
#include "engine/scene/default_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/default_visualization.h"
#include "engine/scene/to_json.h"

namespace catena::scene {
namespace {

/// Returns whether the values only number the rows (each is the previous one + 1).
bool counts_rows(const std::vector<float>& values) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] - values[i - 1] != 1) return false;
  return true;
}

/// Returns the 1 to 99 percentile range if the tails would otherwise take a tenth of the color range or more (with fewer than 100 values
/// half of it, because their extremes are far apart by chance); otherwise nullopt: all values.
std::optional<std::array<double, 2>> range_without_tails(const std::vector<float>& values) {
  constexpr double kTail = 0.01;
  constexpr std::size_t kMany = 100;
  std::vector<float> sorted;
  const DisplayRange range = display_range(values);
  std::ranges::copy_if(values, std::back_inserter(sorted), [&](float v) { return range.contains(v); });
  std::ranges::sort(sorted);
  const double last = static_cast<double>(sorted.size()) - 1;
  if (!(last > 1)) return std::nullopt;
  const double lo = sorted[static_cast<std::size_t>(std::ceil(kTail * last))], hi = sorted[static_cast<std::size_t>((1 - kTail) * last)];
  const double full_range = static_cast<double>(sorted.back()) - sorted.front(), max_share = sorted.size() < kMany ? 0.5 : 0.9;
  if (!is_color_range(lo, hi) || hi - lo > max_share * full_range) return std::nullopt;
  const double digits = 2 - std::floor(std::log10(hi - lo)), factor = std::pow(10, std::fabs(digits));
  const auto rounded = [&](double v) { return digits > 0 ? std::round(v * factor) / factor : std::round(v / factor) * factor; };
  return std::array{rounded(lo), rounded(hi)};
}

}  // namespace

Result<std::string> default_points_members(const curves::PointSet& set, const std::string& file, const NamedColors& colors,
                                           std::string& note) {
  const curves::PointValues* column = nullptr;
  for (const curves::PointValues& one : set.values) {
    const auto differs = [&](float v) { return std::isfinite(v) && v != one.values.front(); };
    if (column == nullptr && one.name != "radius" && !counts_rows(one.values) && std::ranges::any_of(one.values, differs)) column = &one;
  }
  if (column == nullptr && !colors.is_default())
    return Error{one_line(set.name + ": the table has no column of values, expected one for the colour map")};
  const auto range = column == nullptr || colors.range ? colors.range : range_without_tails(column->values);
  const bool cut = range && !colors.range;
  std::string coloured;
  if (column != nullptr) coloured = ", coloured by " + in_quotes(column->name);
  if (cut) coloured += fmt::format(" from {} to {}, the 1st to 99th percentiles", to_json((*range)[0]), to_json((*range)[1]));
  if (const std::string outlier_text = column != nullptr ? outlier_note(display_range(column->values)) : std::string();
      !outlier_text.empty())
    coloured += "; " + outlier_text;
  if (set.robust_bounds.outliers > 0) coloured += fmt::format("; {} distant points outside the initial view", set.robust_bounds.outliers);
  note = fmt::format("is a table of points (columns x, y, z): {} points, shown as spheres{}{}", set.points.size(), coloured,
                     set.note.empty() ? "" : "; " + set.note);
  std::string text = "  \"points\": [{\"name\": \"points\", \"file\": " + file;
  if (column != nullptr) {
    text += ", \"color_by\": {\"value\": " + json::serialize_string(column->name);
    NamedColors specified = colors;
    specified.range = range;
    if (specified.map.empty()) specified.map = kDefaultVolumeColorMap;
    text += color_members(specified) + "}";
  }
  return text + "}]" +
         (column != nullptr ? ",\n  \"scalar_bars\": [{\"points\": 0" +
                                  (cut ? ", \"title\": " + json::serialize_string(column->name + ", 1st to 99th percentiles") : "") + "}]"
                            : "");
}

}  // namespace catena::scene
