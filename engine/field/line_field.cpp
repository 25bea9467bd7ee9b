// SPDX-License-Identifier: MIT
#include "engine/field/line_field.h"

namespace catena::field {
namespace {

constexpr int kNewtonSteps = 24;

/// Returns the largest root of b^3 - 3 b - r, for r in [-2, 2]: Newton's method from 2 converges from above, as the cubic is convex there.
double largest_root(double r) noexcept {
  double b = 2;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const double slope = 3 * (b * b - 1);
    if (!(slope > 0)) return 1;
    const double next = b - ((b * b - 3) * b - r) / slope;
    if (!(next < b)) break;
    b = next;
  }
  return b > 1 ? b : 1;
}

/// Returns v / scale, without overflow of the reciprocal.
Vec3 scaled(const Vec3& v, double scale) noexcept {
  return scale > 1e-290 && scale < 1e290 ? v * (1 / scale) : Vec3(v.x / scale, v.y / scale, v.z / scale);
}

}  // namespace

LineAxis leading_axis(const Dyad& m) noexcept {
  LineAxis out;
  const double trace = m.xx + m.yy + m.zz, mean = trace / 3;
  if (!(trace > 0)) return out;

  // M = mean I + p B: the eigenvalues of B are the roots of b^3 - 3 b - det B, the largest one in [1, 2]
  const double x = m.xx - mean, y = m.yy - mean, z = m.zz - mean;
  const double p = std::sqrt((x * x + y * y + z * z + 2 * (m.yz * m.yz + m.xz * m.xz + m.xy * m.xy)) / 6);
  if (!(p > 1e-15 * mean)) {
    out.speed = std::sqrt(mean);
    return out;
  }
  const double bx = x / p, by = y / p, bz = z / p, yz = m.yz / p, xz = m.xz / p, xy = m.xy / p;
  const double det = bx * (by * bz - yz * yz) - xy * (xy * bz - yz * xz) + xz * (xy * yz - by * xz);
  const double b = largest_root(det < -2 ? -2 : det > 2 ? 2 : det);
  const double discriminant = 12 - 3 * b * b;
  out.coherence = 0.5 * p * (3 * b - std::sqrt(discriminant > 0 ? discriminant : 0)) / trace;
  const double largest = mean + p * b;
  out.speed = std::sqrt(largest > 0 ? largest : 0);

  // the adjugate of B - b I is a multiple of the dyad of the axis: its longest column is the axis
  const double cx = bx - b, cy = by - b, cz = bz - b;
  const double axx = cy * cz - yz * yz, ayy = cx * cz - xz * xz, azz = cx * cy - xy * xy;
  const double ayz = xy * xz - yz * cx, axz = xy * yz - xz * cy, axy = xz * yz - xy * cz;
  if (axx >= ayy && axx >= azz)
    out.axis = direction(Vec3(axx, axy, axz));
  else if (ayy >= azz)
    out.axis = direction(Vec3(axy, ayy, ayz));
  else
    out.axis = direction(Vec3(axz, ayz, azz));
  return out;
}

DyadCell::DyadCell(const std::array<Vec3, 8>& corner) noexcept {
  for (const Vec3& v : corner) scale_ = std::max(scale_, max_abs(v));
  if (!(scale_ > 0) || !std::isfinite(scale_)) {
    scale_ = 0;
    return;
  }
  for (std::size_t c = 0; c < 8; ++c) coefficients_[c].add(1, scaled(corner[c], scale_));
  // converts corner values to polynomial coefficients: differences along x, y, z
  for (const std::size_t bit : {1u, 2u, 4u})
    for (std::size_t c = 0; c < 8; ++c)
      if (c & bit) coefficients_[c].add(-1, coefficients_[c - bit]);
}

LineAxis DyadCell::at(const Vec3& f) const noexcept {
  if (!(scale_ > 0)) return {};
  Dyad sum = coefficients_[0];
  const double xy = f.x * f.y;
  const double weights[8] = {1, f.x, f.y, xy, f.z, f.x * f.z, f.y * f.z, xy * f.z};
  for (std::size_t c = 1; c < 8; ++c) sum.add(weights[c], coefficients_[c]);
  LineAxis out = leading_axis(sum);
  out.speed *= scale_;
  return out;
}

LineAxis line_axis(const std::array<Vec3, 8>& corner, const Vec3& f) noexcept {
  LineAxis out = DyadCell(corner).at(f);
  double max_weight = -1;
  Vec3 side(0.0);
  for (std::size_t c = 0; c < 8; ++c) {
    const double weight = ((c & 1) ? f.x : 1 - f.x) * ((c & 2) ? f.y : 1 - f.y) * ((c & 4) ? f.z : 1 - f.z);
    if (weight > max_weight && max_abs(corner[c]) > 0) {
      max_weight = weight;
      side = direction(corner[c]);
    }
  }
  if (dot(out.axis, side) < 0) out.axis = -out.axis;
  return out;
}

}  // namespace catena::field
