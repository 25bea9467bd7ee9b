/// Vectors and matrices of the whole house: GLM in double precision (floats begin at the GPU).
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace catena {

using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;  ///< columns first, as GLM keeps them

inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double max_abs(const Vec3& v) { return std::max(std::max(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z)); }
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

}  // namespace catena
