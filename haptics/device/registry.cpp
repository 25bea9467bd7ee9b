// SPDX-License-Identifier: MIT
#include "haptics/device/registry.h"

#include <algorithm>

#include "engine/base/csv.h"
#include "engine/base/numbers.h"
#include "haptics/device/controller.h"
#include "haptics/device/device.h"
#include "haptics/device/device_mapping.h"
#include "haptics/device/emulator/emulated_transport.h"
#include "haptics/device/mouse.h"
#include "haptics/device/recorded_path.h"
#include "haptics/device/simulated_device.h"
#include "haptics/device/spacemouse.h"
#include "haptics/device/usb/falcon.h"

namespace catena::haptics {
namespace {

/// Device type: listing, capabilities and opening.
struct DeviceType {
  const char* name;
  DeviceCapabilities (*nominal)();
  void (*list)(std::vector<DeviceInfo>& to);
  Result<std::unique_ptr<Device>> (*open)(const std::string& detail, const DeviceSettings& settings);
};

Result<std::unique_ptr<Device>> open_null(const std::string& detail, const DeviceSettings&) {
  if (!detail.empty()) return Error{"the device \"null\" has no variants; \"null\" was expected, not \"null:" + detail + "\""};
  return std::unique_ptr<Device>(std::make_unique<NullDevice>());
}

// Opens "simulated", whose simulated user rests at 0, or "simulated:PATH.csv" (t,x,y,z[,buttons], meters in the workspace), whose
// simulated user follows the path.
Result<std::unique_ptr<Device>> open_simulated(const std::string& detail, const DeviceSettings& settings) {
  SimulatedDeviceParameters p = desktop_device_parameters();
  p.period_s = 1 / settings.rate_hz;
  p.mass_kg = settings.mass_kg.value_or(p.mass_kg);
  p.device_damping_ns_per_m = settings.damping_ns_per_m.value_or(p.device_damping_ns_per_m);
  p.friction_n = settings.friction_n.value_or(p.friction_n);
  p.encoder_step_m = settings.encoder_step_m.value_or(p.encoder_step_m);
  p.delay_s = settings.delay_s.value_or(p.delay_s);
  if (p.delay_s > SimulatedDeviceParameters::kMaxDelayPeriods * p.period_s)
    return Error{"simulated: a delay of " + to_text(p.delay_s) + " s is too long; at most " +
                 to_text(SimulatedDeviceParameters::kMaxDelayPeriods * p.period_s) + " s (" +
                 std::to_string(SimulatedDeviceParameters::kMaxDelayPeriods) + " periods) were expected"};
  std::vector<SimulatedDevice::Waypoint> path{{}};
  if (!detail.empty()) {
    CATENA_TRY(const std::vector<ProbePathRow> rows, read_probe_path(detail));
    path.clear();
    for (const ProbePathRow& row : rows) path.push_back({row.t_s, row.position, row.buttons});
  }
  return std::unique_ptr<Device>(std::make_unique<SimulatedDevice>(std::move(path), p));
}

Result<std::unique_ptr<Device>> open_simulated_tool(const std::string& detail, const DeviceSettings& settings) {
  CATENA_TRY(std::unique_ptr<Device> hand, open_simulated(detail, settings));
  SimulatedToolParameters parameters;
  parameters.period_s = 1 / settings.rate_hz;
  return std::unique_ptr<Device>(std::make_unique<SimulatedTool>(std::move(hand), std::vector<SimulatedTool::Waypoint>{{}}, parameters));
}

Result<std::unique_ptr<Device>> open_recorded(const std::string& path, const DeviceSettings&) {
  if (path.empty()) return Error{"device \"recorded\" has no file; \"recorded:PATH.csv\" was expected"};
  return RecordedPath::open(path);
}

Result<std::unique_ptr<Device>> open_mouse(const std::string&, const DeviceSettings&) {
  return Error{"the mouse needs a window; \"catena view SCENE\" or another device was expected"};
}

Result<std::unique_ptr<Device>> open_controller(const std::string&, const DeviceSettings&) {
  return Error{"the controller needs a headset; \"catena view SCENE --xr\" or another device was expected"};
}

Result<std::unique_ptr<Device>> open_spacemouse(const std::string&, const DeviceSettings& settings) {
  SpaceMouseParameters parameters;
  parameters.rate_hz = settings.rate_hz;
  return SpaceMouse::open(parameters);
}

const std::vector<DeviceType>& types() {
  static const std::vector<DeviceType> all = {
      {"falcon", usb::Falcon::nominal_capabilities, usb::list_falcons, usb::open_falcon},
      {"emulated-falcon", usb::Falcon::nominal_capabilities, list_emulated_falcon,
       [](const std::string& detail, const DeviceSettings& settings) { return open_emulated_falcon(detail, settings, {}); }},
      {"null", [] { return NullDevice().capabilities(); },
       [](std::vector<DeviceInfo>& to) {
         to.push_back({"null", true, "no device: the probe rests, and forces are discarded"});
       },
       open_null},
      {"simulated", [] { return SimulatedDevice({{}}, desktop_device_parameters()).capabilities(); },
       [](std::vector<DeviceInfo>& to) {
         to.push_back({"simulated", true,
                       "a simulated mechanism in a simulated hand; simulated:PATH.csv sets the target positions of the hand: "
                       "t,x,y,z[,buttons], metres"});
       },
       open_simulated},
      {"simulated-6dof", [] { return (*open_simulated_tool("", DeviceSettings{}))->capabilities(); },
       [](std::vector<DeviceInfo>& to) {
         to.push_back({"simulated-6dof", true, "the simulated device with a rotating grip: orientation as input, torque as output"});
       },
       open_simulated_tool},
      {"recorded", [] { return RecordedPath(std::vector<RecordedPath::Sample>(1)).capabilities(); },
       [](std::vector<DeviceInfo>& to) {
         to.push_back(
             {"recorded:PATH.csv", true, "a recorded probe path t,x,y,z[,buttons][,qw,qx,qy,qz]; the probe stays at the end of the path"});
       },
       open_recorded},
      {"mouse", MouseDevice::nominal_capabilities,
       [](std::vector<DeviceInfo>& to) {
         to.push_back({"mouse", false, "mouse and keyboard, in the window of catena view"});
       },
       open_mouse},
      {"controller", TrackedController::nominal_capabilities,
       [](std::vector<DeviceInfo>& to) {
         to.push_back({"controller", false, "a tracked headset controller with vibration, for catena view --xr"});
       },
       open_controller},
      {"spacemouse", SpaceMouse::nominal_capabilities,
       [](std::vector<DeviceInfo>& to) {
         const bool there = SpaceMouse::is_daemon_available();
         to.push_back({"spacemouse", there, there ? "3Dconnexion SpaceMouse through spacenavd" : SpaceMouse::daemon_missing_hint()});
       },
       open_spacemouse},
  };
  return all;
}

const DeviceType* find(const std::string& type) {
  for (const DeviceType& candidate : types())
    if (type == candidate.name) return &candidate;
  return nullptr;
}

}  // namespace

std::string parse_device_type(const std::string& name) { return name.substr(0, name.find(':')); }

bool is_hardware(const std::string& type) { return type == "falcon" || type == "spacemouse"; }

bool is_stationary(const std::string& type) {
  return type == "falcon" || type == "emulated-falcon" || type == "simulated" || type == "simulated-6dof";
}

std::string force_table_path(const std::string& name) {
  const std::size_t colon = name.find(':');
  return colon != std::string::npos && parse_device_type(name) == "emulated-falcon" ? emulated_falcon_table_path(name.substr(colon + 1))
                                                                                    : std::string();
}

bool is_device_type(const std::string& type) { return find(type) != nullptr; }

std::string device_type_names() {
  std::string out;
  for (const DeviceType& type : types()) out += (out.empty() ? "" : ", ") + std::string(type.name);
  return out;
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> found;
  for (const DeviceType& type : types()) type.list(found);
  std::stable_partition(found.begin(), found.end(), [](const DeviceInfo& info) { return info.available; });
  return found;
}

DeviceCapabilities nominal_capabilities(const std::string& type) {
  const DeviceType* found = find(type);
  return found != nullptr ? found->nominal() : DeviceCapabilities{};
}

Result<std::unique_ptr<Device>> open_device(const std::string& name, const DeviceSettings& settings) {
  const std::size_t colon = name.find(':');
  const DeviceType* found = find(parse_device_type(name));
  if (found == nullptr) return Error{"there is no device \"" + name + "\"; one of " + device_type_names() + " was expected"};
  if (colon != std::string::npos && colon + 1 == name.size())
    return Error{"device \"" + name + "\" has no detail after the colon; \"" + found->name + "\" or \"" + found->name +
                 ":DETAIL\" was expected"};
  CATENA_TRY(std::unique_ptr<Device> device, found->open(colon == std::string::npos ? std::string() : name.substr(colon + 1), settings));
  return with_device_mapping(std::move(device), settings);
}

}  // namespace catena::haptics
