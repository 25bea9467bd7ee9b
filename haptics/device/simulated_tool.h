/// A device with orientation and torque, without hardware: any device for the position, with a rigid grip that a hand holds and turns.
///   J w' = k_h log(q_wish q^-1) + b_h (w_wish - w) - b w + torque,   q' = w q;   semi-implicit Euler in `substeps` of the period, the
///   torque held between two ticks: what a mechanism does, whence the limit of a stiffness that it shows is close to 2 b / T
/// Between waypoints the wish turns evenly, the shorter way; after the last it rests. One inertia about every axis. Deterministic.
/// N m, radians, the device's axes. Haptic thread.
#pragma once
#include <memory>
#include <vector>

#include "haptics/device/device.h"

namespace catena::haptics {

struct ToolParameters {
  double inertia_kg_m2 = 1e-4;
  double damping_nms_per_rad = 5e-4;       ///< b, of the mechanism
  double grip_stiffness_nm_per_rad = 0.5;  ///< k_h, of the hand
  double grip_damping_nms_per_rad = 5e-3;  ///< b_h
  double max_torque_nm = 0.5;              ///< it cannot give more
  double period_s = 1e-3;
  int substeps = 20;
};

class SimulatedTool final : public Device {
 public:
  struct Waypoint {
    double t_s = 0;
    Quat orientation{kNoRotation};
  };
  /// `path` has at least one waypoint, t rising.
  SimulatedTool(std::unique_ptr<Device> position, std::vector<Waypoint> path, const ToolParameters& parameters);

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput& output) noexcept override;
  std::string status_text() const override { return position_->status_text(); }
  void stop() noexcept override { position_->stop(); }
  bool at_rest() const noexcept override { return position_->at_rest(); }
  void resume() noexcept override { position_->resume(); }

  const Quat& orientation() const { return orientation_; }
  const Vec3& rate_rad_per_s() const { return rate_; }
  void set_rate(const Vec3& rad_per_s) { rate_ = rad_per_s; }  ///< a kick, for tests

 private:
  Quat wish(double t_s, Vec3& rate) noexcept;

  std::unique_ptr<Device> position_;
  std::vector<Waypoint> path_;
  ToolParameters parameters_;
  DeviceCapabilities capabilities_;
  std::size_t segment_ = 0;
  std::uint64_t ticks_ = 0;
  Quat orientation_{kNoRotation};
  Vec3 rate_{0.0}, torque_nm_{0.0};
};

}  // namespace catena::haptics
