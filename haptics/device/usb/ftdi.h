// SPDX-License-Identifier: MIT
/// Byte transport of one opened USB device: the part of libusb that a driver needs, and that a test can emulate.
/// Vendor control requests without data, bulk OUT, bulk IN of one 64-byte packet. One thread at a time.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/base/result.h"

namespace catena::haptics::usb {

/// Result of a USB transfer.
enum class UsbError : std::uint8_t {
  none,
  timeout,       ///< nothing, or only a part, was transferred in the time given
  stall,         ///< the endpoint is halted, clear_halt is needed
  disconnected,  ///< unplugged: every transfer fails until the device is opened again
  other
};
/// Returns a description: "no answer in time", "unplugged", ...
const char* to_string(UsbError error);

/// Result of a bulk transfer; `bytes` were transferred even if there is an error.
struct UsbTransferResult {
  UsbError error = UsbError::none;
  std::size_t bytes = 0;
};

/// Direction of a bulk endpoint.
enum class UsbEndpoint : std::uint8_t { out, in };

inline constexpr std::size_t kUsbPacketBytes = 64;
using UsbPacket = std::array<std::uint8_t, kUsbPacketBytes>;

/// An opened USB device.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Makes a vendor control request of type 0x40, index 0, without data.
  virtual UsbError control(std::uint8_t request, std::uint16_t value) noexcept = 0;
  virtual UsbTransferResult write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept = 0;
  /// Reads one packet; always requests 64 bytes.
  virtual UsbTransferResult read(UsbPacket& packet, int timeout_ms) noexcept = 0;
  virtual UsbError clear_halt(UsbEndpoint endpoint) noexcept = 0;
  /// Returns the file descriptor of the open device, to be shared with another process; < 0: there is none.
  virtual int descriptor() const noexcept { return -1; }
};

/// Opens the transports of a driver, at the start and after the device was unplugged. One thread at a time.
class TransportSource {
 public:
  virtual ~TransportSource() = default;
  /// Opens the device. An Error says why it cannot be opened, and what to do.
  virtual Result<std::unique_ptr<Transport>> open() = 0;
  /// Waits up to timeout_ms; returns true at once when a device may have been plugged in.
  virtual bool wait_for_arrival(int timeout_ms) noexcept = 0;
};

/// The FTDI FT232R between the bus and the Falcon's processor: named control requests, and bulk data without the two modem-status
/// bytes at the start of each IN packet (a packet of only these two means an idle device, not an unplugged one).
/// A stalled endpoint is cleared and the transfer retried one time. Everything is counted. I/O thread.

/// Counters written by the I/O thread, read by any thread.
struct FtdiCounters {
  std::atomic<std::uint64_t> packets_out{0}, packets_in{0}, idle_packets{0}, timeouts{0}, stalls{0}, retries{0}, errors{0}, line_errors{0};
};

inline void increment(std::atomic<std::uint64_t>& counter, std::uint64_t by = 1) noexcept {
  counter.fetch_add(by, std::memory_order_relaxed);
}

/// Baud-rate divisors.
enum class FtdiBaud : std::uint16_t { boot_9600 = 0x4138, image_140000 = 0x15, run_1500000 = 0x02 };

inline constexpr std::size_t kFtdiPayloadBytes = kUsbPacketBytes - 2;

/// The chip; refers to the transport and the counters, which outlive it.
class Ftdi {
 public:
  Ftdi(Transport& transport, FtdiCounters& counters) : transport_(transport), counters_(counters) {}

  UsbError purge_in() noexcept { return control(0, 1); }
  UsbError purge_out() noexcept { return control(0, 2); }
  UsbError purge() noexcept;  ///< input and output
  UsbError rts_low() noexcept { return control(1, 0x0200); }
  UsbError dtr_low() noexcept { return control(1, 0x0100); }
  UsbError dtr_high() noexcept { return control(1, 0x0101); }
  UsbError disable_flow_control() noexcept { return control(2, 0); }
  UsbError set_baud(FtdiBaud baud) noexcept { return control(3, static_cast<std::uint16_t>(baud)); }
  UsbError set_8n1() noexcept { return control(4, 8); }
  UsbError set_latency_ms(std::uint8_t ms) noexcept { return control(9, ms); }

  /// Writes all of `bytes`, or returns an error.
  UsbError write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept;
  /// Reads the payload of one packet, possibly empty; it stays valid until the next read.
  UsbError read(std::span<const std::uint8_t>& payload, int timeout_ms) noexcept;

 private:
  UsbError control(std::uint8_t request, std::uint16_t value) noexcept;
  UsbError record_error(UsbError error) noexcept;

  Transport& transport_;
  FtdiCounters& counters_;
  UsbPacket packet_{};
};

}  // namespace catena::haptics::usb
