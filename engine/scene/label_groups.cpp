// SPDX-License-Identifier: MIT
#include "engine/scene/label_groups.h"

#include <algorithm>
#include <functional>
#include <map>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::scene {
namespace {

char to_lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Returns whether a text matches a pattern, in which * stands for any letters; upper and lower case are equal.
bool matches(std::string_view text, std::string_view pattern) {
  std::size_t t = 0, p = 0, star = std::string_view::npos, after_star = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = t;
    } else if (p < pattern.size() && to_lower(pattern[p]) == to_lower(text[t])) {
      ++p, ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++after_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// Returns whether a request names a label: by its number, by a range "A-B" of numbers, or by a pattern of its name.
bool names_label(const std::string& request, double value, std::string_view name) {
  if (const auto number = parse_double(request)) return *number == value;
  const std::size_t dash = request.find('-', 1);
  if (dash != std::string::npos) {
    const auto lo = parse_double(request.substr(0, dash)), hi = parse_double(request.substr(dash + 1));
    if (lo && hi) return value >= *lo && value <= *hi;
  }
  return request == "*" || (!name.empty() && matches(name, request));
}

std::string_view name_in(const LabelTable& table, double value) {
  const auto row = std::ranges::find(table, value, &LabelRow::value);
  return row == table.end() ? std::string_view() : std::string_view(row->name);
}

}  // namespace

Result<std::vector<LabelGroup>> group_labels(std::span<const field::LabelCount> counts, const LabelTable& table,
                                             std::span<const LabelOpacity> requests) {
  std::map<double, double> opacities;  // by label
  for (const field::LabelCount& count : counts)
    if (count.value != 0) opacities[count.value] = 1;
  for (const LabelOpacity& request : requests) {
    bool found = false;
    for (auto& [value, opacity] : opacities)
      if (names_label(request.labels, value, name_in(table, value))) opacity = request.opacity, found = true;
    if (found) continue;
    std::vector<std::string_view> names;
    for (const auto& [value, opacity] : opacities)
      if (const std::string_view name = name_in(table, value); !name.empty()) names.push_back(name);
    return Error{one_line("the map has no label " + in_quotes(request.labels) +
                          "; a number, a range of numbers, or a name, in which * stands for any letters, was expected" +
                          suggestion(request.labels, names))};
  }
  std::map<double, std::vector<double>, std::greater<>> groups;
  for (const auto& [value, opacity] : opacities) groups[opacity].push_back(value);
  if (groups.size() > kMaxLabelGroups)
    return Error{"the labels have " + std::to_string(groups.size()) + " different opacities; at most " + std::to_string(kMaxLabelGroups) +
                 " were expected"};
  std::vector<LabelGroup> result;
  for (auto& [opacity, values] : groups) result.push_back({opacity, std::move(values)});
  return result;
}

}  // namespace catena::scene
