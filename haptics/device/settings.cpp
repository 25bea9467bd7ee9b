#include "haptics/device/settings.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "haptics/device/registry.h"

namespace catena::haptics {
namespace {

// ["x", "-z", "y"]: row i of hand_from_device is the device axis that hand axis i is
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

Outcome read_mechanics(const json::Node& node, DeviceSettings& s) {
  CATENA_TRY(s.mass_kg, json::get_optional_number(node, "mass", json::Range::positive));
  CATENA_TRY(s.damping_ns_per_m, json::get_optional_number(node, "damping", json::Range::not_negative));
  CATENA_TRY(s.friction_n, json::get_optional_number(node, "friction", json::Range::not_negative));
  CATENA_TRY(s.encoder_step_m, json::get_optional_number(node, "encoder_step", json::Range::not_negative));
  CATENA_TRY(s.delay_s, json::get_optional_number(node, "delay", json::Range::not_negative));
  return Done{};
}

Outcome read_limits(const json::Node& node, DeviceSettings& s) {
  if (const json::Node* cap = node.find("stiffness_cap")) {
    if (cap->kind == json::Kind::number) {
      s.cap = DeviceSettings::Cap::value;
      CATENA_TRY(s.stiffness_cap_n_per_m, json::as_number(*cap, "stiffness_cap", json::Range::not_negative));
    } else if (cap->kind == json::Kind::string && (cap->string == "safe" || cap->string == "none")) {
      s.cap = cap->string == "safe" ? DeviceSettings::Cap::safe : DeviceSettings::Cap::none;
    } else {
      return json::error_at(*cap, "\"stiffness_cap\" is not understood; \"safe\", \"none\" or a number (N/m) was expected");
    }
  }
  CATENA_TRY(s.max_force_n, json::get_optional_number(node, "max_force", json::Range::not_negative));
  CATENA_TRY(s.max_torque_nm, json::get_optional_number(node, "max_torque", json::Range::not_negative));
  CATENA_TRY(s.slew_n_per_s, json::get_optional_number(node, "slew", json::Range::positive));
  CATENA_TRY(s.ramp_in_s, json::get_optional_number(node, "ramp_in", json::Range::not_negative));
  CATENA_TRY(s.passivity, json::get_boolean(node, "passivity", s.passivity));
  return Done{};
}

Outcome read_hand_map(const json::Node& node, DeviceSettings& s) {
  if (const json::Node* axes = node.find("axes")) {
    CATENA_TRY(s.hand_from_device, read_axes(*axes));
  }
  CATENA_TRY(s.scale, json::get_number(node, "scale", s.scale, json::Range::positive));
  CATENA_TRY(s.clutch_button, json::get_integer(node, "clutch_button", s.clutch_button, 0, 32));
  CATENA_TRY(s.force_button, json::get_integer(node, "force_button", s.force_button, 0, 32));
  CATENA_TRY(s.gravity_n, json::get_vec3(node, "gravity", s.gravity_n));
  return Done{};
}

}  // namespace

Result<DeviceSettings> read_device_settings(const json::Node& node, const std::string& scene_path) {
  CATENA_CHECK(json::expect_object(node, "device"));
  CATENA_CHECK(json::only_keys(node, {"type",          "rate",          "mass",         "damping", "friction", "encoder_step", "delay",
                                      "stiffness_cap", "max_force",     "max_torque",   "slew",    "ramp_in",  "passivity",    "axes",
                                      "scale",         "clutch_button", "force_button", "gravity", "firmware", "force_gain"}));
  DeviceSettings s;
  s.where = node;
  CATENA_TRY(s.type, json::require_string(node, "type"));
  if (!is_device_type(s.type))
    return json::error_at(*node.find("type"), "there is no device type \"" + s.type + "\"; one of " + device_types() + " was expected");
  CATENA_TRY(s.rate_hz, json::get_number(node, "rate", s.rate_hz, json::Range::positive));
  if (s.rate_hz < 100 || s.rate_hz > 10000)
    return json::error_at(*node.find("rate"), "\"rate\" is out of range; 100 to 10000 Hz were expected");
  CATENA_CHECK(read_mechanics(node, s));
  CATENA_CHECK(read_limits(node, s));
  CATENA_CHECK(read_hand_map(node, s));
  CATENA_TRY(s.firmware, json::get_string(node, "firmware", s.firmware));
  if (!s.firmware.empty() && std::filesystem::path(s.firmware).is_relative())
    s.firmware = (std::filesystem::path(scene_path).parent_path() / s.firmware).string();
  CATENA_TRY(s.force_gain, json::get_number(node, "force_gain", s.force_gain, json::Range::positive));
  return s;
}

}  // namespace catena::haptics
