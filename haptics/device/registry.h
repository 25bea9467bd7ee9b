// SPDX-License-Identifier: MIT
/// Registry of the device types: which exist, what they can do, and how they are opened. Off the tick.
///   TYPE or TYPE:DETAIL, such as "falcon", "falcon:1" (the second one), "recorded:path.csv"; open_device applies device_mapping.h
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "haptics/device/device_settings.h"

namespace catena::haptics {

/// One device that could be used.
struct DeviceInfo {
  std::string name;       ///< name to pass to `open_device`
  bool available = true;  ///< false: the device cannot be opened
  std::string detail;     ///< one line: description, or the reason why it cannot be opened
};

/// Returns the TYPE of a name.
CATENA_EXPORT std::string parse_device_type(const std::string& name);
/// Returns the path of the file that the device of this name writes; empty: none.
CATENA_EXPORT std::string force_table_path(const std::string& name);
/// Returns whether open_device() knows the type.
CATENA_EXPORT bool is_device_type(const std::string& type);
/// Returns whether the type is a physical device, which may not be plugged in.
CATENA_EXPORT bool is_hardware(const std::string& type);
/// Returns whether the device stands still on the desk, so that its workspace can be registered to the stage space of a headset.
CATENA_EXPORT bool is_stationary(const std::string& type);
/// Returns "falcon, mouse, null, ...": for messages.
CATENA_EXPORT std::string device_type_names();
/// Returns every device that could be used, available ones first. Scans the USB bus.
CATENA_EXPORT std::vector<DeviceInfo> list_devices();
/// Returns what a device of this type can do, before it is opened.
CATENA_EXPORT DeviceCapabilities nominal_capabilities(const std::string& type);
/// Opens a device by name with `settings` (whose `type` is ignored). An Error says what to do.
CATENA_EXPORT Result<std::unique_ptr<Device>> open_device(const std::string& name, const DeviceSettings& settings);

}  // namespace catena::haptics
