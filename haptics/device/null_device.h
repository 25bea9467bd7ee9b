/// No device: the probe rests at the origin, forces go nowhere. Haptic thread.
#pragma once
#include "haptics/device/device.h"

namespace catena::haptics {

class NullDevice final : public Device {
 public:
  NullDevice() { capabilities_.name = "null"; }
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override { return {}; }
  void write(const DeviceOutput&) noexcept override {}

 private:
  DeviceCapabilities capabilities_;
};

}  // namespace catena::haptics
