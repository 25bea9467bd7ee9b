// SPDX-License-Identifier: MIT
/// Process side of a device that is held by a separate process (device_page.h): the loop between the shared page and the device.
#pragma once
#include "haptics/device/process/device_page.h"

namespace catena::haptics::process {

/// Copies the device's capabilities to the shared page.
void describe_device(const DeviceCapabilities& device, DeviceDescription& to);

/// Serves the program until its end of the socket `lifeline` closes; then, with zero force, until 100 ms after the device has confirmed its
/// zero (at most 2 s), so that a watchdog of the device sees it. Runs one cycle per period of the page's rate; no allocation, except for
/// the device's status text, once per 100 cycles (10 times a second at 1 kHz).
void serve_device(DevicePage& page, int lifeline, Device& device);

}  // namespace catena::haptics::process
