/// The bytes over libusb: finds, opens and claims a device, hears of its coming (hotplug where libusb has it, else by looking),
/// and turns libusb's errors into UsbError. One thread at a time for each object.
#pragma once
#include <atomic>
#include <string>
#include <vector>

#include "haptics/device/usb/ftdi.h"

struct libusb_context;
struct libusb_device_handle;

namespace catena::haptics::usb {

struct UsbId {
  std::uint16_t vendor = 0, product = 0;
  std::string product_string;  ///< as the device says it; empty: any
};
inline const UsbId kFalconUsbId{0x0403, 0xcb48, "FALCON HAPTIC"};

/// One of the bus.
struct UsbDeviceInfo {
  bool can_open = false;
  std::string detail;  ///< where it is, or why it cannot be opened and what to do
};
/// Those of this id, in the order in which LibusbTransportSource counts them.
Result<std::vector<UsbDeviceInfo>> list_usb(const UsbId& id);

class LibusbTransport final : public Transport {
 public:
  /// Takes a device node that is open already (interface 0 is claimed; the descriptor stays the caller's). Devices are not
  /// enumerated then: libusb keeps that for every context that this process makes later, so open what is found by id before.
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
  int fd_;  ///< libusb's own
};

/// The n-th device of an id on the bus, again and again.
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
  std::shared_ptr<libusb_context> context_;  ///< null: libusb does not start here
  std::string context_error_;
  int hotplug_ = 0;  ///< libusb's handle of the callback
  std::atomic<bool> arrived_{false};
};

}  // namespace catena::haptics::usb
