// SPDX-License-Identifier: MIT
#include "haptics/device/device_settings.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "engine/schema/struct_schema.h"
#include "haptics/device/registry.h"

namespace catena::haptics {
namespace {

constexpr double kMaxRoom_m = 1000;

// Reads axes such as ["x", "-z", "y"]: row i of workspace_from_device is the device axis that workspace axis i follows.
Result<Mat3> read_axes(const json::Node& node) {
  const char* expected = "three different ones of x, -x, y, -y, z, -z, right-handed, were expected, such as [\"x\", \"-z\", \"y\"]";
  if (node.kind != json::Kind::array || node.items.size() != 3)
    return json::error_at(node, std::string("\"axes\" has the wrong shape; ") + expected);
  constexpr std::string_view words[] = {"x", "y", "z", "-x", "-y", "-z"};
  Mat3 m(0.0);
  for (int row = 0; row < 3; ++row) {
    CATENA_TRY(const std::string word, json::as_string(node.items[static_cast<std::size_t>(row)], "axes"));
    const auto at = std::find(std::begin(words), std::end(words), word) - std::begin(words);
    if (at == 6) return json::error_at(node, "\"axes\" names \"" + word + "\"; " + expected);
    m[static_cast<int>(at % 3)][row] = at < 3 ? 1 : -1;
  }
  if (!(dot(m[0], cross(m[1], m[2])) > 0.5)) return json::error_at(node, std::string("\"axes\" is not a rotation; ") + expected);
  return m;
}

using Settings = DeviceSettings;
/// Schema of the settings; the context is the path of the scene.
using SettingsTable = schema::StructSchema<Settings, const std::string>;

Outcome read_type(const std::string&, const json::Node& node, Settings& s) {
  CATENA_TRY(s.type, json::require_string(node, "type"));
  if (is_device_type(s.type)) return Done{};
  return json::error_at(*node.find("type"), "there is no device type \"" + s.type + "\"; one of " + device_type_names() + " was expected");
}

Outcome read_rate(const std::string&, const json::Node& node, Settings& s) {
  CATENA_TRY(s.rate_hz, json::get_number(node, "rate", s.rate_hz, json::NumberRange::positive));
  if (s.rate_hz < 100 || s.rate_hz > 10000)
    return json::error_at(*node.find("rate"), "\"rate\" is out of range; 100 to 10000 Hz were expected");
  return Done{};
}

Outcome read_cap(const std::string&, const json::Node& node, Settings& s) {
  const json::Node* cap = node.find("stiffness_cap");
  if (cap == nullptr) return Done{};
  if (cap->kind == json::Kind::number) {
    s.stiffness_cap = Settings::StiffnessCap::value;
    CATENA_TRY(s.stiffness_cap_n_per_m, json::as_number(*cap, "stiffness_cap", json::NumberRange::non_negative));
  } else if (cap->kind == json::Kind::string && (cap->string == "safe" || cap->string == "none")) {
    s.stiffness_cap = cap->string == "safe" ? Settings::StiffnessCap::safe : Settings::StiffnessCap::none;
  } else {
    return json::error_at(*cap, "\"stiffness_cap\" is not understood; \"safe\", \"none\" or a number (N/m) was expected");
  }
  return Done{};
}

Outcome read_hand_axes(const std::string&, const json::Node& node, Settings& s) {
  if (const json::Node* axes = node.find("axes")) {
    CATENA_TRY(s.workspace_from_device, read_axes(*axes));
  }
  return Done{};
}

Outcome read_room(const std::string&, const json::Node& node, Settings& s) {
  const json::Node *origin = node.find("room_origin"), *rotation = node.find("room_rotation");
  if (origin == nullptr && rotation == nullptr) return Done{};
  if (origin == nullptr || rotation == nullptr)
    return json::error_at(origin == nullptr ? *rotation : *origin, "\"room_origin\" and \"room_rotation\" go together; both were expected");
  s.room_registration.emplace();
  CATENA_TRY(s.room_registration->origin_m, json::as_vec3(*origin, "room_origin"));
  if (!(max_abs(s.room_registration->origin_m) <= kMaxRoom_m))
    return json::error_at(*origin, "\"room_origin\" is out of range; coordinates up to 1000 m were expected");
  CATENA_TRY(s.room_registration->room_from_workspace, json::as_rotation(*rotation, "room_rotation"));
  return Done{};
}

Outcome read_firmware(const std::string& scene_path, const json::Node& node, Settings& s) {
  CATENA_TRY(s.firmware, json::get_string(node, "firmware", s.firmware));
  if (!s.firmware.empty() && std::filesystem::path(s.firmware).is_relative())
    s.firmware = (std::filesystem::path(scene_path).parent_path() / s.firmware).string();
  return Done{};
}

SettingsTable made_table() {
  using schema::number;
  SettingsTable t;
  const std::string drivers = "the driver's value", devices = "the device's maximum";
  t.custom(schema::text("type", "Device type: " + device_type_names() + ".").required(), read_type);
  t.custom(number("rate", "Hz", "Ticks per second.").within(100, 10000).with_default("1000"), read_rate);
  t.bind(number("mass", "kg", "Mass of the mechanism.").positive().with_default(drivers), &Settings::mass_kg);
  t.bind(number("damping", "N s/m", "Damping of the mechanism.").non_negative().with_default(drivers), &Settings::damping_ns_per_m);
  t.bind(number("friction", "N", "Coulomb friction of the mechanism.").non_negative().with_default(drivers), &Settings::friction_n);
  t.bind(number("encoder_step", "m", "Smallest position step of the encoders; 0: continuous.").non_negative().with_default(drivers),
         &Settings::encoder_step_m);
  t.bind(number("delay", "s", "Delay between reading the pose and applying the force.").non_negative().with_default(drivers),
         &Settings::delay_s);
  t.custom(schema::any_of("stiffness_cap", {schema::choice("", {"safe", "none"}, ""), number("", "N/m", "").non_negative()},
                          "Maximum stiffness of a spring, N/m; `safe`: the safe stiffness of the mechanism; `none`: no maximum.")
               .with_default("\"safe\""),
           read_cap);
  t.bind(
      number("max_force", "N", "Maximum magnitude of the force; a limited force keeps its direction.").non_negative().with_default(devices),
      &Settings::max_force_n);
  t.bind(number("max_torque", "N m", "Maximum magnitude of the torque; a limited torque keeps its direction.")
             .non_negative()
             .with_default(devices),
         &Settings::max_torque_nm);
  t.bind(number("slew", "N/s", "Maximum rate of change of the force; a drop to zero after a fault is not limited.")
             .positive()
             .with_default("the device's maximum force in 2 ms, at most 10 kN/s"),
         &Settings::slew_n_per_s);
  t.bind(
      number("ramp_in", "s", "Time over which the forces rise from zero whenever they are switched on.").non_negative().with_default("0.5"),
      &Settings::ramp_in_s);
  t.bind(schema::boolean("passivity", "Passivity observer and controller, which account for the energy of the loop."),
         &Settings::passivity_control);
  t.custom(schema::texts("axes", "Device axes that correspond to the workspace axes x, y and z, such as `[\"x\", \"-z\", \"y\"]`.")
               .with_size(3, 3)
               .with_range_text("a rotation")
               .with_default("[\"x\", \"y\", \"z\"]"),
           read_hand_axes);
  t.bind(number("scale", "",
                "Metres of probe travel per metre of device travel. Forces are not scaled; the limits take the scale into account.")
             .positive(),
         &Settings::scale);
  t.bind(schema::integer("clutch_button", "",
                         "Clutch button. While the button is held, the device moves, the probe rests and the forces are off.", 0, 32)
             .with_default("0: none"),
         &Settings::clutch_button);
  t.bind(schema::integer(
             "force_button", "",
             "Button that turns the forces on and off. With such a button, the forces are off at the start and after a loss of the device.",
             0, 32)
             .with_default("0: none"),
         &Settings::force_button);
  t.bind(schema::vec3("gravity", "N", "Force added in device axes while the forces are on, to compensate the weight of the grip."),
         &Settings::gravity_n);
  t.group({schema::vec3("room_origin", "m", "Position of the workspace's origin in the room of a headset; measured by `catena view --xr`.")
               .with_range_text("to 1000")
               .without_default(),
           schema::rotation("room_rotation", "Rotation from workspace axes to room axes.").without_default()},
          read_room);
  t.custom(schema::file("firmware", "Firmware file of the vendor of the Falcon, sent to a device without firmware."), read_firmware);
  t.bind(number("force_gain", "counts/N m", "Motor counts of the Falcon per N m of motor torque.").positive(), &Settings::force_gain);
  return t;
}

const SettingsTable& settings_table() {
  static const SettingsTable table = made_table();
  return table;
}

}  // namespace

schema::Section device_component() {
  return {"device", "Haptic device; docs/user/devices.md describes each type.", schema::Section::Layout::object, settings_table().keys()};
}

Result<DeviceSettings> read_device_settings(const json::Node& node, const std::string& scene_path) {
  CATENA_CHECK(json::expect_object(node, "device"));
  DeviceSettings s;
  s.node = node;
  CATENA_CHECK(settings_table().read(scene_path, node, s));
  return s;
}

}  // namespace catena::haptics
