// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/ruler_angle.h"

#include <algorithm>

#include "engine/field/measure/profile.h"

namespace catena::app {

std::optional<RulerAngle> angle_between(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b) {
  const double reach = std::min(norm(a[1] - a[0]), norm(b[1] - b[0])) / 20;
  std::size_t end_a = 0, end_b = 0;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      if (norm(a[i] - b[j]) < norm(a[end_a] - b[end_b])) end_a = i, end_b = j;
  const bool shared = norm(a[end_a] - b[end_b]) < reach;
  const std::optional<double> angle = field::angle_deg(a[1 - end_a] - a[end_a], Vec3(0.0), b[1 - end_b] - b[end_b]);
  if (!angle) return std::nullopt;
  return RulerAngle{shared ? *angle : std::min(*angle, 180 - *angle), shared};
}

}  // namespace catena::app
