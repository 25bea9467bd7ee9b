// SPDX-License-Identifier: MIT
/// A device with orientation and torque, without hardware: any device for the position, with a rigid grip that a simulated user turns.
///   J w' = k_h log(q_target q^-1) + b_h (w_target - w) - b w + torque,   q' = w q;   semi-implicit Euler in `substeps` of the period, the
///   torque held between two ticks as in a real mechanism, so that the maximum stable stiffness is close to 2 b / T
/// Between waypoints the target orientation is interpolated along the shorter arc; after the last it rests. One inertia about every axis.
/// Deterministic. N m, radians, the device's axes. Haptic thread.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "haptics/device/device.h"
#include "haptics/device/mass_model.h"

namespace catena::haptics {

/// Parameters of a SimulatedTool.
struct SimulatedToolParameters {
  double inertia_kg_m2 = 1e-4;
  double damping_nms_per_rad = 5e-4;       ///< b, of the mechanism
  double grip_stiffness_nm_per_rad = 0.5;  ///< k_h, of the user's grip
  double grip_damping_nms_per_rad = 5e-3;  ///< b_h, of the user's grip
  double max_torque_nm = 0.5;              ///< saturation of the motors
  double period_s = 1e-3;
  int substeps = 20;
};

/// The device: position and buttons from the given device, orientation and torque simulated.
class SimulatedTool final : public Device {
 public:
  /// Target orientation of the user at a time.
  struct Waypoint {
    double t_s = 0;
    Quat orientation{kIdentityRotation};
  };
  /// `path` has at least one waypoint, times increasing.
  SimulatedTool(std::unique_ptr<Device> position, std::vector<Waypoint> path, const SimulatedToolParameters& parameters);

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput& output) noexcept override;
  std::string status_text() const override { return position_->status_text(); }
  void stop() noexcept override { position_->stop(); }
  bool zero_force_confirmed() const noexcept override { return position_->zero_force_confirmed(); }
  void resume() noexcept override { position_->resume(); }
  Outcome check_output_files() const override { return position_->check_output_files(); }

  const Quat& orientation() const { return orientation_; }
  const Vec3& rate_rad_per_s() const { return rate_; }
  void set_rate(const Vec3& rad_per_s) { rate_ = rad_per_s; }  ///< sets the angular velocity, for tests

 private:
  Quat target_at(double t_s, Vec3& rate) noexcept;

  std::unique_ptr<Device> position_;
  std::vector<Waypoint> path_;
  SimulatedToolParameters parameters_;
  DeviceCapabilities capabilities_;
  std::size_t segment_ = 0;
  std::uint64_t ticks_ = 0;
  Quat orientation_{kIdentityRotation};
  Vec3 rate_{0.0}, torque_nm_{0.0};
};

/// A device without hardware: a mechanism (mass, damping, Coulomb friction, encoders, delay, motors that saturate) held by a simulated user
/// (spring, damper and mass toward a target position on a scripted path, with tremor). mass_model.h has the model and its integration.
///   pose      the position at the tick, rounded to the encoder step
///   force     what was written at tick k acts from t_k + delay until the next one does: whole periods and fractions of one;
///             |F| at most max_force, direction kept
///   tremor    added to the target, per axis: four sines between 8 and 12 Hz, phases fixed, of the stated root mean square
/// Deterministic: the same path and forces give the same bits. Meters, device axes. Haptic thread.

/// Parameters of a SimulatedDevice. Defaults: ideal but for mass and grip; see desktop_device_parameters() for a real device.
struct SimulatedDeviceParameters {
  double mass_kg = 0.15;  ///< mass of the mechanism
  /// Stiffness of the grip, toward the user's target position; 0 with damping 0: the user does not hold the device.
  double grip_stiffness_n_per_m = 500;
  double grip_damping_ns_per_m = 5;  ///< damping of the grip
  double period_s = 1e-3;
  double hand_mass_kg = 0;  ///< effective mass of the user's hand, added to that of the mechanism
  double tremor_m = 0;      ///< root mean square, each axis
  double device_damping_ns_per_m = 0;
  double friction_n = 0;
  double encoder_step_m = 0;   ///< 0: continuous
  double delay_s = 0;          ///< maximum kMaxDelayPeriods periods
  double max_force_n = 100;    ///< saturation of the motors
  Vec3 velocity_m_per_s{0.0};  ///< initial velocity

  static constexpr int kMaxDelayPeriods = 62;
};

/// Returns a desktop mechanism of the kind that the linear limits of the literature are worked out for: 0.159 kg, 0.5 N s/m, 0.1 N,
/// encoder steps of 0.04 mm, no delay, 10 N. At 1 kHz its safe stiffness is 1000 N/m (mass_model.h).
SimulatedDeviceParameters desktop_device_parameters();

/// The simulated mechanism with its simulated user, as a Device.
class SimulatedDevice final : public Device {
 public:
  /// Target position of the user at a time, meters.
  struct Waypoint {
    double t_s = 0;
    Vec3 position_m{0.0};
    std::uint32_t buttons = 0;
  };
  /// `path` has at least one waypoint, times increasing; the mass starts at the first. Between waypoints the target moves linearly, after
  /// the last it rests.
  SimulatedDevice(std::vector<Waypoint> path, const SimulatedDeviceParameters& parameters);

  /// Sets the target position of the user for the next tick; it moves linearly from the last target. Replaces the path: to be called once
  /// per tick from the first tick on. Haptic thread.
  void set_target(const Vec3& position_m) noexcept;

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput& output) noexcept override;

  const Vec3& position_m() const { return mass_.position_m; }
  const Vec3& velocity_m_per_s() const { return mass_.velocity_m_per_s; }

 private:
  struct PartialStep {
    LinearStep step;
    int count = 0;
  };
  PartialStep make_partial_step(double length_s) const;
  Vec3 target_at(double t_s, Vec3& velocity) noexcept;
  void advance_partial(const PartialStep& part, const Vec3& force_n, double& t_s) noexcept;
  const Vec3& past_force(std::uint64_t ticks_ago) const noexcept;

  std::vector<Waypoint> path_;
  double start_s_ = 0;
  SimulatedDeviceParameters parameters_;
  DeviceCapabilities capabilities_;
  std::uint64_t delay_ticks_ = 0;           ///< whole periods of the delay
  PartialStep before_delay_, after_delay_;  ///< fraction of a period before the delayed force changes, and the rest
  std::size_t segment_ = 0;
  std::uint64_t ticks_ = 0;
  MassState mass_;
  std::array<Vec3, 64> force_history_{};  ///< written forces, by tick
};

}  // namespace catena::haptics
