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

/// Whether the values only number the rows (each is the previous one + 1).
bool counts_rows(const std::vector<float>& values) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] - values[i - 1] != 1) return false;
  return true;
}

/// The 1 to 99 percentile range if the tails would otherwise take a tenth of the color range or more (with fewer than 100 values half of
/// it, because their extremes are far apart by chance); otherwise nullopt: all values.
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
  const double whole = static_cast<double>(sorted.back()) - sorted.front(), most = sorted.size() < kMany ? 0.5 : 0.9;
  if (!is_color_range(lo, hi) || hi - lo > most * whole) return std::nullopt;
  const double digits = 2 - std::floor(std::log10(hi - lo)), factor = std::pow(10, std::fabs(digits));
  const auto rounded = [&](double v) { return digits > 0 ? std::round(v * factor) / factor : std::round(v / factor) * factor; };
  return std::array{rounded(lo), rounded(hi)};
}

}  // namespace

Result<std::string> default_points_members(const curves::PointSet& set, const std::string& file, const NamedColors& colors,
                                           std::string& note) {
  const curves::PointValues* shown = nullptr;
  for (const curves::PointValues& one : set.values) {
    const auto differs = [&](float v) { return std::isfinite(v) && v != one.values.front(); };
    if (shown == nullptr && one.name != "radius" && !counts_rows(one.values) && std::ranges::any_of(one.values, differs)) shown = &one;
  }
  if (shown == nullptr && !colors.is_default())
    return Error{one_line(set.name + ": the table has no column of values to colour; a colour map goes with one")};
  const auto range = shown == nullptr || colors.range ? colors.range : range_without_tails(shown->values);
  const bool cut = range && !colors.range;
  std::string coloured;
  if (shown != nullptr) coloured = ", coloured by " + in_quotes(shown->name);
  if (cut) coloured += fmt::format(" from {} to {}, its 1 to 99 percentile", to_json((*range)[0]), to_json((*range)[1]));
  if (const std::string beyond = shown != nullptr ? outlier_note(display_range(shown->values)) : std::string(); !beyond.empty())
    coloured += "; " + beyond;
  if (set.robust_bounds.outliers > 0)
    coloured += fmt::format("; {} far from the others outside of the first view", set.robust_bounds.outliers);
  note = fmt::format("a table of points (it has columns x, y, z): {} of them as balls{}{}", set.points.size(), coloured,
                     set.note.empty() ? "" : "; " + set.note);
  std::string text = "  \"points\": [{\"name\": \"points\", \"file\": " + file;
  if (shown != nullptr) {
    text += ", \"color_by\": {\"value\": " + json::serialize_string(shown->name);
    NamedColors stated = colors;
    stated.range = range;
    text += color_members(stated) + "}";
  }
  return text + "}]" +
         (shown != nullptr ? ",\n  \"scalar_bars\": [{\"points\": 0" +
                                 (cut ? ", \"title\": " + json::serialize_string(shown->name + ", 1 to 99 percentile") : "") + "}]"
                           : "");
}

}  // namespace catena::scene
