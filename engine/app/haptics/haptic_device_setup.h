/// Before the hand takes hold: how large its world is, and where it begins.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/program.h"
#include "haptics/device/device.h"
#include "haptics/device/device_settings.h"
#include "haptics/servo/servo.h"
#include "render/frame/camera.h"

namespace catena::app {

/// Fits an unstated workspace: the longest edge of what is there fills the device's reach, centre on centre; and switches
/// ramp in over 20 ms unless the scene says otherwise. `centre_m`: of the device's reach, in its own axes; a stated origin is the
/// world place of that centre. Once for a scene.
void fit_workspace(scene::Scene& scene, const Bounds& bounds, double reach_m, const Vec3& centre_m = Vec3(0.0));

/// The first place of the probe: the scene's cursor, the seed of the first link that has one, or the middle of what is there.
Vec3 initial_probe_position(const scene::Scene& scene, const Bounds& bounds);

/// World -> metres in the device's axes, the inverse of what the servo does:  R^T (p - origin) S
Vec3 device_from_world(const scene::Workspace& workspace, const Vec3& world);

/// A haptic device for a scene: opened by name, with what the scene says of it, and the scene's program within its limits.
/// Off the tick. Errors are one line for the person (exit code 2).
struct HapticDeviceSetup {
  std::unique_ptr<haptics::Device> device;
  haptics::DeviceSettings settings;  ///< rate_hz is the servo's
  haptics::DeviceLimits limits;
  std::string note;  ///< one line for the person, or empty
};

/// `name` as the registry takes it; empty: the scene's "device", or else "simulated". The scene's "device" object is checked in
/// any case, and counts only for a device of its type: what one mechanism may be asked for says nothing of another.
/// `firmware` goes before the scene's; the device's news while it opens go to stderr.
Result<HapticDeviceSetup> open_haptic_device(const scene::Scene& scene, const std::string& name, std::optional<double> rate_hz = {},
                                             const std::string& firmware = {});

/// Fits the workspace to the device's reach and builds the program. `bounds`: of what is drawn and felt.
Result<std::shared_ptr<const haptics::HapticProgram>> make_device_program(scene::Scene& scene, const HapticDeviceSetup& hand,
                                                                          const Bounds& bounds);

/// The command line's --realtime and --cpu.
struct RealtimeChoice {
  std::string realtime = "on";
  int cpu = haptics::RealtimeOptions::kAnyWithFifo;
  haptics::RealtimeOptions options() const;
};

/// Writes servo_json of a stopped servo; nothing if `path` is empty.
Outcome write_servo_stats(const std::string& path, const haptics::Servo& servo, const haptics::Device& device);

}  // namespace catena::app
