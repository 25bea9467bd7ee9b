// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/derivatives.h"

#include <glm/matrix.hpp>

#include "engine/field/grid/grid.h"

namespace catena::flow {

namespace {

constexpr double kDifference = 2e-6;  // step of the differences, as a fraction of L

Vec3 mix(const Vec3& a, const Vec3& b, double t) { return a * (1 - t) + b * t; }

VelocityGradient of_cubic_cell(const field::VectorGrid& grid, const Vec3& index, field::Cursor& cursor) noexcept {
  VelocityGradient out;
  const field::Index3 base = grid.cell_base(index);
  const field::CubicSamples<3>* samples = grid.cubic_samples(base, cursor);
  if (samples == nullptr) return out;
  for (const float c : *samples) out.scale = std::max(out.scale, std::fabs(double{c}));
  out.is_valid = true;
  if (!(out.scale > 0)) return out;
  const auto cubic = field::cubic_within<3>(*samples, index - Vec3(base.x, base.y, base.z));
  const auto scaled = [&](const std::array<double, 3>& v) { return Vec3(v[0] / out.scale, v[1] / out.scale, v[2] / out.scale); };
  out.v = scaled(cubic.value);
  out.gradient = Mat3(scaled(cubic.slope[0]), scaled(cubic.slope[1]), scaled(cubic.slope[2])) * grid.mapping().index_from_world_linear;
  return out;
}

VelocityGradient of_cell(const field::VectorGrid& grid, const Vec3& world, field::Cursor& cursor, int& evaluations) noexcept {
  VelocityGradient out;
  const Vec3 index = grid.mapping().index_from_world(world);
  if (!grid.index_box().contains(index)) return out;
  ++evaluations;
  if (grid.interpolation() == field::Interpolation::cubic) return of_cubic_cell(grid, index, cursor);
  field::VectorCell cell = grid.cell(grid.cell_base(index), cursor);
  if (!cell.valid) return out;
  for (const Vec3& c : cell.corner) {
    if (!is_finite(c)) return out;
    out.scale = std::max(out.scale, max_abs(c));
  }
  out.is_valid = true;
  if (!(out.scale > 0)) return out;
  for (Vec3& c : cell.corner) c = Vec3(c.x / out.scale, c.y / out.scale, c.z / out.scale);
  const auto& c = cell.corner;
  const Vec3 f = index - Vec3(cell.base.x, cell.base.y, cell.base.z);
  out.v = cell.value(f);
  const Vec3 dx = mix(mix(c[1] - c[0], c[3] - c[2], f.y), mix(c[5] - c[4], c[7] - c[6], f.y), f.z);
  const Vec3 dy = mix(mix(c[2] - c[0], c[3] - c[1], f.x), mix(c[6] - c[4], c[7] - c[5], f.x), f.z);
  const Vec3 dz = mix(mix(c[4] - c[0], c[5] - c[1], f.x), mix(c[6] - c[2], c[7] - c[3], f.x), f.y);
  out.gradient = Mat3(dx, dy, dz) * grid.mapping().index_from_world_linear;
  return out;
}

VelocityGradient of_formula(const field::VectorField& field, const Vec3& world, field::Cursor& cursor, int& evaluations) noexcept {
  VelocityGradient out;
  const double delta = kDifference * field.domain_length();
  Vec3 at[7];
  for (int i = 0; i < 7; ++i) {
    Vec3 position = world;
    if (i > 0) position[(i - 1) / 2] += i % 2 == 1 ? delta : -delta;
    const field::VectorSample sample = field.sample(position, cursor);
    ++evaluations;
    if (!sample.inside || !is_finite(sample.value)) return out;
    at[i] = sample.value;
    out.scale = std::max(out.scale, max_abs(at[i]));
  }
  out.is_valid = true;
  if (!(out.scale > 0)) return out;
  for (Vec3& v : at) v = Vec3(v.x / out.scale, v.y / out.scale, v.z / out.scale);
  out.v = at[0];
  for (int j = 0; j < 3; ++j) {
    // the actual step, after rounding
    const double step = (world[j] + delta) - (world[j] - delta);
    if (!(step > 0)) {
      out.is_valid = false;
      return out;
    }
    out.gradient[j] = (at[1 + 2 * j] - at[2 + 2 * j]) * (1 / step);
  }
  return out;
}

}  // namespace

int velocity_gradient_fetches(const field::VectorField& field) noexcept { return field.grid() != nullptr ? 1 : 7; }

VelocityGradient compute_velocity_gradient(const field::VectorField& field, const Vec3& world, field::Cursor& cursor,
                                           int& evaluations) noexcept {
  return field.grid() != nullptr ? of_cell(*field.grid(), world, cursor, evaluations) : of_formula(field, world, cursor, evaluations);
}

namespace {

bool velocity_at(const Flow& flow, const Vec3& p, const Vec3& reference, field::Cursor& cursor, Vec3& v) noexcept {
  if (flow.is_line_field) {
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
  // the speed of a field of interpolated dyads has no isolated zeros
  if (flow.is_line_field && flow.field->is_grid()) return std::nullopt;
  const double length = flow.field->domain_length(), delta = 1e-6 * length;
  Vec3 z = p;
  double first_speed = -1;
  for (int iteration = 0; iteration < 8 && budget >= 7; ++iteration, budget -= 7) {
    // value and Jacobian, scaled by the largest velocity component of the stencil
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
      // divided before the subtraction, so that neither overflow nor underflow occurs
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

    // converged: either a zero, or a local minimum of the speed of a field without a zero
    ++evaluations;
    if (!velocity_at(flow, z, reference, cursor, v)) return std::nullopt;
    if (norm(v) <= 1e-3 * first_speed) return z;
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace catena::flow
