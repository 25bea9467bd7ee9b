/// The axis of a line field, in which v and -v mean the same (fibres, eigenvectors of a tensor). Vectors cannot be interpolated
/// there: corners that agree but for their signs would cancel. What is interpolated are the dyads of the corners,
///   M = sum over corners of w_c v_c v_c^T,
/// whose leading eigenvector (eigenvalues l1 >= l2 >= l3) is the axis. It does not depend on any sign, nor on where a walk came from.
///   speed = sqrt(l1), the magnitude;   coherence = (l1 - l2) / (l1 + l2 + l3): 1 where the corners agree, 0 where no axis is defined
/// Computed with + - * / sqrt only, so that bits repeat; correct for magnitudes from 1e-300 to 1e300. Any thread; no allocation.
#pragma once
#include <array>

#include "engine/base/vec.h"

namespace catena::field {

/// A symmetric 3x3 matrix.
struct Dyad {
  double xx = 0, yy = 0, zz = 0, yz = 0, xz = 0, xy = 0;  ///< its six numbers
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

/// What a line field says at a place.
struct LineAxis {
  Vec3 axis{0.0};        ///< unit, of either sign; zero where there is none
  double speed = 0;      ///< sqrt(l1), the field's unit
  double coherence = 0;  ///< 0 to 1; below 0.2 (flow::kMinCoherence) the axis says nothing
};

/// The dyads of a cell as a trilinear polynomial, for many places in one cell.
class DyadCell {
 public:
  DyadCell() = default;
  /// From the vectors at the eight corners (cell.h).
  explicit DyadCell(const std::array<Vec3, 8>& corner) noexcept;
  /// As line_axis at f, but of either sign.
  LineAxis at(const Vec3& f) const noexcept;

 private:
  std::array<Dyad, 8> coefficients_;  ///< of 1, x, y, xy, z, xz, yz, xyz
  double scale_ = 0;                  ///< the largest component of a corner
};

/// The leading eigenvector of a matrix that is positive semidefinite but for rounding.
LineAxis leading_axis(const Dyad& m) noexcept;

/// The axis at the place f of a trilinear cell (corner order: cell.h; f may lie outside [0, 1]^3), turned to the side of the corner
/// of the largest weight that moves. Corners that are not finite give no axis.
LineAxis line_axis(const std::array<Vec3, 8>& corner, const Vec3& f) noexcept;

}  // namespace catena::field
