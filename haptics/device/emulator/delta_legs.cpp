#include "haptics/device/emulator/delta_legs.h"

#include <numbers>

namespace catena::haptics {
namespace {

constexpr double kA = 0.060, kB = 0.1025, kC = 0.01443, kDE = 0.01125 + 0.01125, kF = -0.025, kR = 0.040, kS = -0.02309;
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLegDegrees[3] = {105, -15, -135};

}  // namespace

std::optional<DeltaLegs> delta_legs(const Vec3& grip_m) {
  DeltaLegs legs;
  for (int i = 0; i < 3; ++i) {
    const double cos_phi = std::cos(kLegDegrees[i] * kDegree), sin_phi = std::sin(kLegDegrees[i] * kDegree);
    const double u = grip_m.x * cos_phi + grip_m.y * sin_phi - kR;
    const double v = -grip_m.x * sin_phi + grip_m.y * cos_phi - kS;
    const double w = grip_m.z;
    const double cos_3 = (v + kF) / kB, sin_3 = std::sqrt(1 - cos_3 * cos_3);
    const double length = kDE + kB * sin_3;
    const double radius = std::hypot(u + kC, w);
    const double cosine = (kA * kA + radius * radius - length * length) / (2 * kA * radius);
    const double sine = std::sqrt(1 - cosine * cosine);
    legs.theta[i] = std::atan2(w, u + kC) - std::acos(cosine);
    // d acos(q) = -dq / sqrt(1 - q^2);  q depends on R and L
    const double cosine_by_radius = (1 - (kA * kA - length * length) / (radius * radius)) / (2 * kA);
    const double cosine_by_length = -length / (kA * radius);
    const double theta_by_u = -w / (radius * radius) + cosine_by_radius * (u + kC) / radius / sine;
    const double theta_by_w = (u + kC) / (radius * radius) + cosine_by_radius * w / radius / sine;
    const double theta_by_v = cosine_by_length * (-cos_3 / sin_3) / sine;
    const Vec3 row{theta_by_u * cos_phi - theta_by_v * sin_phi, theta_by_u * sin_phi + theta_by_v * cos_phi, theta_by_w};
    if (!std::isfinite(legs.theta[i]) || !is_finite(row)) return std::nullopt;
    for (int j = 0; j < 3; ++j) legs.theta_by_p[j][i] = row[j];
  }
  return legs;
}

Vec3 counts_of_angles(const Vec3& theta) { return (theta / kDegree - Vec3(kEmulatedDegreesAtZero)) / kEmulatedDegreesPerCount; }

Vec3 force_of_motors(const DeltaLegs& legs, const std::array<int, 3>& counts) {
  const Vec3 tau = Vec3(counts[0], counts[1], counts[2]) * (-1 / kEmulatedCountsPerNm);
  return tau * legs.theta_by_p;  // GLM: v * M = M^T v
}

}  // namespace catena::haptics
