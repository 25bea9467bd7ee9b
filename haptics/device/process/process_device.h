/// The program's side of a device that is held by a process of its own, `catena-device` (page.h): whatever becomes of the program, the
/// device is let go, and who looks at the process sees it. read() and write() exchange plain data through shared memory: they never wait,
/// lock or allocate. A process that has died, or that is silent for 100 ms, is a device that is `lost`.
#pragma once
#include <memory>
#include <string>

#include "haptics/device/registry.h"

namespace catena::haptics {

/// Starts the process, waits until its device is open (at most 60 s), and answers with it.
///   device  a name that the process opens: "emulated-falcon", "emulated-falcon:still"
///   log     a table that the process writes while it runs, t,force_x,force_y,force_z: what the motors push, in seconds of
///           CLOCK_MONOTONIC and newtons, device axes. It outlives the program. Empty: none
Result<std::unique_ptr<Device>> open_in_process(const std::string& device, const std::string& log, const DeviceSettings& settings);

}  // namespace catena::haptics
