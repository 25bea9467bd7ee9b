/// The Falcon for the registry: which are on the bus, and how one is opened by its number. Off the tick.
#pragma once
#include <functional>
#include <string>

#include "haptics/device/registry.h"
#include "haptics/device/usb/falcon.h"

namespace catena::haptics::usb {

/// Those on the USB bus as "falcon", "falcon:1", ...; a "falcon" that is not present where there is none.
void list_falcons(std::vector<DeviceInfo>& to);

/// Tells the share of an upload, ten lines a try; for FalconBootOptions::progress.
std::function<bool(int attempt, double share)> boot_progress_lines(std::function<void(const std::string&)> tell);

/// `detail`: empty or "0" for the first one, "1" for the second.
Result<std::unique_ptr<Device>> open_falcon(const std::string& detail, const DeviceSettings& settings);

}  // namespace catena::haptics::usb
