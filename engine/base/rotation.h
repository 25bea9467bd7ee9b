/// Rotations of the whole house: unit quaternions (GLM, double) and rotation vectors (axis times angle, radians).
/// q turns tool axes into world axes: rotate(q, v);  rotate(a * b, v) = rotate(a, rotate(b, v)).
#pragma once
#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/base/vec.h"

namespace catena {

using Quat = glm::dquat;  ///< Quat(w, x, y, z); the identity is Quat(1, 0, 0, 0)

inline const Quat kNoRotation{1.0, 0.0, 0.0, 0.0};

inline bool is_finite(const Quat& q) { return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z); }

/// Unit length; what is zero or not finite is no rotation.
Quat normalised(const Quat& q) noexcept;
/// v turned by the unit quaternion q: v + 2 w (u x v) + 2 u x (u x v), u its vector part.
Vec3 rotate(const Quat& q, const Vec3& v) noexcept;
/// log: the rotation vector of a unit quaternion, the shorter way round: |.| <= pi. q and -q are the same rotation.
Vec3 rotation_vector(const Quat& q) noexcept;
/// exp: the rotation about v by |v| radians.
Quat rotation_of(const Vec3& v) noexcept;
/// The smallest rotation that turns the unit vector a onto the unit vector b. Opposite ones: half a turn about an axis square to a,
/// the same for the same a.
Quat shortest_arc(const Vec3& a, const Vec3& b) noexcept;

}  // namespace catena
