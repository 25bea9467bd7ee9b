/// What the servo needs of a haptic device: the pose in, force and torque out. Metres, newtons, the device's own axes.
/// `read` and `write` run on the haptic thread: no allocation, lock or throw, and they return at once (a device that must wait
/// for its bus does so in a thread of its own). `stop` may be called from any thread, at any time.
#pragma once
#include <cstdint>
#include <string>

#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::haptics {

/// Whether the device can be used in this tick.
enum class DeviceStatus : std::uint8_t {
  ready,     ///< the pose is good
  starting,  ///< not there yet: firmware, homing; the servo sends zero
  lost       ///< unplugged or silent; the servo sends zero in that tick. It may come back
};

/// What a device says of the hand.
struct DeviceInput {
  Vec3 position_m{0.0};                       ///< where the hand is; of a recorded path: world units
  Quat orientation{kIdentityRotation};        ///< of the grip; the identity where the device has none
  std::uint32_t buttons = 0;                  ///< bit n - 1: button n is held
  DeviceStatus status = DeviceStatus::ready;  ///< whether the pose is good
  bool forces_on = true;                      ///< the hand's own switch; false also while it clutches
  double age_s = 0;                           ///< of the pose
  bool is_recorded = false;                   ///< a recorded path brings its own time, and its position is in world units already
  double t_s = 0;                             ///< seconds; of a recorded path
};

/// What the hand gets.
struct DeviceOutput {
  Vec3 force_n{0.0};          ///< newtons, the device's axes
  Vec3 torque_nm{0.0};        ///< N m, the device's axes
  bool forces_active = true;  ///< false: the forces are off or stopped, and nothing may be added to the zero (gravity compensation)
  double accounted_j = 0;  ///< of all links: given to the hand and ready for it (haptics/chain/passivity.h); falls by what friction takes
  Vec3 requested_force_n{
      0.0};  ///< what the links push with, before damping of the hand, limits and ramps: for what tells of force in other ways
};

/// The mechanism as the servo's stability sees it: what bounds the stiffness that it can show.
struct Mechanics {
  double mass_kg = 0.15;  ///< that a hand moves with it
  /// Viscous, of the device alone. 0: not known. Then no spring is safe, compute_device_limits() allows a stiffness of 0, and nothing is
  /// felt until it is stated, or a stiffness_cap.
  double damping_ns_per_m = 0;
  double friction_n = 0;                      ///< Coulomb; where there is an encoder step, 0 means not known here too
  double encoder_step_m = 0;                  ///< 0: continuous
  double delay_s = 0;                         ///< from the pose to the force, beside the tick's own period
  double rotational_damping_nms_per_rad = 0;  ///< viscous, about any axis; where the device has torque
};

/// What a device can do. Constant while it is open.
struct DeviceCapabilities {
  std::string name;              ///< for people
  double workspace_m = 0.2;      ///< edge of a cube that the hand reaches
  Vec3 workspace_center_m{0.0};  ///< middle of that cube
  bool has_orientation = false;  ///< the grip's orientation is measured
  int button_count = 1;          ///< how many
  bool has_vibration = false;    ///< what it has in place of force: a person feels how the force changes
  double max_force_n = 0;        ///< 0: no force output (pseudo-haptics only)
  double max_torque_nm = 0;      ///< 0: no torque output
  Mechanics mechanics{};         ///< what bounds the stiffness that it can show
};

/// A device. The program owns it; it outlives the servo.
class Device {
 public:
  virtual ~Device() = default;
  /// What a person must know or do now, one line ("Falcon: pull the grip fully out, then push it in"); empty: nothing. Frame thread.
  virtual std::string status_text() const { return {}; }
  /// What it can do. Any thread.
  virtual const DeviceCapabilities& capabilities() const = 0;
  /// The newest pose. Haptic thread.
  virtual DeviceInput read() noexcept = 0;
  /// The force of this tick. Haptic thread.
  virtual void write(const DeviceOutput& output) noexcept = 0;
  /// Zero force now and until resume(), whatever is written. Any thread (the servo's watchdog; the servo at its end).
  virtual void stop() noexcept {}
  /// After stop(): the hand has been told to hold no force, and has confirmed it. Safe in a signal handler.
  virtual bool zero_force_confirmed() const noexcept { return true; }
  /// What is written counts again. Haptic thread: before the servo's first tick, and in the first normal tick after a stop; the
  /// guard starts that tick's force at zero.
  virtual void resume() noexcept {}
  /// Whether a file that the device itself writes is whole so far; an error says what is lost and why. Any thread but the haptic one.
  virtual Outcome check_output_files() const { return Done{}; }
};

/// No device: the probe rests at the origin, forces go nowhere. Haptic thread.
class NullDevice final : public Device {
 public:
  NullDevice() { capabilities_.name = "null"; }
  /// No force.
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  /// The origin.
  DeviceInput read() noexcept override { return {}; }
  /// Nothing happens.
  void write(const DeviceOutput&) noexcept override {}

 private:
  DeviceCapabilities capabilities_;
};

}  // namespace catena::haptics
