// SPDX-License-Identifier: MIT
/// Transport from the driver directly to the emulated Falcon, without libusb: `catena feel SCENE --device emulated-falcon` runs the
/// real driver over it on any machine. Each read returns the bytes available, or after the latency time the chip's idle packet.
/// `paced`: a reply comes no earlier than a millisecond after the last one, as over the bus. Any thread; it locks the device.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "haptics/device/emulator/emulated_falcon.h"
#include "haptics/device/emulator/emulated_mechanism.h"
#include "haptics/device/registry.h"
#include "haptics/device/usb/ftdi.h"

namespace catena::haptics {

/// An emulated device and its lock.
struct SharedEmulatedFalcon {
  explicit SharedEmulatedFalcon(const EmulatedFalconOptions& options = {}) : device(options) {}
  std::mutex mutex;
  EmulatedFalcon device;
};

/// Transport of one emulated device.
class EmulatedTransport final : public usb::Transport {
 public:
  EmulatedTransport(std::shared_ptr<SharedEmulatedFalcon> shared, bool paced) : shared_(std::move(shared)), paced_(paced) {}

  usb::UsbError control(std::uint8_t request, std::uint16_t value) noexcept override;
  usb::UsbTransferResult write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept override;
  usb::UsbTransferResult read(usb::UsbPacket& packet, int timeout_ms) noexcept override;
  usb::UsbError clear_halt(usb::UsbEndpoint endpoint) noexcept override;

 private:
  void wait_for_bus(int ms) noexcept;

  std::shared_ptr<SharedEmulatedFalcon> shared_;
  bool paced_;
  std::int64_t last_ns_ = 0;
};

/// Opens EmulatedTransport objects for one emulated device.
class EmulatedTransportSource final : public usb::TransportSource {
 public:
  EmulatedTransportSource(std::shared_ptr<SharedEmulatedFalcon> shared, bool paced) : shared_(std::move(shared)), paced_(paced) {}
  Result<std::unique_ptr<usb::Transport>> open() override;
  bool wait_for_arrival(int timeout_ms) noexcept override;

 private:
  std::shared_ptr<SharedEmulatedFalcon> shared_;
  bool paced_;
};

/// The device type "emulated-falcon": the real Falcon driver over the emulator, with a simulated user who homes it and moves gently
/// around the workspace, for machines without the hardware; "emulated-falcon:still": with a user who then rests, as the pushes of the
/// self-test expect. Where settings.firmware is stated, the emulated device has no firmware yet, and boots that file.

/// Returns a user who pulls the grip out and pushes it in (homing), pulls it out once more (arming), then moves around in the workspace:
/// 14 s, of which the last 8 repeat.
EmulatedUser gentle_user();
/// Returns a user who homes and arms the same way, then rests at z = 0.12 m from 3 s on.
EmulatedUser resting_user();

/// Appends the entries of this device type.
void list_emulated_falcon(std::vector<DeviceInfo>& to);
/// Opens the device. `detail`: empty or "still"; then, or alone, "process" or "process:FILE.csv": the emulated device runs in a separate
/// process (haptics/device/process), which writes the force of its motors to FILE. `observer`, which may be empty, is called for every
/// exchange, on the driver's thread; not with "process".
Result<std::unique_ptr<Device>> open_emulated_falcon(const std::string& detail, const DeviceSettings& settings,
                                                     std::function<void(const EmulatedFalcon::Exchange&)> observer);

/// Returns the FILE of such a detail; empty: none.
std::string emulated_falcon_table_path(const std::string& detail);

}  // namespace catena::haptics
