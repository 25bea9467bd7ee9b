// SPDX-License-Identifier: MIT
/// Interface between the servo and a haptic device: the pose in, force and torque out. Meters, newtons, the device's own axes.
/// `read` and `write` run on the haptic thread: no allocation, lock or throw, and they return at once (a device that must wait
/// for its bus does so in a thread of its own). `stop` may be called from any thread, at any time.
#pragma once
#include <cstdint>
#include <string>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::haptics {

/// State of the device in this tick.
enum class DeviceStatus : std::uint8_t {
  ready,     ///< the pose is valid
  starting,  ///< not operational yet: loading firmware, homing; the servo sends zero
  lost       ///< disconnected or unresponsive; the servo sends zero in that tick; it may become ready later
};

/// Input of one tick from the device.
struct DeviceInput {
  Vec3 position_m{0.0};                       ///< position of the probe, device axes; of a recorded path: world units
  Quat orientation{kIdentityRotation};        ///< orientation of the grip; the identity if the device does not measure it
  std::uint32_t buttons = 0;                  ///< bit n - 1: button n is held
  DeviceStatus status = DeviceStatus::ready;  ///< whether the pose is valid
  bool forces_on = true;                      ///< the user's force switch; false also while the clutch is held
  double age_s = 0;                           ///< age of the pose, seconds
  bool is_recorded = false;                   ///< from a recorded path: it provides its own time, and its position is in world units
  double t_s = 0;                             ///< time of the sample, seconds; of a recorded path only
};

/// Output of one tick to the device: the commanded force, after the force limiter.
struct DeviceOutput {
  Vec3 force_n{0.0};          ///< newtons, the device's axes
  Vec3 torque_nm{0.0};        ///< N m, the device's axes
  bool forces_active = true;  ///< false: the forces are off or stopped, and nothing (such as gravity compensation) may be added to the zero
  /// Energy of all links, joules: delivered to the user and still stored (haptics/chain/passivity.h); decreases by what friction
  /// dissipates.
  double accounted_j = 0;
  /// Force that the links request, before damping, limits and ramps: for output by other means, such as vibration.
  Vec3 requested_force_n{0.0};
};

/// Parameters of the mechanism that bound the stiffness that the device can render stably.
struct Mechanics {
  double mass_kg = 0.15;  ///< effective mass at the probe
  /// Viscous damping of the device alone. 0: unknown; then no spring is safe, compute_device_limits() allows a stiffness of 0, and there is
  /// no force until this value or a stiffness_cap is stated.
  double damping_ns_per_m = 0;
  double friction_n = 0;                      ///< Coulomb friction; with an encoder step, 0 means unknown here too
  double encoder_step_m = 0;                  ///< position resolution; 0: continuous
  double delay_s = 0;                         ///< from the pose to the force, in addition to the period of the tick
  double rotational_damping_nms_per_rad = 0;  ///< viscous, about any axis; for devices with torque output
};

/// Capabilities of a device. Constant while it is open.
struct DeviceCapabilities {
  std::string name;              ///< display name
  double workspace_m = 0.2;      ///< edge of the cube of reachable positions, device axes
  Vec3 workspace_center_m{0.0};  ///< center of that cube
  bool has_orientation = false;  ///< the grip's orientation is measured
  int button_count = 1;          ///< number of buttons
  bool has_vibration = false;    ///< vibrates in place of force output: changes of the force become vibration
  double max_force_n = 0;        ///< 0: no force output (pseudo-haptics only)
  double max_torque_nm = 0;      ///< 0: no torque output
  Mechanics mechanics{};         ///< bounds of the stiffness
};

/// A haptic device. Owned by the program; it outlives the servo.
class CATENA_EXPORT Device {
 public:
  virtual ~Device() = default;
  /// Returns what the user must know or do, in one line ("Falcon: pull the grip fully out, then push it in"); empty: nothing. Frame thread.
  virtual std::string status_text() const { return {}; }
  /// Returns what the device can do. Any thread.
  virtual const DeviceCapabilities& capabilities() const = 0;
  /// Returns the newest pose. Haptic thread.
  virtual DeviceInput read() noexcept = 0;
  /// Outputs the force of this tick. Haptic thread.
  virtual void write(const DeviceOutput& output) noexcept = 0;
  /// Sets zero force until resume(), whatever is written. Any thread (the servo's watchdog; the servo at its end).
  virtual void stop() noexcept {}
  /// Returns true after stop() when the zero force was sent to the device and the device has confirmed it. Safe in a signal handler.
  virtual bool zero_force_confirmed() const noexcept { return true; }
  /// Ends stop(): written forces take effect. Haptic thread: before the servo's first tick, and in the first normal tick after a stop; the
  /// force limiter starts that tick's force at zero.
  virtual void resume() noexcept {}
  /// Returns whether a file that the device itself writes is complete so far; an Error names what is lost and why. Any thread but the
  /// haptic thread.
  virtual Outcome check_output_files() const { return Done{}; }
};

/// No device: the probe rests at the origin, forces are discarded. Haptic thread.
class NullDevice final : public Device {
 public:
  NullDevice() { capabilities_.name = "null"; }
  /// Returns capabilities without force output.
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  /// Returns the pose at the origin.
  DeviceInput read() noexcept override { return {}; }
  /// Discards the output.
  void write(const DeviceOutput&) noexcept override {}

 private:
  DeviceCapabilities capabilities_;
};

}  // namespace catena::haptics
