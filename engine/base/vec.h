/// Vectors and matrices of the whole house: GLM in double precision (floats begin at the GPU).
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace catena {

/// Three doubles: a place or an arrow. World units unless a name says otherwise (`_m` metres, `_n` newtons).
using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;  ///< columns first, as GLM keeps them

/// The scalar product.
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// The vector product, right-handed.
inline Vec3 cross(const Vec3& a, const Vec3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
/// The largest of |x|, |y|, |z|.
inline double max_abs(const Vec3& v) { return std::max(std::max(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z)); }
/// Whether all components are finite.
inline bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// |v| without overflow or underflow: divides by max|v_i| before squaring (correct from 1e-323 to 1e308). Not finite where v is not.
inline double norm(const Vec3& v) {
  const double m = max_abs(v);
  if (!(m > 0) || !std::isfinite(m)) return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
  if (m > 1e-140 && m < 1e140) return std::sqrt(dot(v, v));
  const Vec3 w{v.x / m, v.y / m, v.z / m};
  return m * std::sqrt(dot(w, w));
}

/// v / |v|, or zero where v is zero or not finite. Bitwise odd: direction(-v) == -direction(v).
inline Vec3 direction(const Vec3& v) {
  const double m = max_abs(v);
  if (!(m > 0) || !std::isfinite(m)) return Vec3(0.0);
  const Vec3 w{v.x / m, v.y / m, v.z / m};
  const double r = std::sqrt(dot(w, w));
  if (!(r > 0)) return Vec3(0.0);  // a component is not a number
  return {w.x / r, w.y / r, w.z / r};
}

/// Rotations of the whole house: unit quaternions (GLM, double) and rotation vectors (axis times angle, radians).
/// q turns tool axes into world axes: rotate(q, v);  rotate(a * b, v) = rotate(a, rotate(b, v)).

using Quat = glm::dquat;  ///< Quat(w, x, y, z); the identity is Quat(1, 0, 0, 0)

inline const Quat kIdentityRotation{1.0, 0.0, 0.0, 0.0};  ///< The rotation that turns nothing.

/// Whether all components are finite.
inline bool is_finite(const Quat& q) { return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z); }

/// Unit length; what is zero or not finite is no rotation.
Quat normalized(const Quat& q) noexcept;
/// v turned by the unit quaternion q: v + 2 w (u x v) + 2 u x (u x v), u its vector part.
Vec3 rotate(const Quat& q, const Vec3& v) noexcept;
/// log: the rotation vector of a unit quaternion, the shorter way round: |.| <= pi. q and -q are the same rotation.
Vec3 rotation_vector(const Quat& q) noexcept;
/// exp: the rotation about v by |v| radians.
Quat rotation_from_vector(const Vec3& v) noexcept;
/// The smallest rotation that turns the unit vector a onto the unit vector b. Opposite ones: half a turn about an axis square to a,
/// the same for the same a.
Quat shortest_arc(const Vec3& a, const Vec3& b) noexcept;

}  // namespace catena
