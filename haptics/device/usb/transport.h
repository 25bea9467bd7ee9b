/// The bytes of one opened USB device, and nothing else: what a driver needs of libusb, and what a test can play.
/// Vendor control requests without data, bulk OUT, bulk IN of one 64-byte packet. One thread at a time.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/base/result.h"

namespace catena::haptics::usb {

enum class UsbError : std::uint8_t {
  none,
  timeout,  ///< nothing, or only a part, within the time given
  stall,    ///< the endpoint wants its halt cleared
  gone,     ///< unplugged: nothing will work until it is opened again
  other
};
const char* usb_error_text(UsbError error);  ///< "no answer in time", "unplugged", ...

/// How many bytes went, also where there is an error.
struct UsbMoved {
  UsbError error = UsbError::none;
  std::size_t bytes = 0;
};

enum class UsbEndpoint : std::uint8_t { out, in };

inline constexpr std::size_t kUsbPacketBytes = 64;
using UsbPacket = std::array<std::uint8_t, kUsbPacketBytes>;

class Transport {
 public:
  virtual ~Transport() = default;
  virtual UsbError control(std::uint8_t request, std::uint16_t value) noexcept = 0;  ///< type 0x40, index 0, no data
  virtual UsbMoved write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept = 0;
  virtual UsbMoved read(UsbPacket& packet, int timeout_ms) noexcept = 0;  ///< always asks for 64 bytes
  virtual UsbError clear_halt(UsbEndpoint endpoint) noexcept = 0;
  /// The open device as a file, to be shared with another process; < 0: there is none.
  virtual int descriptor() const noexcept { return -1; }
};

/// Where a driver's transport comes from, now and again after the device was unplugged. One thread at a time.
class TransportSource {
 public:
  virtual ~TransportSource() = default;
  /// The error says why not, and what to do.
  virtual Result<std::unique_ptr<Transport>> open() = 0;
  /// Waits at most so long; true at once when a device may have come.
  virtual bool wait_for_arrival(int timeout_ms) noexcept = 0;
};

}  // namespace catena::haptics::usb
