// SPDX-License-Identifier: MIT
/// Setup of a haptic device for a scene: workspace scale, initial probe position, device and program.
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

/// Sets the workspace of a scene for a device. Without an explicit workspace, the longest edge of `bounds` is scaled to the device's reach
/// `reach_m`, center on center. An explicit origin is the world position of the center of the device's reach. `centre_m`: that center,
/// meters in device axes. Sets the ramp of switches to 20 ms unless the scene has one. Call it a single time per scene.
void fit_workspace(scene::Scene& scene, const Bounds& bounds, double reach_m, const Vec3& centre_m = Vec3(0.0));

/// The initial probe position: the scene's visible cursor, else the seed of the first link that has one, else the center of `bounds`.
Vec3 initial_probe_position(const scene::Scene& scene, const Bounds& bounds);

/// Converts a world position to meters in device axes, the inverse of the servo's mapping: R^T (p - origin) S.
Vec3 device_from_world(const scene::Workspace& workspace, const Vec3& world);

/// An open haptic device with its settings and limits. Not for the haptic thread. Errors are one line for the user (exit code 2).
struct HapticDeviceSetup {
  std::unique_ptr<haptics::Device> device;
  haptics::DeviceSettings settings;  ///< rate_hz is the servo's tick rate
  haptics::DeviceLimits limits;
  std::string note;  ///< One line for the user, or empty
};

/// Opens a device. `name`: as the registry accepts it; empty: the scene's "device", or else "simulated". The scene's "device" object is
/// checked in any case, but applies only to a device of its type, because the settings of one mechanism say nothing about another.
/// `firmware`: overrides the scene's. Progress messages of the device while it opens go to stderr.
Result<HapticDeviceSetup> open_haptic_device(const scene::Scene& scene, const std::string& name, std::optional<double> rate_hz = {},
                                             const std::string& firmware = {});

/// Fits the workspace to the device's reach and builds the program within its limits. `bounds`: of everything rendered or haptic, world
/// units.
Result<std::shared_ptr<const haptics::HapticProgram>> make_device_program(scene::Scene& scene, const HapticDeviceSetup& hand,
                                                                          const Bounds& bounds);

/// The options --realtime and --cpu.
struct RealtimeChoice {
  std::string realtime = "on";
  int cpu = haptics::RealtimeOptions::kAnyWithFifo;
  /// Converts to the servo's options.
  haptics::RealtimeOptions options() const;
};

/// Writes servo_json() of a stopped servo; does nothing if `path` is empty.
Outcome write_servo_stats(const std::string& path, const haptics::Servo& servo, const haptics::Device& device);

}  // namespace catena::app
