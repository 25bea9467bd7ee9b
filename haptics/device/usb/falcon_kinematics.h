// SPDX-License-Identifier: MIT
/// The delta mechanism of the Novint Falcon: meters, radians, newtons, the device's own axes (z out of the device, y up).
/// With a, b, c, d = e, f, r, s of the mechanism and leg angle phi = 105, -15, -135 degrees, per leg
///   u = x cos(phi) + y sin(phi) - r,  v = -x sin(phi) + y cos(phi) - s,  w = z
///   cos(theta3) = (v + f) / b,  L = d + e + b sin(theta3),  R = hypot(u + c, w)
///   inverse:  theta = atan2(w, u + c) - acos((a^2 + R^2 - L^2) / (2 a R))
/// The loop closes where  g(theta, p) = (u + c - a cos(theta))^2 + (w - a sin(theta))^2 - L^2 = 0, so
///   d theta / dp = -(dg/dp) / (dg/d theta)  (one row per leg);  dp / d theta is its inverse
///   forward:  Newton on the inverse from (0, 0, 0.11) to |d theta| <= 1e-12, halved where a step leaves the reach; at the rim along
///             the straight line of the angles. 3-5 steps inside; within 2 mm of the rim it may reject a reachable point
///   tau = (dp/dtheta)^T F;  motor counts = -gain tau, clamped together to +-4095, so that the direction is kept
/// Source: L.-W. Tsai's delta variant (Stamper 1997) with the Falcon's lengths; golden values in the tests. Any thread, bounded.
#pragma once
#include <array>

#include "engine/base/vec.h"
#include "haptics/device/usb/falcon_codec.h"

namespace catena::haptics::usb {

inline constexpr int kFalconFullTorque = 4095;   ///< motor counts
inline constexpr double kFalconForceGain = 1e4;  ///< motor counts per N m; empirical

/// Returns the motor angles, radians: theta = 35 degrees + counts x 0.0364347 degrees.
Vec3 falcon_angles(const FalconCounts& encoders) noexcept;
/// Returns the motor angles of fractional counts.
Vec3 falcon_angles(const Vec3& encoders) noexcept;
/// Returns the fractional encoder counts of motor angles, the inverse of falcon_angles.
Vec3 falcon_encoders(const Vec3& angles) noexcept;

/// Computes the motor angles of a position. False: out of reach (or not finite); `angles` is unchanged.
bool falcon_inverse_kinematics(const Vec3& position_m, Vec3& angles) noexcept;

/// Computes the position of motor angles. False: no such point within reach; `position_m` is unchanged. Bounded.
bool falcon_forward_kinematics(const Vec3& angles, Vec3& position_m) noexcept;

/// Computes dp / d theta in meters per radian, one column per axis. False: out of reach or singular.
bool falcon_jacobian(const Vec3& position_m, const Vec3& angles, Mat3& metres_per_rad) noexcept;

/// Returns the motor torques tau of a force, newton meters.
inline Vec3 falcon_torque(const Mat3& metres_per_rad, const Vec3& force_n) noexcept { return force_n * metres_per_rad; }

/// Returns the motor counts to send; zero where the torque is not finite.
FalconCounts falcon_motor_counts(const Vec3& torque_nm, double gain) noexcept;

}  // namespace catena::haptics::usb
