// SPDX-License-Identifier: MIT
#include "engine/base/camera_limits.h"

#include <algorithm>

#include "engine/base/numbers.h"

namespace catena {

namespace {
// smallest distance of position and target, as a fraction of the largest coordinate: the view direction keeps four digits
constexpr double kMinShare = 1e-12;
}  // namespace

std::string validate_view(const Vec3& position, const Vec3& target) {
  const double size = std::max(max_abs(position), max_abs(target));
  if (!is_finite(position) || !is_finite(target) || size > kMaxCameraCoordinate)
    return "the position or the target is too far away; numbers of at most " + to_text(kMaxCameraCoordinate) + " in size were expected";
  const double distance = norm(target - position);
  if (!(distance >= kMinOrthoHeight) || distance < kMinShare * size)
    return "the target is at the position, or too near to it; two different points were expected";
  return {};
}

std::string validate_fovy(double fovy_deg) {
  if (fovy_deg >= kMinFovyDeg && fovy_deg <= kMaxFovyDeg) return {};
  return "is " + to_text(fovy_deg) + "; degrees between 0 and 180 (" + to_text(kMinFovyDeg) + " to " + to_text(kMaxFovyDeg) +
         ") were expected";
}

}  // namespace catena
