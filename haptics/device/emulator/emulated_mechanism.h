// SPDX-License-Identifier: MIT
/// The emulated Falcon's delta mechanism: the leg angles of a grip position, and the force of its motors.
/// Written from the published formulas, independently of the driver's kinematics, so that each verifies the other.
///   u = x cos(phi) + y sin(phi) - r,  v = -x sin(phi) + y cos(phi) - s,  w = z,  cos(theta3) = (v + f) / b
///   L = d + e + b sin(theta3),  R = hypot(u + c, w),  theta = atan2(w, u + c) - acos((a^2 + R^2 - L^2) / (2 a R))
/// Meters, radians, newtons, newton meters; z points away from the base. Off the tick, pure.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "engine/base/vec.h"

namespace catena::haptics {

inline constexpr double kEmulatedDegreesAtZero = 35, kEmulatedDegreesPerCount = 0.0364347;
inline constexpr double kEmulatedCountsPerNm = 1e4;

/// Leg angles at a grip position, and their derivative.
struct DeltaLegs {
  Vec3 theta{0.0};      ///< angles of the three motors, radians
  Mat3 dtheta_dp{1.0};  ///< radians per meter, d theta_i / d p_j: row i, column j (GLM: dtheta_dp[j][i])
};

/// Returns the leg angles; nullopt where the mechanism does not reach.
std::optional<DeltaLegs> solve_delta_legs(const Vec3& grip_m);

/// Returns encoder counts, not rounded.
Vec3 angles_to_counts(const Vec3& theta);

/// Returns the force at the grip of motor counts m, newtons: tau = -m / 1e4,  F = (dp/dtheta)^-T tau = (dtheta/dp)^T tau.
Vec3 compute_motor_force(const DeltaLegs& legs, const std::array<int, 3>& counts);

/// The mechanics of the emulated Falcon: a grip that is fixed at a position, or moved by a simulated user against the motors.
///   m a = k (target - x) + b (target' - v) + F_motors,   semi-implicit Euler; a step out of reach is not taken
/// Encoders: round(counts) plus an unknown offset until an axis is homed. An axis homes while homing is commanded, when its leg
/// crosses the index mark inwards (+600 counts, z = 0.161 m on the center line) after having been outside of it; then its offset is
/// removed, so the origin jumps.
/// Deterministic; owned by EmulatedFalcon. Meters, newtons, seconds.
///
/// The simulated user of the mechanism.
struct EmulatedUser {
  /// Target position and buttons held at a time.
  struct Waypoint {
    double t_s = 0;
    Vec3 position_m{0.0};
    unsigned buttons = 0;
  };
  std::vector<Waypoint> path;  ///< times increasing; the target moves linearly between them, and rests after the last
  double repeat_from_s = -1;   ///< >= 0: after the last waypoint the script repeats from this time, seconds
  double mass_kg = 0.15;
  double stiffness_n_per_m = 300;
  double damping_ns_per_m = 6;
};

/// The mechanism: grip, legs, encoders and homing.
class EmulatedMechanism {
 public:
  using Counts = std::array<int, 3>;
  explicit EmulatedMechanism(const Counts& power_on_offset) : offset_(power_on_offset) {}

  /// Fixes the grip at a position, at rest. False, and nothing changes, where the mechanism does not reach.
  bool hold(const Vec3& position_m);
  void hold_buttons(unsigned buttons) { buttons_ = buttons; }
  /// Lets a simulated user move the grip from the start of its path.
  void attach_user(const EmulatedUser& hand);

  /// Advances by dt_s with the given motor counts; `homing`: the homing bit of the command.
  void advance(double dt_s, const Counts& motors, bool homing);
  void power_off(const Counts& power_on_offset);  ///< loses the homing; the encoders restart with the given offset
  void set_homed();

  Counts encoders() const;
  unsigned homed_bits() const { return homed_; }  ///< bit i: axis i
  unsigned buttons() const { return buttons_; }
  const Vec3& position_m() const { return position_m_; }
  const DeltaLegs& legs() const { return legs_; }

 private:
  static constexpr double kIndexCounts = 600;

  Vec3 target_at(Vec3& velocity);
  bool set_position(const Vec3& position_m);

  Counts offset_;
  unsigned homed_ = 0, outside_ = 0, buttons_ = 0;
  Vec3 position_m_{0, 0, 0.11}, velocity_{0.0};
  DeltaLegs legs_ = *solve_delta_legs({0, 0, 0.11});
  EmulatedUser user_;
  double t_s_ = 0;
  std::size_t segment_ = 0;
};

}  // namespace catena::haptics
