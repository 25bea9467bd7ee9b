/// 3Dconnexion SpaceMouse through libspnav and its daemon spacenavd: six axes in, no force. The cap springs back, so that it steers
/// rates:  x += v dt,  q = exp(w dt) q,  v = v_max r(t),  w = w_max r(r),  r(c) = 0 within the dead zone, then evenly to 1 at 350 counts
/// Hand axes, right-handed: x to the right, y up, z towards the person. spacenavd counts z away from the person (left-handed), so
///   (x, y, z) = (tx, ty, -tz),  turns (rx, ry, -rz)   as libspnav's own spnav_posrot_moveobj
/// The place stays within the workspace. A thread of its own talks to the daemon; the tick only takes the newest counts. A daemon that
/// goes away: status lost, the hand stands still; it is looked for again twice a second. libspnav holds one connection a program.
#pragma once
#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "engine/base/result.h"
#include "engine/base/triple_buffer.h"
#include "haptics/device/device.h"

namespace catena::haptics {

struct SpaceMouseParameters {
  double speed_m_per_s = 0.1;    ///< at full deflection
  double turn_rad_per_s = 1.5;   ///< likewise
  double dead_zone_counts = 15;  ///< of 350
  double rate_hz = 1000;         ///< of the servo that reads it
};

/// What the daemon says: counts of the axes tx ty tz rx ry rz, buttons held.
struct SpaceMouseCounts {
  std::array<std::int32_t, 6> axes{};
  std::uint32_t buttons = 0;
  bool connected = false;
};

struct SpaceMouseRates {
  Vec3 velocity_m_per_s{0.0}, turn_rad_per_s{0.0};
};
SpaceMouseRates compute_spacemouse_rates(const SpaceMouseCounts& counts, const SpaceMouseParameters& parameters) noexcept;

class SpaceMouse final : public Device {
 public:
  static Result<std::unique_ptr<Device>> open(const SpaceMouseParameters& parameters);
  static DeviceCapabilities nominal_capabilities();
  static bool is_daemon_available();         ///< its socket exists
  static const char* daemon_missing_hint();  ///< what to do then
  ~SpaceMouse() override;

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput&) noexcept override {}

 private:
  explicit SpaceMouse(const SpaceMouseParameters& parameters);
  void listen();          ///< the thread
  bool receive_events();  ///< false: the daemon has gone
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
