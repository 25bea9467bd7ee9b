// SPDX-License-Identifier: MIT
/// Program side of a device that is held by a separate process, `catena-device` (device_page.h): whatever happens to the program, the
/// device is released, and an observer of the process can tell. read() and write() exchange plain data through shared memory: they never
/// wait, lock or allocate. A process that has exited, or that is unresponsive for 100 ms, gives status `lost`.
#pragma once
#include <memory>
#include <string>

#include "haptics/device/registry.h"

namespace catena::haptics {

/// Starts the process, waits until its device is open (at most 60 s), and returns the device. An Error where it cannot be opened.
///   device  name that the process opens: "emulated-falcon", "emulated-falcon:still"
///   log     path of the force table that the process writes while it runs, t,force_x,force_y,force_z: the force of the motors, in seconds
///           of CLOCK_MONOTONIC and newtons, device axes. It is completed even if the program dies. Empty: none
Result<std::unique_ptr<Device>> open_in_process(const std::string& device, const std::string& log, const DeviceSettings& settings);

}  // namespace catena::haptics
