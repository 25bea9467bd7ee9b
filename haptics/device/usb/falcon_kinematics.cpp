// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_kinematics.h"

#include <glm/matrix.hpp>
#include <numbers>

namespace catena::haptics::usb {
namespace {

// meters
constexpr double kA = 0.060, kB = 0.1025, kC = 0.01443, kDE = 0.01125 + 0.01125, kF = -0.025, kR = 0.040, kS = -0.02309;
constexpr double kRadians = std::numbers::pi / 180;
constexpr double kAngleAtZero = 35 * kRadians, kAnglePerCount = 0.0364347 * kRadians;
constexpr Vec3 kStart{0, 0, 0.11};
constexpr double kConverged = 1e-12;  // rad
constexpr double kNear = 1e-6;        // rad, in intermediate steps
constexpr int kSteps = 16, kHalves = 12, kParts = 16;

struct Leg {
  double cosine, sine;  // cosine and sine of phi
};
const std::array<Leg, 3> kLegs = {{{std::cos(105 * kRadians), std::sin(105 * kRadians)},
                                   {std::cos(-15 * kRadians), std::sin(-15 * kRadians)},
                                   {std::cos(-135 * kRadians), std::sin(-135 * kRadians)}}};

// Position p in a leg's own frame, and the length of its parallelogram in the leg's plane.
struct InLeg {
  double u_c, w;              // u + c, w
  double length, dlength_dv;  // L, dL/dv; NaN out of reach
};

InLeg in_leg(const Leg& leg, const Vec3& p) noexcept {
  const double v = -p.x * leg.sine + p.y * leg.cosine - kS;
  const double across = v + kF, along = std::sqrt(kB * kB - across * across);
  return {p.x * leg.cosine + p.y * leg.sine - kR + kC, p.z, kDE + along, -across / along};
}

}  // namespace

Vec3 falcon_angles(const Vec3& encoders) noexcept { return Vec3(kAngleAtZero) + encoders * kAnglePerCount; }

Vec3 falcon_angles(const FalconCounts& encoders) noexcept {
  return falcon_angles(Vec3{static_cast<double>(encoders[0]), static_cast<double>(encoders[1]), static_cast<double>(encoders[2])});
}

Vec3 falcon_encoders(const Vec3& angles) noexcept { return (angles - Vec3(kAngleAtZero)) / kAnglePerCount; }

bool falcon_inverse_kinematics(const Vec3& position_m, Vec3& angles) noexcept {
  Vec3 found;
  for (int i = 0; i < 3; ++i) {
    const InLeg q = in_leg(kLegs[static_cast<std::size_t>(i)], position_m);
    const double reach = std::hypot(q.u_c, q.w);
    found[i] = std::atan2(q.w, q.u_c) - std::acos((kA * kA + reach * reach - q.length * q.length) / (2 * kA * reach));
  }
  if (!is_finite(found)) return false;
  angles = found;
  return true;
}

namespace {

// Computes the matrix with rows d theta_i / dp.
bool inverse_jacobian(const Vec3& position_m, const Vec3& angles, Mat3& rad_per_metre) noexcept {
  for (int i = 0; i < 3; ++i) {
    const Leg& leg = kLegs[static_cast<std::size_t>(i)];
    const InLeg q = in_leg(leg, position_m);
    const double cosine = std::cos(angles[i]), sine = std::sin(angles[i]);
    const double du = q.u_c - kA * cosine, dw = q.w - kA * sine, dv = -q.length * q.dlength_dv;  // dg/d(u, v, w) / 2
    const double dtheta = kA * (du * sine - dw * cosine);                                        // dg/d theta / 2
    rad_per_metre[0][i] = -(du * leg.cosine - dv * leg.sine) / dtheta;
    rad_per_metre[1][i] = -(du * leg.sine + dv * leg.cosine) / dtheta;
    rad_per_metre[2][i] = -dw / dtheta;
  }
  return is_finite(rad_per_metre[0]) && is_finite(rad_per_metre[1]) && is_finite(rad_per_metre[2]);
}

}  // namespace

bool falcon_jacobian(const Vec3& position_m, const Vec3& angles, Mat3& metres_per_rad) noexcept {
  Mat3 rows;
  if (!inverse_jacobian(position_m, angles, rows)) return false;
  const Mat3 inverted = glm::inverse(rows);
  if (!is_finite(inverted[0]) || !is_finite(inverted[1]) || !is_finite(inverted[2])) return false;
  metres_per_rad = inverted;
  return true;
}

namespace {

// Newton's method from p with the angles `at`; each step is halved until it stays within reach and reduces the error.
bool newton(const Vec3& angles, double within, Vec3& p, Vec3& at) noexcept {
  double left = max_abs(angles - at);
  for (int step = 0; step < kSteps && left > within; ++step) {
    Mat3 jacobian;
    if (!falcon_jacobian(p, at, jacobian)) return false;
    Vec3 move = jacobian * (angles - at), next_at;
    bool nearer = false;
    for (int halves = 0; halves < kHalves && !nearer; ++halves, move *= 0.5) {
      nearer = falcon_inverse_kinematics(p + move, next_at) && max_abs(angles - next_at) < left;
      if (nearer) p += move;
    }
    if (!nearer) return false;
    at = next_at;
    left = max_abs(angles - at);
  }
  return left <= within;
}

}  // namespace

bool falcon_forward_kinematics(const Vec3& angles, Vec3& position_m) noexcept {
  if (!is_finite(angles)) return false;
  Vec3 start_angles;
  if (!falcon_inverse_kinematics(kStart, start_angles)) return false;
  Vec3 p = kStart, at = start_angles;
  bool found = newton(angles, kConverged, p, at);
  // at the rim: continuation along a straight line in the angles, so that Newton's method stays on the mechanism's branch
  if (!found) {
    p = kStart;
    at = start_angles;
    found = true;
    for (int part = 1; part <= kParts && found; ++part)
      found =
          newton(start_angles + (angles - start_angles) * (static_cast<double>(part) / kParts), part < kParts ? kNear : kConverged, p, at);
  }
  // beyond the singular rim the solution belongs to another branch of the mechanism
  Mat3 jacobian;
  found = found && falcon_jacobian(p, at, jacobian) && glm::determinant(jacobian) < 0;
  if (found) position_m = p;
  return found;
}

FalconCounts falcon_motor_counts(const Vec3& torque_nm, double gain) noexcept {
  Vec3 counts = torque_nm * -gain;
  const double largest = max_abs(counts);
  if (!is_finite(counts) || !std::isfinite(largest)) return {};
  if (largest > kFalconFullTorque) counts *= kFalconFullTorque / largest;
  FalconCounts out{};
  for (int i = 0; i < 3; ++i) {
    const double rounded = std::clamp(std::nearbyint(counts[i]), -double{kFalconFullTorque}, double{kFalconFullTorque});
    out[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(rounded);
  }
  return out;
}

}  // namespace catena::haptics::usb
