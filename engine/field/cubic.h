// SPDX-License-Identifier: MIT
/// Cubic cell: the 4 x 4 x 4 samples around a cell give a value and its gradient, both continuous from cell to cell (C1).
///   s(f) = sum over i, j, k in -1..2 of c_ijk w_i(f.x) w_j(f.y) w_k(f.z),   f = index - base in [0, 1]^3      (Catmull and Rom, 1974)
///   w(t) = (-t + 2 t^2 - t^3, 2 - 5 t^2 + 3 t^3, t + 4 t^2 - 3 t^3, -t^2 + t^3) / 2
/// It interpolates the samples, reproduces polynomials of second degree, and may leave the range of the samples: kCubicOvershoot. Sums are
/// formed from differences to the base sample of each axis, so equal samples give exactly that value and a gradient of 0.
/// Any thread; no allocation, lock or throw.
#pragma once
#include <algorithm>
#include <array>

#include "engine/base/vec.h"

namespace catena::field {

/// Samples with C components: index c + C (x + 4 y + 16 z), x, y, z in 0..3, starting at base - 1 along each axis.
template <int C>
using CubicSamples = std::array<float, 64 * C>;

/// Value and slopes of a cubic cell with C components.
template <int C>
struct CubicValue {
  std::array<double, C> value;                 ///< by component
  std::array<std::array<double, C>, 3> slope;  ///< derivatives in index space along x, y, z, by component
};

/// How far a value may leave the range [a, b] of the samples: by kCubicOvershoot (b - a) at both ends. The negative weights add up to at
/// most -1/8 along one axis, so the absolute weights of three axes add up to at most (5/4)^3: ((5/4)^3 - 1) / 2.
inline constexpr double kCubicOvershoot = 61.0 / 128;

/// Weights along one axis at the position t in [0, 1].
struct CubicWeights {
  double value[3], slope[3];  ///< for the differences of samples 0, 2 and 3 to sample 1

  /// Computes the weights for value and slope at t.
  explicit CubicWeights(double t)
      : value{0.5 * t * (t * (2 - t) - 1), 0.5 * t * (1 + t * (4 - 3 * t)), 0.5 * t * t * (t - 1)},
        slope{0.5 * (t * (4 - 3 * t) - 1), 0.5 * (1 + t * (8 - 9 * t)), 0.5 * t * (3 * t - 2)} {}
};

/// Interpolates four rows of N numbers along one axis.
template <int N, class T>
inline void cubic_values(const T* rows, const CubicWeights& w, double* value) {
  for (int n = 0; n < N; ++n) {
    const double c = rows[N + n], a = rows[n] - c, b = rows[2 * N + n] - c, d = rows[3 * N + n] - c;
    value[n] = c + (w.value[0] * a + w.value[1] * b + w.value[2] * d);
  }
}
/// Interpolates four rows of N numbers along one axis, and computes the slopes along this axis in index space.
template <int N, class T>
inline void cubic_values(const T* rows, const CubicWeights& w, double* value, double* slope) {
  for (int n = 0; n < N; ++n) {
    const double c = rows[N + n], a = rows[n] - c, b = rows[2 * N + n] - c, d = rows[3 * N + n] - c;
    value[n] = c + (w.value[0] * a + w.value[1] * b + w.value[2] * d);
    slope[n] = w.slope[0] * a + w.slope[1] * b + w.slope[2] * d;
  }
}

/// Returns value and slopes at f inside the cell.
template <int C>
CubicValue<C> cubic_within(const CubicSamples<C>& samples, const Vec3& f) {
  const CubicWeights x(f.x), y(f.y), z(f.z);
  CubicValue<C> out;
  double plane[16 * C], plane_z[16 * C], row[4 * C], row_y[4 * C], row_z[4 * C];
  cubic_values<16 * C>(samples.data(), z, plane, plane_z);
  cubic_values<4 * C>(plane, y, row, row_y);
  cubic_values<4 * C>(plane_z, y, row_z);
  cubic_values<C>(row, x, out.value.data(), out.slope[0].data());
  cubic_values<C>(row_y, x, out.slope[1].data());
  cubic_values<C>(row_z, x, out.slope[2].data());
  return out;
}

/// Returns value and slopes at any f. Outside of the cell it continues linearly with value and gradient of the nearest position in the
/// cell.
template <int C>
CubicValue<C> cubic(const CubicSamples<C>& samples, const Vec3& f) {
  const Vec3 near = glm::clamp(f, Vec3(0.0), Vec3(1.0)), beyond = f - near;
  CubicValue<C> out = cubic_within<C>(samples, near);
  for (int c = 0; c < C; ++c) out.value[c] += beyond.x * out.slope[0][c] + beyond.y * out.slope[1][c] + beyond.z * out.slope[2][c];
  return out;
}

/// Returns the vector at f without slopes; outside of the cell the polynomial of the cell itself.
inline Vec3 cubic_vector_within(const CubicSamples<3>& samples, const Vec3& f) {
  double plane[48], row[12], value[3];
  cubic_values<48>(samples.data(), CubicWeights(f.z), plane);
  cubic_values<12>(plane, CubicWeights(f.y), row);
  cubic_values<3>(row, CubicWeights(f.x), value);
  return {value[0], value[1], value[2]};
}

/// Returns the vector at any f; outside of the cell it continues linearly.
inline Vec3 cubic_vector(const CubicSamples<3>& samples, const Vec3& f) {
  if (f.x >= 0 && f.x <= 1 && f.y >= 0 && f.y <= 1 && f.z >= 0 && f.z <= 1) return cubic_vector_within(samples, f);
  const auto out = cubic<3>(samples, f);
  return {out.value[0], out.value[1], out.value[2]};
}

}  // namespace catena::field
