// SPDX-License-Identifier: MIT
/// A device whose input is set by the test and whose last output is recorded; base of the devices of single tests.
#pragma once
#include "haptics/device/device.h"

namespace catena::test {

class ScriptedDevice : public haptics::Device {
 public:
  const haptics::DeviceCapabilities& capabilities() const override { return caps; }
  haptics::DeviceInput read() noexcept override { return input; }
  void write(const haptics::DeviceOutput& out) noexcept override { output = out; }
  void stop() noexcept override { stopped = true; }

  haptics::DeviceCapabilities caps;
  haptics::DeviceInput input;
  haptics::DeviceOutput output;
  bool stopped = false;
};

}  // namespace catena::test
