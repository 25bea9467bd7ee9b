/// The process's side of a device that is held by a process of its own (page.h): the loop between the page and the device.
#pragma once
#include "haptics/device/process/device_page.h"

namespace catena::haptics::process {

/// Fills the page's description.
void describe_device(const DeviceCapabilities& device, DeviceDescription& to);

/// Serves the program until its end of the socket `lifeline` closes; then, without a force, until the device has confirmed its zero and
/// 100 ms more (at most 2 s), so that who watches the device sees it. One period of the page's rate at a time; no allocation, except for
/// the device's status text, 10 times a second.
void serve_device(DevicePage& page, int lifeline, Device& device);

}  // namespace catena::haptics::process
