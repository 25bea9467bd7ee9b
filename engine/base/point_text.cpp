// SPDX-License-Identifier: MIT
#include "engine/base/point_text.h"

#include <algorithm>
#include <cmath>

#include "engine/base/numbers.h"

namespace catena {

std::optional<std::vector<Vec3>> parse_points(std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  std::size_t at = 0;
  for (std::size_t n = 0; n < 3 * count; ++n) {
    const std::size_t end = n + 1 == 3 * count ? text.size() : text.find(n % 3 == 2 ? ':' : ',', at);
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = parse_double(text.substr(at, end - at));
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
    at = std::min(end + 1, text.size());
  }
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < count; ++n) points.emplace_back(numbers[3 * n], numbers[3 * n + 1], numbers[3 * n + 2]);
  return points;
}

}  // namespace catena
