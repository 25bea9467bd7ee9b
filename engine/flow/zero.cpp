#include "engine/flow/zero.h"

#include <glm/matrix.hpp>

namespace catena::flow {

namespace {

bool velocity_at(const Flow& flow, const Vec3& p, const Vec3& reference, field::Cursor& cursor, Vec3& v) noexcept {
  if (flow.line) {
    const field::LineSample line = flow.field->sample_line(p, cursor);
    v = line.speed * (dot(line.axis, reference) < 0 ? -line.axis : line.axis);
    return line.inside;
  }
  const field::VectorSample sample = flow.field->sample(p, cursor);
  v = sample.value;
  return sample.inside && is_finite(v);
}

}  // namespace

std::optional<Vec3> find_zero(const Flow& flow, const Vec3& p, const Vec3& reference, double radius, field::Cursor& cursor, int budget,
                              int& evaluations) noexcept {
  // the speed of interpolated dyads has no isolated zeros
  if (flow.line && flow.field->is_grid()) return std::nullopt;
  const double length = flow.field->length(), delta = 1e-6 * length;
  Vec3 z = p;
  double first_speed = -1;
  for (int iteration = 0; iteration < 8 && budget >= 7; ++iteration, budget -= 7) {
    // value and Jacobian, scaled by the largest velocity seen
    Vec3 v, ahead[3], behind[3];
    evaluations += 7;
    if (!velocity_at(flow, z, reference, cursor, v)) return std::nullopt;
    double scale = max_abs(v);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 step(0.0);
      step[axis] = delta;
      if (!velocity_at(flow, z + step, reference, cursor, ahead[axis])) return std::nullopt;
      if (!velocity_at(flow, z - step, reference, cursor, behind[axis])) return std::nullopt;
      scale = std::max(scale, std::max(max_abs(ahead[axis]), max_abs(behind[axis])));
    }
    if (first_speed < 0) first_speed = norm(v);
    if (max_abs(v) == 0) return z;
    Mat3 jacobian;
    for (int axis = 0; axis < 3; ++axis) {
      // divided before the difference, so that neither end of the double range matters
      for (int i = 0; i < 3; ++i) jacobian[axis][i] = 0.5 * (ahead[axis][i] / scale - behind[axis][i] / scale);
    }
    Vec3 w;
    for (int i = 0; i < 3; ++i) w[i] = v[i] / scale;

    // minimum-norm Newton step, in units of delta
    const Mat3 transposed = glm::transpose(jacobian);
    Mat3 normal = transposed * jacobian;
    const double trace = normal[0][0] + normal[1][1] + normal[2][2];
    if (!(trace > 0)) return std::nullopt;
    for (int i = 0; i < 3; ++i) normal[i][i] += 1e-9 * trace;
    const Vec3 step = -delta * (glm::inverse(normal) * (transposed * w));
    if (!is_finite(step)) return std::nullopt;
    z += step;
    if (norm(z - p) > radius) return std::nullopt;
    if (norm(step) > 1e-11 * length) continue;

    // converged: a zero, or only the slowest place of a field that never stops
    ++evaluations;
    if (!velocity_at(flow, z, reference, cursor, v)) return std::nullopt;
    if (norm(v) <= 1e-3 * first_speed) return z;
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace catena::flow
