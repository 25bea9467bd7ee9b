// SPDX-License-Identifier: MIT
/// Vectors, matrices and quaternions used throughout Catena: GLM in double precision (single precision is used on the GPU only).
// The include guard is needed in addition to the pragma. The precompiled header contains this header, and a compiler cache may return a
// precompiled header that was made from this header with other comments. GCC then treats the two as different files and includes both.
#pragma once
#ifndef CATENA_BASE_VEC_H
#define CATENA_BASE_VEC_H
#include <algorithm>
#include <cmath>
#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace catena {

/// Three doubles: a position or a direction. World units unless a name states otherwise (`_m` meters, `_n` newtons).
using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;  ///< stored column by column, as in GLM

/// Returns the scalar product.
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// Returns the vector product, right-handed.
inline Vec3 cross(const Vec3& a, const Vec3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
/// Returns the largest of |x|, |y|, |z|.
inline double max_abs(const Vec3& v) { return std::max(std::max(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z)); }
/// Returns true when all components are finite.
inline bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Returns |v| without overflow or underflow: divides by max|v_i| before squaring (correct from 1e-323 to 1e308). Not finite when v is not.
inline double norm(const Vec3& v) {
  const double m = max_abs(v);
  if (!(m > 0) || !std::isfinite(m)) return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
  if (m > 1e-140 && m < 1e140) return std::sqrt(dot(v, v));
  const Vec3 w{v.x / m, v.y / m, v.z / m};
  return m * std::sqrt(dot(w, w));
}

/// Returns v / |v|, or zero when v is zero or not finite. Odd to the bit: direction(-v) == -direction(v).
inline Vec3 direction(const Vec3& v) {
  const double m = max_abs(v);
  if (!(m > 0) || !std::isfinite(m)) return Vec3(0.0);
  const Vec3 w{v.x / m, v.y / m, v.z / m};
  const double r = std::sqrt(dot(w, w));
  if (!(r > 0)) return Vec3(0.0);  // a component is NaN
  return {w.x / r, w.y / r, w.z / r};
}

/// Rotations: unit quaternions (GLM, double) and rotation vectors (axis times angle, radians).
/// A quaternion q rotates tool axes to world axes: rotate(q, v);  rotate(a * b, v) = rotate(a, rotate(b, v)).

using Quat = glm::dquat;  ///< Quat(w, x, y, z); the identity is Quat(1, 0, 0, 0)

inline const Quat kIdentityRotation{1.0, 0.0, 0.0, 0.0};  ///< identity rotation

/// Returns true when all components are finite.
inline bool is_finite(const Quat& q) { return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z); }

/// Returns q scaled to unit length; the identity when q is zero or not finite.
Quat normalized(const Quat& q) noexcept;
/// Returns v rotated by the unit quaternion q: v + 2 w (u x v) + 2 u x (u x v), where u is the vector part of q.
Vec3 rotate(const Quat& q, const Vec3& v) noexcept;
/// Logarithm: returns the rotation vector of a unit quaternion with the smaller angle, |result| <= pi. q and -q are the same rotation.
Vec3 rotation_vector(const Quat& q) noexcept;
/// Exponential: returns the rotation about v by |v| radians.
Quat rotation_from_vector(const Vec3& v) noexcept;
/// Returns the smallest rotation that takes the unit vector a to the unit vector b. For opposite vectors: half a turn about an axis
/// perpendicular to a that depends on a only.
Quat shortest_arc(const Vec3& a, const Vec3& b) noexcept;

}  // namespace catena

#endif
