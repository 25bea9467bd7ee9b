/// HapticSession is the hand in the window: it has the device that holds the probe (a haptic one, else the mouse), its servo, its
/// recording, and the program that the servo runs. The device may be another one, the program newer, a recording may begin and end, all
/// while the servo runs. The frame never waits for the servo, nor the servo for the frame. Frame thread.
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

class HapticSession {
 public:
  struct Options {
    /// The mouse, or a name of haptics/device/registry.h; empty: that of the scene's "device" if it is a thing on the desk, else the
    /// mouse. What is known and not plugged in leaves the probe to the mouse, and is said (note()).
    std::string device;
    std::string firmware;                    ///< falcon: before the scene's
    std::string recording_path;              ///< .catlog of every tick; empty: none
    std::vector<std::string> field_options;  ///< --field options, for the recording
    haptics::RealtimeOptions realtime;       ///< of the servo
    bool start_with_forces = false;          ///< the device may push from the first tick on, and no key changes that
    bool fall_back_to_mouse = true;          ///< the mouse steps in for a device that is not plugged in
    bool use_xr_controller = false;          ///< a headset's controller holds the probe, unless another device is asked for
  };

  explicit HapticSession(Options options) : options_(std::move(options)) {}
  ~HapticSession();

  /// Loads what the chain names.
  static Outcome load(scene::Scene& scene);
  /// Opens the device, before any window: what is wrong with it is said at once.
  Outcome open_device(const scene::Scene& scene);
  /// One line for the person, from opening the device; empty: nothing.
  const std::string& open_notice() const { return device_.note; }
  /// Fits the workspace, makes the program and the servo. `bounds`: of what is drawn and felt; `text`: the scene's, for the recording.
  Outcome prepare(scene::Scene& scene, const Bounds& bounds, const RecordedScene& text);
  /// Another scene, while the servo runs: as prepare, with the device and the servo that there are. Ends a recording.
  Outcome switch_scene(scene::Scene& scene, const Bounds& bounds);
  Outcome start();
  void stop();
  /// Stops, writes what is asked for.
  Outcome finish(const std::string& servo_stats);

  /// Whether the scene's program can be made: its links' keys are read here, not where the scene is.
  Outcome validate(scene::Scene& scene) const;
  /// The program of the scene as it is now; the servo goes on with it at its next tick. Links that have not changed keep their state. An
  /// error leaves the old one. `text`: the scene's, for the recording.
  Outcome publish(scene::Scene& scene, const std::string& text);

  /// Another device from now on, by its name; its forces are off. An error leaves the one that there is. Ends a recording.
  Outcome switch_device(scene::Scene& scene, const std::string& name, const Bounds& bounds);

  /// What the servo gets in place of a recording's sink, and hands every tick on to it.
  using WrapSink = std::function<haptics::TickSink*(haptics::TickSink*)>;
  /// Every tick from the next one on. An error: nothing is recorded.
  Outcome record(const std::string& path, RecordedScene scene, const WrapSink& around = {});
  Outcome stop_recording();

  /// The newest state into the scene's cursor and widgets, if there is one; true where it would change the picture.
  bool pull_state(scene::Scene& scene);
  const HapticState& latest_state() const { return latest_state_; }
  const std::vector<std::string>& link_names() const { return link_names_; }
  const std::shared_ptr<const haptics::HapticProgram>& program() const { return program_; }

  bool is_mouse() const { return mouse_ != nullptr; }
  /// The headset's controller, where that is the device: the frame tells it where it is; null otherwise.
  haptics::TrackedController* controller() const { return dynamic_cast<haptics::TrackedController*>(device_.device.get()); }
  /// Of a picture that a headset is about to show, into the recording if there is one.
  void record_poses(haptics::log::LogPoses poses) {
    poses.tick = latest_state_.tick;
    recording_.add_poses(poses);
  }
  void move_mouse(const scene::Scene& scene, const Vec3& world, std::uint32_t buttons);
  /// What holds a mouse back, for the next motion of the hand.
  void update_resistance(const scene::Scene& scene, Navigation& controls) const;
  const Vec3& initial_probe() const { return initial_probe_; }
  bool forces_enabled() const { return servo_ && forces_enabled_; }
  void set_forces_enabled(bool on);
  /// While the world moves under a hand that rests there is no force, whatever forces() says; afterwards it rises from zero. True: as it
  /// is wished, no force is left or it may rise again.
  bool suspend_forces(bool off);
  /// Where the device's handle is, metres of the hand; nothing where it is not ready, or no state of this program has come yet.
  std::optional<Vec3> handle_position_m() const;
  /// Where the device stands in a headset's room, once that is known.
  const std::optional<haptics::DeviceSettings::RoomRegistration>& room() const { return device_.settings.room_registration; }
  void set_room(const std::optional<haptics::DeviceSettings::RoomRegistration>& room) { device_.settings.room_registration = room; }
  void report_forces() const;

  const HapticDeviceSetup& device() const { return device_; }
  const std::string& device_name() const { return device_name_; }  ///< as it was opened: "mouse", "falcon:1"
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
  haptics::MouseDevice* mouse_ = nullptr;  ///< hand_.device, if that is the mouse: the frame moves it
  Recording recording_;
  std::optional<CrashGuard> crash_guard_;
  std::unique_ptr<haptics::Servo> servo_;
  bool forces_enabled_ = false, forces_suspended_ = false;
  std::shared_ptr<const haptics::HapticProgram> program_;
  std::vector<std::string> link_names_;
  HapticState latest_state_;
  Vec3 initial_probe_{0.0};
  scene::Workspace scene_workspace_;  ///< the scene's, before it was fitted to the device
};

}  // namespace catena::app
