// SPDX-License-Identifier: MIT
#include "engine/geometry/curves/robust_bounds.h"

#include <algorithm>
#include <vector>

namespace catena::curves {
namespace {

constexpr std::size_t kSampledPoints = 1 << 17, kFew = 20;
constexpr double kShareAtEnds = 0.05, kFence = 2;

}  // namespace

RobustBounds compute_robust_bounds(std::span<const glm::vec3> points) {
  RobustBounds core;
  if (points.empty()) return core;
  const std::size_t step = 1 + points.size() / kSampledPoints;
  Vec3 low(0.0), high(0.0);
  std::vector<float> values;
  for (int a = 0; a < 3; ++a) {
    values.clear();
    for (std::size_t i = 0; i < points.size(); i += step) values.push_back(points[i][a]);
    const auto at = [&](double fraction) {
      const auto k = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), values.begin() + k, values.end());
      return static_cast<double>(values[static_cast<std::size_t>(k)]);
    };
    low[a] = at(kShareAtEnds);
    high[a] = at(1 - kShareAtEnds);
  }
  // with too few points, or nearly all at one position, no point counts as an outlier
  const double widest = max_abs(high - low),
               margin = widest > 0 && points.size() >= kFew ? kFence * widest : std::numeric_limits<double>::infinity();
  for (const glm::vec3& p : points) {
    bool within = true;
    for (int a = 0; a < 3; ++a) within = within && p[a] >= low[a] - margin && p[a] <= high[a] + margin;
    if (within)
      core.box.extend(Vec3(p));
    else
      ++core.outliers;
  }
  return core;
}

}  // namespace catena::curves
