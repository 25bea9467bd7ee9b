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

constexpr double kMostRoom_m = 1000;

// For example ["x", "-z", "y"]: row i of workspace_from_device is the device axis that workspace axis i follows.
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
  if (!(dot(m[0], cross(m[1], m[2])) > 0.5)) return json::error_at(node, std::string("\"axes\" is no rotation; ") + expected);
  return m;
}

using Settings = DeviceSettings;
/// The context is the path of the scene.
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
  if (!(max_abs(s.room_registration->origin_m) <= kMostRoom_m))
    return json::error_at(*origin, "\"room_origin\" is out of range; metres of a room, up to 1000, were expected");
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
  const std::string drivers = "the driver's", devices = "the device's";
  t.custom(schema::text("type", "Which device: " + device_type_names() + ".").required(), read_type);
  t.custom(number("rate", "Hz", "Ticks a second.").within(100, 10000).with_default("1000"), read_rate);
  t.bind(number("mass", "kg", "Of the mechanism.").positive().with_default(drivers), &Settings::mass_kg);
  t.bind(number("damping", "N s/m", "Of the mechanism.").non_negative().with_default(drivers), &Settings::damping_ns_per_m);
  t.bind(number("friction", "N", "Coulomb friction of the mechanism.").non_negative().with_default(drivers), &Settings::friction_n);
  t.bind(number("encoder_step", "m", "Smallest step of the position; 0: continuous.").non_negative().with_default(drivers),
         &Settings::encoder_step_m);
  t.bind(number("delay", "s", "From the pose to the force.").non_negative().with_default(drivers), &Settings::delay_s);
  t.custom(schema::any_of("stiffness_cap", {schema::choice("", {"safe", "none"}, ""), number("", "N/m", "").non_negative()},
                          "Of every spring: `safe`, `none` or a number.")
               .with_default("\"safe\""),
           read_cap);
  t.bind(number("max_force", "N", "Limit of the force; its direction is kept.").non_negative().with_default(devices),
         &Settings::max_force_n);
  t.bind(number("max_torque", "N m", "Limit of the torque; its direction is kept.").non_negative().with_default(devices),
         &Settings::max_torque_nm);
  t.bind(number("slew", "N/s", "Limit of the change; it never delays the way to zero on a fault.")
             .positive()
             .with_default("`max_force` in 2 ms"),
         &Settings::slew_n_per_s);
  t.bind(number("ramp_in", "s", "From zero whenever the forces come on.").non_negative().with_default("0.5"), &Settings::ramp_in_s);
  t.bind(schema::boolean("passivity", "Energy observer and controller."), &Settings::passivity_control);
  t.custom(schema::texts("axes", "The device axis that each hand axis is, such as `[\"x\", \"-z\", \"y\"]`.")
               .with_size(3, 3)
               .with_range_text("a rotation")
               .with_default("[\"x\", \"y\", \"z\"]"),
           read_hand_axes);
  t.bind(number("scale", "", "Metres of hand per metre of device. Newtons stay newtons; the limits know.").positive(), &Settings::scale);
  t.bind(schema::integer("clutch_button", "", "While it is held the device moves, the probe rests, and the forces are off.", 0, 32)
             .with_default("0, none"),
         &Settings::clutch_button);
  t.bind(schema::integer("force_button", "", "Turns the forces on and off; with it they start off, and are off after a loss.", 0, 32)
             .with_default("0, none"),
         &Settings::force_button);
  t.bind(schema::vec3("gravity", "N", "Added in device axes while the forces are on; carries the grip."), &Settings::gravity_n);
  t.group({schema::vec3("room_origin", "m", "Where the hand's origin is in the room of a headset; `catena view --xr` finds it.")
               .with_range_text("to 1000")
               .without_default(),
           schema::rotation("room_rotation", "From the hand's axes to the room's.").without_default()},
          read_room);
  t.custom(schema::file("firmware", "Falcon: the vendor's image."), read_firmware);
  t.bind(number("force_gain", "counts/N m", "Falcon: motor counts.").positive(), &Settings::force_gain);
  return t;
}

const SettingsTable& settings_table() {
  static const SettingsTable table = made_table();
  return table;
}

}  // namespace

schema::Section device_component() {
  return {"device", "What the hand holds; docs/user/devices.md says what each device is.", schema::Section::Layout::object,
          settings_table().keys()};
}

Result<DeviceSettings> read_device_settings(const json::Node& node, const std::string& scene_path) {
  CATENA_CHECK(json::expect_object(node, "device"));
  DeviceSettings s;
  s.node = node;
  CATENA_CHECK(settings_table().read(scene_path, node, s));
  return s;
}

}  // namespace catena::haptics
