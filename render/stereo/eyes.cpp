#include "render/stereo/eyes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/assert.h"
#include "render/frame/camera.h"

namespace catena::render {
namespace {

View perspective_eye(const View& centre, const Camera& axes, double aspect, double offset, double zero_parallax) {
  View eye = centre;
  eye.position += offset * axes.right;
  eye.target += offset * axes.right;
  const double half_width = aspect * std::tan(0.5 * centre.fovy_deg * std::numbers::pi / 180);
  const double shift = std::clamp(offset / (zero_parallax * half_width), -kMaxShift, kMaxShift);
  eye.window.left -= shift;
  eye.window.right -= shift;
  return eye;
}

View orthographic_eye(const View& centre, const Camera& axes, double aspect, double offset, double zero_parallax) {
  const double angle = std::atan(offset / zero_parallax), length = norm(centre.target - centre.position);
  const double distance = length > 0 ? length : zero_parallax;
  View eye = centre;
  eye.position += offset * axes.right;
  eye.target = eye.position - distance * (std::cos(angle) * axes.back + std::sin(angle) * axes.right);
  eye.aspect = aspect * std::cos(angle);
  return eye;
}

}  // namespace

double zero_parallax_distance(const View& centre, const EyeSettings& settings) {
  if (settings.zero_parallax) return *settings.zero_parallax;
  const double distance = norm(centre.target - centre.position);
  return distance > 0 ? distance : 1;
}

std::vector<View> eyes(const View& centre, double aspect, const EyeSettings& settings) {
  const double zero_parallax = zero_parallax_distance(centre, settings);
  const double separation = settings.separation.value_or(kSeparationShare * zero_parallax);
  CATENA_ASSERT(settings.views > 0 && aspect > 0 && zero_parallax > 0 && separation >= 0);
  const Camera axes = make_camera(centre, 1, 1, {});
  View same_up = centre;
  same_up.up = axes.up;  // a doubtful up is settled once for all eyes
  std::vector<View> result;
  for (std::size_t k = 0; k < settings.views; ++k) {
    const double offset = (double(k) - 0.5 * double(settings.views - 1)) * separation;
    const auto eye = centre.orthographic ? orthographic_eye : perspective_eye;
    result.push_back(eye(same_up, axes, aspect, offset, zero_parallax));
  }
  return result;
}

}  // namespace catena::render
