/// The emulated Falcon's delta mechanism: where its three legs stand for a grip position, and what its motors push.
/// Written from the published formulas, apart from the driver's kinematics: each pins the other.
///   u = x cos(phi) + y sin(phi) - r,  v = -x sin(phi) + y cos(phi) - s,  w = z,  cos(theta3) = (v + f) / b
///   L = d + e + b sin(theta3),  R = hypot(u + c, w),  theta = atan2(w, u + c) - acos((a^2 + R^2 - L^2) / (2 a R))
/// Metres, radians, newtons, newton metres; z points away from the base. Off the tick, pure.
#pragma once
#include <array>
#include <optional>

#include "engine/base/vec.h"

namespace catena::haptics {

inline constexpr double kEmulatedDegreesAtZero = 35, kEmulatedDegreesPerCount = 0.0364347;
inline constexpr double kEmulatedCountsPerNm = 1e4;

struct DeltaLegs {
  Vec3 theta{0.0};       ///< of the three motors
  Mat3 theta_by_p{1.0};  ///< d theta_i / d p_j: row i, column j (GLM: theta_by_p[j][i])
};

/// Nothing where the mechanism does not reach.
std::optional<DeltaLegs> delta_legs(const Vec3& grip_m);

/// Encoder counts, not yet rounded.
Vec3 counts_of_angles(const Vec3& theta);

/// What the grip feels of motor counts m: tau = -m / 1e4,  F = (dp/dtheta)^-T tau = (dtheta/dp)^T tau.
Vec3 force_of_motors(const DeltaLegs& legs, const std::array<int, 3>& counts);

}  // namespace catena::haptics
