/// The hand in the window: the device that holds the probe (a haptic one, else the mouse), its servo, its recording, and the program that
/// the servo runs. The frame never waits for the servo, nor the servo for the frame. Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/hand/crash_guard.h"
#include "engine/app/hand/open_hand.h"
#include "engine/app/hand/recording.h"
#include "haptics/device/mouse.h"

namespace catena::app {

class HandHost {
 public:
  struct Options {
    std::string device = "mouse";       ///< the mouse, or a name of haptics/device/registry.h
    std::string firmware;               ///< falcon: before the scene's
    std::string record;                 ///< .catlog of every tick; empty: none
    std::vector<std::string> fields;    ///< --field options, for the recording
    haptics::RealtimeOptions realtime;  ///< of the servo
  };

  explicit HandHost(Options options) : options_(std::move(options)) {}
  ~HandHost();

  /// Loads what the chain names.
  static Outcome load(scene::Scene& scene);
  /// Opens the device, before any window: what is wrong with it is said at once.
  Outcome open_device(const scene::Scene& scene);
  /// Fits the workspace, makes the program and the servo. `bounds`: of what is drawn and felt.
  Outcome prepare(scene::Scene& scene, const render::Bounds& bounds);
  /// Another scene, while the servo runs: as prepare, with the device and the servo that there are.
  Outcome take_over(scene::Scene& scene, const render::Bounds& bounds);
  void start();
  void stop();
  /// Stops, writes what is asked for.
  Outcome finish(const std::string& servo_stats);

  /// The program of the scene as it is now; the servo goes on with it at its next tick. An error leaves the old one.
  Outcome publish(scene::Scene& scene);

  /// The newest state into the scene's cursor and widgets, if there is one; true where it would change the picture.
  bool take(scene::Scene& scene);
  const exchange::HapticState& felt() const { return felt_; }
  const std::vector<std::string>& link_names() const { return link_names_; }
  const std::shared_ptr<const haptics::Program>& program() const { return program_; }

  bool is_mouse() const { return mouse_ != nullptr; }
  void move_mouse(const scene::Scene& scene, const Vec3& world, std::uint32_t buttons);
  const Vec3& first_probe() const { return first_probe_; }
  bool forces() const { return servo_ && servo_->forces(); }
  void set_forces(bool on);
  void say_forces() const;

  const OpenHand& hand() const { return hand_; }
  const haptics::Servo& servo() const { return *servo_; }
  const Recording& recording() const { return recording_; }

 private:
  Options options_;
  OpenHand hand_;
  haptics::MouseDevice* mouse_ = nullptr;  ///< hand_.device, if that is the mouse: the frame moves it
  Recording recording_;
  std::optional<CrashGuard> crash_guard_;
  std::unique_ptr<haptics::Servo> servo_;
  std::shared_ptr<const haptics::Program> program_;
  std::vector<std::string> link_names_;
  exchange::HapticState felt_;
  Vec3 first_probe_{0.0};
};

}  // namespace catena::app
