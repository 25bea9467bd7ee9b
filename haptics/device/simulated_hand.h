/// A device without hardware: a point mass held by a hand (spring and damper toward a scripted path) that feels the force.
///   m a = k_h (x_path - x) + b_h (v_path - v) + F,   semi-implicit Euler at the tick's period
/// Deterministic: the same path and forces give the same bits. Haptic thread.
#pragma once
#include <vector>

#include "haptics/device/device.h"

namespace catena::haptics {

struct HandParameters {
  double mass_kg = 0.15;
  double stiffness_n_per_m = 500;  ///< of the hand's grip toward where it wants to be
  double damping_ns_per_m = 5;
  double period_s = 1e-3;
};

class SimulatedHand final : public Device {
 public:
  struct Waypoint {
    double t_s = 0;
    Vec3 position_m{0.0};
    std::uint32_t buttons = 0;
  };
  /// `path` has at least one waypoint, t rising; between them the wish moves linearly, after the last it rests.
  SimulatedHand(std::vector<Waypoint> path, const HandParameters& parameters);

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput& output) noexcept override;

  const Vec3& position_m() const { return position_m_; }

 private:
  Vec3 wish(double t_s, Vec3& velocity) noexcept;

  std::vector<Waypoint> path_;
  HandParameters parameters_;
  DeviceCapabilities capabilities_;
  std::size_t segment_ = 0;
  std::uint64_t ticks_ = 0;
  Vec3 position_m_{0.0}, velocity_{0.0}, force_n_{0.0};
};

}  // namespace catena::haptics
