// SPDX-License-Identifier: MIT
/// Settings of a device: the scene's "device" object, or options of the command line. Off the tick.
///   {"type": "falcon", "max_force": 6, "stiffness_cap": "safe", "axes": ["x", "-z", "y"], "clutch_button": 2, ...}
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>

#include "engine/base/export.h"
#include "engine/base/json.h"
#include "engine/schema/key.h"
#include "haptics/device/device.h"

namespace catena::haptics {

/// Settings as read. Plain data.
struct CATENA_EXPORT DeviceSettings {
  json::Node node;            ///< the object in the scene, for the file and line of messages
  std::string type = "null";  ///< a type name of the registry
  double rate_hz = 1000;      ///< tick rate of the servo

  // parameters of the mechanism that override the driver's
  std::optional<double> mass_kg, damping_ns_per_m, friction_n, encoder_step_m, delay_s;  ///< none: the driver's value; kg, N s/m, N, m, s

  // limits; none: the device's own, and the defaults of haptics/servo/device_limits.h
  /// Cap of the stiffness: the safe stiffness of the mechanism, no cap, or a stated value.
  enum class StiffnessCap { safe, none, value };
  StiffnessCap stiffness_cap = StiffnessCap::safe;                            ///< "stiffness_cap": "safe", "none" or a number
  double stiffness_cap_n_per_m = 0;                                           ///< the cap of StiffnessCap::value
  std::optional<double> max_force_n, max_torque_nm, slew_n_per_s, ramp_in_s;  ///< none: the device's own; N, N m, N/s, s
  bool passivity_control = true;                                              ///< passivity observer and controller are on

  // mapping of the device to the workspace (haptics/device/device_mapping.h)
  Mat3 workspace_from_device{1.0};  ///< "axes": three of x, -x, y, -y, z, -z: which device axis each workspace axis is
  double scale = 1;                 ///< "scale": meters of probe travel per meter of device travel
  int clutch_button = 0;  ///< number of the clutch button, 1 is bit 0; 0: none. While it is held the device moves and the probe rests
  int force_button = 0;   ///< number of the button that turns the forces on and off; 0: none
  Vec3 gravity_n{0.0};    ///< "gravity": newtons, device axes, added to every force that is sent; compensates the weight of the grip

  /// Pose of the workspace in the stage space of a headset: room = origin + rotation workspace.
  struct RoomRegistration {
    Vec3 origin_m{0.0};             ///< "room_origin": of the workspace's origin, meters
    Mat3 room_from_workspace{1.0};  ///< "room_rotation"
  };
  std::optional<RoomRegistration> room_registration;  ///< none: not registered

  // settings of single drivers
  std::string firmware;     ///< falcon: path of a vendor's firmware file, sent when the device has none
  double force_gain = 1e4;  ///< falcon: motor counts per N m
  /// Not a key: receives the progress of a long opening, one line each; may be empty.
  std::function<void(const std::string&)> report_progress;
};

/// Returns the schema of the scene's "device" object: its keys with their units, ranges and defaults.
CATENA_EXPORT schema::Section device_component();
/// Reads and checks the object; every Error names its line in the scene. Paths are relative to `scene_path`.
CATENA_EXPORT Result<DeviceSettings> read_device_settings(const json::Node& node, const std::string& scene_path);

}  // namespace catena::haptics
