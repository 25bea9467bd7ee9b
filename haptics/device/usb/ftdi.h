/// The bytes of one opened USB device, and nothing else: what a driver needs of libusb, and what a test can play.
/// Vendor control requests without data, bulk OUT, bulk IN of one 64-byte packet. One thread at a time.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/base/result.h"

namespace catena::haptics::usb {

enum class UsbError : std::uint8_t {
  none,
  timeout,       ///< nothing, or only a part, within the time given
  stall,         ///< the endpoint wants its halt cleared
  disconnected,  ///< unplugged: nothing will work until it is opened again
  other
};
const char* to_string(UsbError error);  ///< "no answer in time", "unplugged", ...

/// How many bytes went, also where there is an error.
struct UsbTransferResult {
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
  virtual UsbTransferResult write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept = 0;
  virtual UsbTransferResult read(UsbPacket& packet, int timeout_ms) noexcept = 0;  ///< always asks for 64 bytes
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

/// The FTDI FT232R between the bus and the Falcon's processor: control requests by name, and bulk data without the two
/// modem-status bytes with which each IN packet starts (a packet of these two alone is an idle device, not an unplug).
/// A stalled endpoint is cleared and tried once more. Everything is counted. I/O thread.

/// ImageWriteResult by the I/O thread, read by any.
struct FtdiCounters {
  std::atomic<std::uint64_t> packets_out{0}, packets_in{0}, idle_packets{0}, timeouts{0}, stalls{0}, retries{0}, errors{0}, line_errors{0};
};

inline void increment(std::atomic<std::uint64_t>& counter, std::uint64_t by = 1) noexcept {
  counter.fetch_add(by, std::memory_order_relaxed);
}

enum class FtdiBaud : std::uint16_t { boot_9600 = 0x4138, image_140000 = 0x15, run_1500000 = 0x02 };

inline constexpr std::size_t kFtdiPayloadBytes = kUsbPacketBytes - 2;

class Ftdi {
 public:
  Ftdi(Transport& transport, FtdiCounters& counters) : transport_(transport), counters_(counters) {}

  UsbError purge_in() noexcept { return control(0, 1); }
  UsbError purge_out() noexcept { return control(0, 2); }
  UsbError purge() noexcept;  ///< both
  UsbError rts_low() noexcept { return control(1, 0x0200); }
  UsbError dtr_low() noexcept { return control(1, 0x0100); }
  UsbError dtr_high() noexcept { return control(1, 0x0101); }
  UsbError disable_flow_control() noexcept { return control(2, 0); }
  UsbError set_baud(FtdiBaud baud) noexcept { return control(3, static_cast<std::uint16_t>(baud)); }
  UsbError set_8n1() noexcept { return control(4, 8); }
  UsbError set_latency_ms(std::uint8_t ms) noexcept { return control(9, ms); }

  /// All of `bytes`, or an error.
  UsbError write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept;
  /// One packet's payload, perhaps empty; it stays valid until the next read.
  UsbError read(std::span<const std::uint8_t>& payload, int timeout_ms) noexcept;

 private:
  UsbError control(std::uint8_t request, std::uint16_t value) noexcept;
  UsbError record_error(UsbError error) noexcept;

  Transport& transport_;
  FtdiCounters& counters_;
  UsbPacket packet_{};
};

}  // namespace catena::haptics::usb
