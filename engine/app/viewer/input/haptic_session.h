// SPDX-License-Identifier: MIT
/// The haptic session of a window: owns the device that moves the probe (a haptic device, else the mouse), its servo, the recording, and
/// the program that the servo runs. Device, program and recording can be replaced while the servo runs.
/// The frame thread never waits for the servo, nor the servo for the frame thread. Frame thread.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/app/haptics/recording.h"
#include "engine/app/haptics/signal_handlers.h"
#include "haptics/device/controller.h"
#include "haptics/device/mouse.h"
#include "haptics/device/registry.h"

namespace catena::app {

struct Navigation;

/// Owns device, servo, program and recording.
class HapticSession {
 public:
  struct Options {
    /// "mouse" or a name of haptics/device/registry.h; empty: the type of the scene's "device" if that is hardware, else the mouse. If
    /// known hardware is not connected, the mouse is used, which open_notice() reports.
    std::string device;
    std::string firmware;                    ///< For falcon: takes precedence over the scene's.
    std::string recording_path;              ///< Path of a .catlog with every tick; empty: none.
    std::vector<std::string> field_options;  ///< Options --field, for the recording.
    haptics::RealtimeOptions realtime;       ///< Scheduling options of the servo thread.
    bool start_with_forces = false;          ///< The device may render forces from the first tick on, without a key.
    bool fall_back_to_mouse = true;          ///< Use the mouse if a device is not connected.
    bool use_xr_controller = false;          ///< An XR controller is the device, unless another one is requested.
  };

  explicit HapticSession(Options options) : options_(std::move(options)) {}
  /// Stops the servo.
  ~HapticSession();

  /// Loads the fields and meshes that the chain refers to. An Error if that fails.
  static Outcome load(scene::Scene& scene);
  /// Opens the device, before any window is opened. An Error if it cannot be opened.
  Outcome open_device(const scene::Scene& scene);
  /// Returns a message for the user from opening the device, one line; empty: none.
  const std::string& open_notice() const { return device_.note; }
  /// Fits the workspace, builds the program and makes the servo. `bounds`: of everything visible and haptic; `text`: the scene's text for
  /// the recording. An Error if the program cannot be built or the recording not be opened.
  Outcome prepare(scene::Scene& scene, const Bounds& bounds, const RecordedScene& text);
  /// Replaces the scene while the servo runs, keeping device and servo; otherwise as prepare(). Ends a recording.
  Outcome switch_scene(scene::Scene& scene, const Bounds& bounds);
  /// Starts the servo, with a crash guard for a haptic device. An Error if it cannot be started.
  Outcome start();
  /// Stops the servo.
  void stop();
  /// Stops the servo, ends the recording and writes servo statistics. An Error if a file cannot be written.
  Outcome finish(const std::string& servo_stats);

  /// Returns an Error if the scene's haptic program cannot be built: the keys of links are validated here, not when the scene is read.
  Outcome validate(scene::Scene& scene) const;
  /// Builds the program of the current scene; the servo uses it from its next tick on. Unchanged links keep their state. An Error leaves
  /// the old program. `text`: the scene's text for the recording.
  Outcome publish(scene::Scene& scene, const std::string& text);

  /// Replaces the device by name; the forces of the new one are off. An Error leaves the current device. Ends a recording.
  Outcome switch_device(scene::Scene& scene, const std::string& name, const Bounds& bounds);

  /// Wraps the sink of a recording: returns the sink that the servo gets, which must pass every tick on to the given one.
  using WrapSink = std::function<haptics::TickSink*(haptics::TickSink*)>;
  /// Starts recording every tick from the next one on. An Error means that nothing is recorded.
  Outcome record(const std::string& path, RecordedScene scene, const WrapSink& around = {});
  /// Ends the recording, if any.
  Outcome stop_recording();

  /// Takes the latest haptic state, if there is a new one, into the scene's cursor and widgets; returns true if it would change the image.
  bool pull_state(scene::Scene& scene);
  const HapticState& latest_state() const { return latest_state_; }
  const std::vector<std::string>& link_names() const { return link_names_; }
  const std::shared_ptr<const haptics::HapticProgram>& program() const { return program_; }

  bool is_mouse() const { return mouse_ != nullptr; }
  /// Returns the XR controller if that is the device, so that the caller can pass it poses; else null.
  haptics::TrackedController* controller() const { return dynamic_cast<haptics::TrackedController*>(device_.device.get()); }
  /// Records the poses of a frame that a headset is about to display, if a recording is active.
  void record_poses(haptics::log::LogPoses poses) {
    poses.tick = latest_state_.tick;
    recording_.add_poses(poses);
  }
  /// Moves the probe of the mouse to a world position; without effect for another device.
  void move_mouse(const scene::Scene& scene, const Vec3& world, std::uint32_t buttons);
  /// Sets force and last proxy, which resist the next motion of a mouse.
  void update_resistance(const scene::Scene& scene, Navigation& controls) const;
  /// Returns the initial world position of the probe.
  const Vec3& initial_probe() const { return initial_probe_; }
  /// Returns whether forces are enabled by the user.
  bool forces_enabled() const { return servo_ && forces_enabled_; }
  /// Enables or disables forces; without effect for the mouse.
  void set_forces_enabled(bool on);
  /// Suspends forces while the world moves relative to the device, regardless of forces_enabled(); afterwards the force ramps up from zero.
  /// Returns true when the request is fulfilled: no force is left, or forces may rise.
  bool suspend_forces(bool off);
  /// Returns the position of the device's handle, device meters; nothing if the device is not ready, or no state of the current program has
  /// arrived.
  std::optional<Vec3> handle_position_m() const;
  /// Returns the pose of the device in the stage space of a headset, if registered.
  const std::optional<haptics::DeviceSettings::RoomRegistration>& room() const { return device_.settings.room_registration; }
  void set_room(const std::optional<haptics::DeviceSettings::RoomRegistration>& room) { device_.settings.room_registration = room; }
  /// Prints whether forces are on.
  void report_forces() const;

  const HapticDeviceSetup& device() const { return device_; }
  const std::string& device_name() const { return device_name_; }  ///< The name it was opened with: "mouse", "falcon:1".
  const haptics::Servo& servo() const { return *servo_; }
  const Recording& recording() const { return recording_; }
  const std::vector<std::string>& field_options() const { return options_.field_options; }
  const std::string& firmware() const { return options_.firmware; }

 private:
  Result<HapticDeviceSetup> open(const scene::Scene& scene, const std::string& name) const;
  void adopt_device(HapticDeviceSetup hand, const scene::Scene& scene, const Vec3& probe);
  void make_servo();
  void update_link_names(scene::Scene& scene);

  Options options_;
  HapticDeviceSetup device_;
  std::string device_name_ = "mouse";
  haptics::MouseDevice* mouse_ = nullptr;  ///< Points to device_.device if that is the mouse, which the frame thread moves; else null.
  /// The user has moved the probe of a mouse in this scene; until then it is not rendered and feels nothing.
  bool mouse_has_moved_ = false;
  Recording recording_;
  std::optional<CrashGuard> crash_guard_;
  std::unique_ptr<haptics::Servo> servo_;
  bool forces_enabled_ = false, forces_suspended_ = false;
  std::shared_ptr<const haptics::HapticProgram> program_;
  std::vector<std::string> link_names_;
  HapticState latest_state_;
  Vec3 initial_probe_{0.0};
  scene::Workspace scene_workspace_;  ///< The scene's own, before it was fitted to the device.
};

}  // namespace catena::app
