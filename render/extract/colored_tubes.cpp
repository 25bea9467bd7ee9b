// SPDX-License-Identifier: MIT
#include "render/extract/colored_tubes.h"

namespace catena::render {

std::vector<LinePart> add_colored_tubes(const TubeItem& tube, std::span<const double> values, const ColorTable& table,
                                        const Threshold& threshold, std::vector<TubeItem>& out) {
  const bool is_line = values.size() > 1;
  if (!is_line && !(values.empty() || is_within(threshold, values.front()))) return {};
  std::vector<LinePart> parts{{0, static_cast<double>(tube.points.size()) - 1}};
  if (!threshold.empty() && is_line) parts = line_parts_within(values, threshold);
  for (const LinePart& part : parts) {
    TubeItem piece = tube;
    const bool is_whole = part.first == 0 && part.last + 1 == static_cast<double>(values.size());
    std::vector<double> cut;
    if (!is_whole) {
      piece.points = entries_of<Vec3>(part, tube.points.list());
      cut = entries_of<double>(part, values);
    }
    const std::span<const double> shown = is_whole ? values : cut;
    std::vector<Color> colors;
    colors.reserve(shown.size());
    for (const double value : shown) colors.push_back(sample_color_table(table, value));
    piece.colors = std::move(colors);
    out.push_back(std::move(piece));
  }
  return parts;
}

}  // namespace catena::render
