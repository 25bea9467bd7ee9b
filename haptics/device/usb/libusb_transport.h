// SPDX-License-Identifier: MIT
/// Transport over libusb: finds, opens and claims a device, detects when it is plugged in (hotplug where libusb supports it, else by
/// polling), and converts libusb's errors to UsbError. One thread at a time for each object.
#pragma once
#include <atomic>
#include <string>
#include <vector>

#include "haptics/device/usb/ftdi.h"

struct libusb_context;
struct libusb_device_handle;

namespace catena::haptics::usb {

/// Identification of a USB device.
struct UsbId {
  std::uint16_t vendor = 0, product = 0;
  std::string product_string;  ///< as reported by the device; empty: any
};
inline const UsbId kFalconUsbId{0x0403, 0xcb48, "FALCON HAPTIC"};

/// A device found on the bus.
struct UsbDeviceInfo {
  bool can_open = false;
  std::string detail;  ///< location on the bus, or the reason why the device cannot be opened and a remedy
};
/// Returns the devices of this id, in the order of LibusbTransportSource's index.
Result<std::vector<UsbDeviceInfo>> list_usb(const UsbId& id);

/// An opened device with interface 0 claimed.
class LibusbTransport final : public Transport {
 public:
  /// Wraps a device node that is already open (interface 0 is claimed; the caller keeps the descriptor). It disables the enumeration of
  /// devices, for every context that this process makes later: open devices that are found by id first.
  static Result<std::unique_ptr<LibusbTransport>> wrap(int fd);
  ~LibusbTransport() override;
  LibusbTransport(const LibusbTransport&) = delete;
  LibusbTransport& operator=(const LibusbTransport&) = delete;

  UsbError control(std::uint8_t request, std::uint16_t value) noexcept override;
  UsbTransferResult write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept override;
  UsbTransferResult read(UsbPacket& packet, int timeout_ms) noexcept override;
  UsbError clear_halt(UsbEndpoint endpoint) noexcept override;
  int descriptor() const noexcept override { return fd_; }

 private:
  friend class LibusbTransportSource;
  LibusbTransport(std::shared_ptr<libusb_context> context, libusb_device_handle* handle, int fd);

  std::shared_ptr<libusb_context> context_;
  libusb_device_handle* handle_;
  int fd_;  ///< owned by libusb
};

/// Opens the device with the given index among those of an id on the bus, repeatedly.
class LibusbTransportSource final : public TransportSource {
 public:
  explicit LibusbTransportSource(UsbId id, int index = 0);
  ~LibusbTransportSource() override;
  LibusbTransportSource(const LibusbTransportSource&) = delete;
  LibusbTransportSource& operator=(const LibusbTransportSource&) = delete;

  Result<std::unique_ptr<Transport>> open() override;
  bool wait_for_arrival(int timeout_ms) noexcept override;
  bool has_hotplug() const { return hotplug_ != 0; }

 private:
  UsbId id_;
  int index_;
  std::shared_ptr<libusb_context> context_;  ///< null: libusb cannot be initialized
  std::string context_error_;
  int hotplug_ = 0;  ///< libusb's handle of the hotplug callback
  std::atomic<bool> arrived_{false};
};

}  // namespace catena::haptics::usb
