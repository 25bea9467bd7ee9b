/// The devices by name: what there is, what it can do, and how it is opened. Off the tick.
///   TYPE or TYPE:DETAIL, such as "falcon", "falcon:1" (the second one), "recorded:path.csv"; the hand map (hand_map.h) is around it
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "haptics/device/device_settings.h"

namespace catena::haptics {

/// One device that could be used.
struct DeviceInfo {
  std::string name;       ///< what `open_device` takes
  bool available = true;  ///< it can be opened now
  std::string detail;     ///< one line: what it is, or why it cannot be opened
};

std::string parse_device_type(const std::string& name);  ///< TYPE
/// The file that the device of this name writes; empty: none.
std::string force_table_path(const std::string& name);
/// Whether open_device() knows the type.
bool is_device_type(const std::string& type);
bool is_hardware(const std::string& type);  ///< a thing on the desk: it may not be plugged in
/// Its metres are of a thing that stands still on the desk: it can be registered to the room of a headset.
bool is_stationary(const std::string& type);
std::string device_type_names();  ///< "falcon, mouse, null, ...": for messages
/// Every device that could be used, present ones first. Looks at the USB bus.
std::vector<DeviceInfo> list_devices();
/// What a device of this type can do, before it is opened.
DeviceCapabilities nominal_capabilities(const std::string& type);
/// Opens by name; `settings` says how (its `type` is not looked at). The error says what to do.
Result<std::unique_ptr<Device>> open_device(const std::string& name, const DeviceSettings& settings);

}  // namespace catena::haptics
