// SPDX-License-Identifier: MIT
/// Trilinear cell: its eight corners determine the whole polynomial, so one fetch gives value, gradient and Hessian exactly.
///   s(f) = sum over corners of c_ijk * (x-weight)(y-weight)(z-weight),  f = index - base in [0, 1]^3
/// Corner order: corner[i + 2 j + 4 k] at base + (i, j, k). Gradients are in index space; Mapping converts them to world space.
#pragma once
#include <array>
#include <cstdint>

#include "engine/base/export.h"
#include "engine/base/vec.h"

namespace catena::field {

/// Index of a voxel.
struct Index3 {
  std::int32_t x = 0, y = 0, z = 0;  ///< along the grid's axes
  bool operator==(const Index3&) const = default;
};

/// Cell of a scalar grid.
struct CATENA_EXPORT ScalarCell {
  Index3 base;                     ///< base voxel: index of corner 0
  bool valid = false;              ///< inside the domain, and all eight corners valid where the grid has a mask
  std::array<double, 8> corner{};  ///< values, corner[i + 2 j + 4 k]

  /// Returns the trilinear value at f in [0, 1]^3; outside of it the same polynomial.
  double value(const Vec3& f) const;
  Vec3 gradient(const Vec3& f) const;  ///< gradient in index space
  /// Returns the mixed second derivatives (d2/dydz, d2/dxdz, d2/dxdy) in index space; the other second derivatives of a trilinear function
  /// are zero.
  Vec3 mixed_second_derivatives(const Vec3& f) const;
  /// Computes value and gradient (index space) in one pass.
  void value_and_gradient(const Vec3& f, double& value, Vec3& gradient) const;
};

/// Cell of a vector grid.
struct CATENA_EXPORT VectorCell {
  Index3 base;                   ///< base voxel: index of corner 0
  bool valid = false;            ///< as in ScalarCell
  std::array<Vec3, 8> corner{};  ///< vectors in world axes, corner[i + 2 j + 4 k]

  /// Returns the trilinear vector at f.
  Vec3 value(const Vec3& f) const;
};

// Performance-critical functions are inline: a fetch takes a few nanoseconds, and a call would take as long.

/// Evaluates the trilinear polynomial of eight numbers at f, with its gradient in index space.
inline void trilinear(const std::array<double, 8>& c, const Vec3& f, double& value, Vec3& gradient) {
  // along x, then y, then z
  const double d00 = c[1] - c[0], d10 = c[3] - c[2], d01 = c[5] - c[4], d11 = c[7] - c[6];
  const double v00 = c[0] + d00 * f.x, v10 = c[2] + d10 * f.x, v01 = c[4] + d01 * f.x, v11 = c[6] + d11 * f.x;
  const double e0 = v10 - v00, e1 = v11 - v01;
  const double w0 = v00 + e0 * f.y, w1 = v01 + e1 * f.y;
  value = w0 + (w1 - w0) * f.z;
  const double x0 = d00 + (d10 - d00) * f.y, x1 = d01 + (d11 - d01) * f.y;
  gradient = Vec3(x0 + (x1 - x0) * f.z, e0 + (e1 - e0) * f.z, w1 - w0);
}

/// Returns the trilinear interpolation of eight vectors at f.
inline Vec3 trilinear(const std::array<Vec3, 8>& c, const Vec3& f) {
  const auto mix = [](const Vec3& a, const Vec3& b, double t) {
    return Vec3(a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t);
  };
  const Vec3 w0 = mix(mix(c[0], c[1], f.x), mix(c[2], c[3], f.x), f.y);
  const Vec3 w1 = mix(mix(c[4], c[5], f.x), mix(c[6], c[7], f.x), f.y);
  return mix(w0, w1, f.z);
}

inline void ScalarCell::value_and_gradient(const Vec3& f, double& value, Vec3& gradient) const { trilinear(corner, f, value, gradient); }

inline double ScalarCell::value(const Vec3& f) const {
  double v;
  Vec3 g;
  value_and_gradient(f, v, g);
  return v;
}

inline Vec3 ScalarCell::gradient(const Vec3& f) const {
  double v;
  Vec3 g;
  value_and_gradient(f, v, g);
  return g;
}

inline Vec3 VectorCell::value(const Vec3& f) const { return trilinear(corner, f); }

}  // namespace catena::field
