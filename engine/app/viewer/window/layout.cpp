// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/layout.h"

#include <algorithm>
#include <cmath>

namespace catena::app {

Area compute_image_area(double width, double height, const Insets& edges) {
  const double x = std::clamp(edges.left, 0.0, std::max(0.0, width - 1)), y = std::clamp(edges.top, 0.0, std::max(0.0, height - 1));
  return {x, y, std::max(1.0, width - x), std::max(1.0, height - y - std::max(0.0, edges.bottom))};
}

std::array<std::uint32_t, 4> to_pixel_rect(const Area& area, double width, double height, std::uint32_t frame_width,
                                           std::uint32_t frame_height) {
  const auto span = [](double from, double length, double whole, std::uint32_t pixels) {
    const double scale = whole > 0 ? pixels / whole : 1;
    const double last = pixels > 0 ? pixels - 1.0 : 0;
    const double first = std::clamp(std::round(from * scale), 0.0, last);
    const double end = std::clamp(std::round((from + length) * scale), first + 1, std::max(first + 1, double(pixels)));
    return std::array<std::uint32_t, 2>{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end)};
  };
  const auto [x0, x1] = span(area.x, area.width, width, frame_width);
  const auto [y0, y1] = span(area.y, area.height, height, frame_height);
  return {x0, y0, x1, y1};
}

}  // namespace catena::app
