#include "engine/base/eye_limits.h"

#include <algorithm>

#include "engine/base/numbers.h"

namespace catena {

namespace {
constexpr double kLeastShare = 1e-12;  // of the coordinates: the direction of view has four digits then
}

std::string eye_problem(const Vec3& position, const Vec3& target) {
  const double size = std::max(max_abs(position), max_abs(target));
  if (!is_finite(position) || !is_finite(target) || size > kMaxEyeCoordinate)
    return "the position or the target is too far away; numbers of at most " + to_text(kMaxEyeCoordinate) + " in size were expected";
  const double distance = norm(target - position);
  if (!(distance >= kLeastEyeHeight) || distance < kLeastShare * size)
    return "the target is at the position, or too near to it; two different points were expected";
  return {};
}

std::string fovy_problem(double fovy_deg) {
  if (fovy_deg >= kLeastFovyDeg && fovy_deg <= kMaxFovyDeg) return {};
  return "is " + to_text(fovy_deg) + "; degrees between 0 and 180 (" + to_text(kLeastFovyDeg) + " to " + to_text(kMaxFovyDeg) +
         ") were expected";
}

}  // namespace catena
