#include "haptics/device/registry.h"

#include <array>

#include "haptics/device/emulator/open_emulated_falcon.h"
#include "haptics/device/null_device.h"
#include "haptics/device/simulated_hand.h"
#include "haptics/device/usb/open_falcon.h"

namespace catena::haptics {
namespace {

/// One type of device: how its name is listed, what it can do, how it is opened.
struct DeviceType {
  const char* name;
  DeviceCapabilities (*nominal)();
  void (*list)(std::vector<DeviceInfo>& to);
  Result<std::unique_ptr<Device>> (*open)(const std::string& detail, const DeviceSettings& settings);
};

Result<std::unique_ptr<Device>> open_null(const std::string&, const DeviceSettings&) {
  return std::unique_ptr<Device>(std::make_unique<NullDevice>());
}

Result<std::unique_ptr<Device>> open_simulated(const std::string&, const DeviceSettings& settings) {
  HandParameters parameters;
  parameters.period_s = 1 / settings.rate_hz;
  parameters.mass_kg = settings.mass_kg.value_or(parameters.mass_kg);
  return std::unique_ptr<Device>(std::make_unique<SimulatedHand>(std::vector<SimulatedHand::Waypoint>{{}}, parameters));
}

const std::array<DeviceType, 4>& types() {
  static const std::array<DeviceType, 4> all = {{
      {"falcon", usb::Falcon::nominal_capabilities, usb::list_falcons, usb::open_falcon},
      {"emulated-falcon", usb::Falcon::nominal_capabilities, list_emulated_falcon, open_emulated_falcon},
      {"null", [] { return NullDevice().capabilities(); },
       [](std::vector<DeviceInfo>& to) {
         to.push_back({"null", true, "no device: the probe rests, forces go nowhere"});
       },
       open_null},
      {"simulated", [] { return SimulatedHand({{}}, {}).capabilities(); },
       [](std::vector<DeviceInfo>& to) {
         to.push_back({"simulated", true, "a simulated mechanism in a simulated hand"});
       },
       open_simulated},
  }};
  return all;
}

const DeviceType* find(const std::string& type) {
  for (const DeviceType& candidate : types())
    if (type == candidate.name) return &candidate;
  return nullptr;
}

}  // namespace

bool is_device_type(const std::string& type) { return find(type) != nullptr; }

std::string device_types() {
  std::string out;
  for (const DeviceType& type : types()) out += (out.empty() ? "" : ", ") + std::string(type.name);
  return out;
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> found;
  for (const DeviceType& type : types()) type.list(found);
  return found;
}

DeviceCapabilities nominal_capabilities(const std::string& type) {
  const DeviceType* found = find(type);
  return found != nullptr ? found->nominal() : DeviceCapabilities{};
}

Result<std::unique_ptr<Device>> open_device(const std::string& name, const DeviceSettings& settings) {
  const std::size_t colon = name.find(':');
  const DeviceType* found = find(name.substr(0, colon));
  if (found == nullptr) return Error{"there is no device \"" + name + "\"; one of " + device_types() + " was expected"};
  return found->open(colon == std::string::npos ? std::string() : name.substr(colon + 1), settings);
}

}  // namespace catena::haptics
