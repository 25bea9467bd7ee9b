// SPDX-License-Identifier: MIT
/// Axis of a line field, in which v and -v mean the same (fibers, eigenvectors of a tensor). Such vectors cannot be interpolated: corners
/// that differ only in sign would cancel. Instead the dyads of the corners are interpolated,
///   M = sum over corners of w_c v_c v_c^T,
/// and the eigenvector of the largest eigenvalue (l1 >= l2 >= l3) is the axis. It depends neither on signs nor on earlier fetches.
///   speed = sqrt(l1), the magnitude;   coherence = (l1 - l2) / (l1 + l2 + l3): 1 where the corners agree, 0 where no axis is defined
/// Computed with + - * / sqrt only, so results repeat to the bit; correct for magnitudes from 1e-300 to 1e300. Any thread; no allocation.
#pragma once
#include <array>

#include "engine/base/export.h"
#include "engine/base/vec.h"

namespace catena::field {

/// Symmetric 3x3 matrix.
struct Dyad {
  double xx = 0, yy = 0, zz = 0, yz = 0, xz = 0, xy = 0;  ///< its six independent elements
  /// Adds weight times m.
  void add(double weight, const Dyad& m) {
    xx += weight * m.xx;
    yy += weight * m.yy;
    zz += weight * m.zz;
    yz += weight * m.yz;
    xz += weight * m.xz;
    xy += weight * m.xy;
  }
  /// Adds weight times v v^T.
  void add(double weight, const Vec3& v) {
    const Vec3 w = weight * v;
    xx += w.x * v.x;
    yy += w.y * v.y;
    zz += w.z * v.z;
    yz += w.y * v.z;
    xz += w.x * v.z;
    xy += w.x * v.y;
  }
};

/// Axis of a line field at a position.
struct LineAxis {
  Vec3 axis{0.0};        ///< unit vector of either sign; zero where there is no axis
  double speed = 0;      ///< sqrt(l1), in the field's unit
  double coherence = 0;  ///< 0 to 1; below 0.2 (flow::kMinCoherence) the axis is meaningless
};

/// Dyads of a cell as a trilinear polynomial, for evaluation at many positions in one cell.
class CATENA_EXPORT DyadCell {
 public:
  DyadCell() = default;
  /// Computes the polynomial from the vectors at the eight corners (order: cell.h).
  explicit DyadCell(const std::array<Vec3, 8>& corner) noexcept;
  /// Returns the axis at f as line_axis() does, but with either sign.
  LineAxis at(const Vec3& f) const noexcept;

 private:
  std::array<Dyad, 8> coefficients_;  ///< factors of 1, x, y, xy, z, xz, yz, xyz, for the vectors / scale_
  double scale_ = 0;                  ///< largest absolute component of a corner; 0: no axis
};

/// Returns the eigenvector of the largest eigenvalue of a matrix that is positive semidefinite except for rounding.
CATENA_EXPORT LineAxis leading_axis(const Dyad& m) noexcept;

/// Returns the axis at the position f of a trilinear cell (corner order: cell.h; f may be outside of [0, 1]^3). Its sign agrees with the
/// non-zero corner of largest weight. Corners that are not finite give no axis.
CATENA_EXPORT LineAxis line_axis(const std::array<Vec3, 8>& corner, const Vec3& f) noexcept;

}  // namespace catena::field
