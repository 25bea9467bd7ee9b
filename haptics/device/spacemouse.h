// SPDX-License-Identifier: MIT
/// 3Dconnexion SpaceMouse through libspnav and its daemon spacenavd: six axes in, no force. The cap springs back, so it controls rates:
///   x += v dt,  q = exp(w dt) q,  v = v_max r(t),  w = w_max r(r),  r(c) = 0 within the dead zone, then linearly to 1 at 350 counts
/// Workspace axes, right-handed: x to the right, y up, z towards the user. spacenavd counts z away from the user (left-handed), so
///   (x, y, z) = (tx, ty, -tz),  rotations (rx, ry, -rz)   as libspnav's own spnav_posrot_moveobj
/// The position stays within the workspace. A thread of the device talks to the daemon; the tick only takes the newest counts. Without the
/// daemon: status lost, the probe rests; the daemon is polled for twice a second. libspnav supports one connection per program.
#pragma once
#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "engine/base/result.h"
#include "engine/base/triple_buffer.h"
#include "haptics/device/device.h"

namespace catena::haptics {

/// Parameters of a SpaceMouse.
struct SpaceMouseParameters {
  double speed_m_per_s = 0.1;    ///< speed at full deflection
  double turn_rad_per_s = 1.5;   ///< angular velocity at full deflection
  double dead_zone_counts = 15;  ///< deflection below which the output is zero; full deflection: 350 counts
  double rate_hz = 1000;         ///< tick rate of the servo that reads it
};

/// Newest state of the daemon: counts of the axes tx ty tz rx ry rz, and buttons held.
struct SpaceMouseCounts {
  std::array<std::int32_t, 6> axes{};
  std::uint32_t buttons = 0;
  bool connected = false;
};

/// Linear and angular velocity of the probe.
struct SpaceMouseRates {
  Vec3 velocity_m_per_s{0.0}, turn_rad_per_s{0.0};
};
/// Returns the rates of a deflection: dead zone, scaling, and change of axes as above.
SpaceMouseRates compute_spacemouse_rates(const SpaceMouseCounts& counts, const SpaceMouseParameters& parameters) noexcept;

/// The device. libspnav and the daemon: the device's thread; read and write: haptic thread.
class SpaceMouse final : public Device {
 public:
  /// Connects to the daemon and starts the thread; an Error where the daemon is missing says what to do.
  static Result<std::unique_ptr<Device>> open(const SpaceMouseParameters& parameters);
  static DeviceCapabilities nominal_capabilities();
  /// Returns whether the daemon's socket exists.
  static bool is_daemon_available();
  /// Returns what to do if it does not.
  static const char* daemon_missing_hint();
  ~SpaceMouse() override;

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput&) noexcept override {}

 private:
  explicit SpaceMouse(const SpaceMouseParameters& parameters);
  void listen();          ///< body of the device's thread
  bool receive_events();  ///< false: the connection to the daemon is lost
  void publish(bool connected);

  SpaceMouseParameters parameters_;
  DeviceCapabilities capabilities_;
  TripleBuffer<SpaceMouseCounts> counts_;

  // haptic thread
  Vec3 position_m_{0.0};
  Quat orientation_{kIdentityRotation};

  // the device's thread
  SpaceMouseCounts current_counts_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace catena::haptics
