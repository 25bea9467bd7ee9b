/// What a person may say about a device: the scene's "device" object, or options of the command line. Off the tick.
///   {"type": "falcon", "max_force": 6, "stiffness_cap": "safe", "axes": ["x", "-z", "y"], "clutch_button": 2, ...}
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>

#include "engine/base/json.h"
#include "engine/schema/key.h"
#include "haptics/device/device.h"

namespace catena::haptics {

/// Settings as they were read. Plain data.
struct DeviceSettings {
  json::Node node;            ///< its place in the scene, for messages
  std::string type = "null";  ///< a name of the registry
  double rate_hz = 1000;      ///< of the servo

  // the mechanism, where it differs from what the driver knows
  std::optional<double> mass_kg, damping_ns_per_m, friction_n, encoder_step_m, delay_s;  ///< none: as the driver says; kg, N s/m, N, m, s

  // limits; unstated: the device's own, and the defaults of haptics/servo/device_limits.h
  /// How the stiffness is capped.
  enum class StiffnessCap { safe, none, value };
  StiffnessCap stiffness_cap = StiffnessCap::safe;                            ///< "stiffness_cap": "safe", "none" or a number
  double stiffness_cap_n_per_m = 0;                                           ///< of Cap::value
  std::optional<double> max_force_n, max_torque_nm, slew_n_per_s, ramp_in_s;  ///< none: the device's own; N, N m, N/s, s
  bool passivity_control = true;                                              ///< observer and controller are on

  // the way from the device to the hand (haptics/device/device_mapping.h)
  Mat3 workspace_from_device{1.0};  ///< "axes": three of x, -x, y, -y, z, -z: which device axis each hand axis is
  double scale = 1;                 ///< "scale": metres of hand per metre of device
  int clutch_button = 0;            ///< 1 is bit 0; 0: none. While it is held the device moves and the probe rests
  int force_button = 0;             ///< turns the forces on and off
  Vec3 gravity_n{0.0};              ///< "gravity": added to every force that is sent, device axes; carries the grip

  /// Where the device stands in the room of a headset (its stage), once it was registered there: room = origin + rotation hand.
  struct RoomRegistration {
    Vec3 origin_m{0.0};             ///< "room_origin": of the hand's metres
    Mat3 room_from_workspace{1.0};  ///< "room_rotation"
  };
  std::optional<RoomRegistration> room_registration;  ///< none: it was not registered

  // drivers' own
  std::string firmware;     ///< falcon: a file of the vendor's, sent when the device has none
  double force_gain = 1e4;  ///< falcon: motor counts per N m
  std::function<void(const std::string&)>
      report_progress;  ///< not a key: hears what an opening that takes long is doing, a line each; may be empty
};

/// The scene's "device" object described: its keys with their units, ranges and defaults.
schema::Section device_component();
/// Reads and checks the object; every error names the place. Paths resolve relative to `scene_path`.
Result<DeviceSettings> read_device_settings(const json::Node& node, const std::string& scene_path);

}  // namespace catena::haptics
