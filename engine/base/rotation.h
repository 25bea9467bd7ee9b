/// Rotations of the whole house: unit quaternions (GLM, double) and rotation vectors (axis times angle, radians).
#pragma once
#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/base/vec.h"

namespace catena {

using Quat = glm::dquat;  ///< Quat(w, x, y, z); the identity is Quat(1, 0, 0, 0)

inline const Quat kNoRotation{1.0, 0.0, 0.0, 0.0};

inline bool is_finite(const Quat& q) { return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z); }

}  // namespace catena
