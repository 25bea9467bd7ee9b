// SPDX-License-Identifier: MIT
#include "haptics/device/usb/ftdi.h"

namespace catena::haptics::usb {

const char* to_string(UsbError error) {
  switch (error) {
    case UsbError::none:
      return "no error";
    case UsbError::timeout:
      return "no answer in time";
    case UsbError::stall:
      return "the endpoint is stalled";
    case UsbError::disconnected:
      return "unplugged";
    case UsbError::other:
      break;
  }
  return "a USB transfer failed";
}

UsbError Ftdi::record_error(UsbError error) noexcept {
  if (error == UsbError::timeout) increment(counters_.timeouts);
  if (error == UsbError::stall) increment(counters_.stalls);
  if (error == UsbError::other) increment(counters_.errors);
  return error;
}

UsbError Ftdi::control(std::uint8_t request, std::uint16_t value) noexcept {
  UsbError error = record_error(transport_.control(request, value));
  // a stalled control request is cleared by the next one
  if (error == UsbError::stall || error == UsbError::timeout) {
    increment(counters_.retries);
    error = record_error(transport_.control(request, value));
  }
  return error;
}

UsbError Ftdi::purge() noexcept {
  const UsbError error = purge_in();
  return error != UsbError::none ? error : purge_out();
}

UsbError Ftdi::write(std::span<const std::uint8_t> bytes, int timeout_ms) noexcept {
  for (int attempt = 0; attempt < 2; ++attempt) {
    const UsbTransferResult moved = transport_.write(bytes, timeout_ms);
    bytes = bytes.subspan(std::min(moved.bytes, bytes.size()));
    if (moved.error == UsbError::none && bytes.empty()) {
      increment(counters_.packets_out);
      return UsbError::none;
    }
    // after a partial transfer the rest is sent
    const UsbError error = record_error(moved.error);
    if (error == UsbError::stall) {
      if (const UsbError cleared = record_error(transport_.clear_halt(UsbEndpoint::out)); cleared != UsbError::none) return cleared;
    } else if (error != UsbError::none) {
      return error;
    }
    increment(counters_.retries);
  }
  return UsbError::other;
}

UsbError Ftdi::read(std::span<const std::uint8_t>& payload, int timeout_ms) noexcept {
  payload = {};
  UsbTransferResult moved = transport_.read(packet_, timeout_ms);
  if (moved.error == UsbError::stall) {
    record_error(moved.error);
    if (const UsbError cleared = record_error(transport_.clear_halt(UsbEndpoint::in)); cleared != UsbError::none) return cleared;
    increment(counters_.retries);
    moved = transport_.read(packet_, timeout_ms);
  }
  // data received before a timeout is valid
  const std::size_t bytes = std::min(moved.bytes, packet_.size());
  if (bytes > 2) {
    payload = std::span<const std::uint8_t>(packet_).subspan(2, bytes - 2);
    increment(counters_.packets_in);
  } else if (bytes > 0) {
    increment(counters_.idle_packets);
  }
  if (bytes >= 2 && (packet_[1] & 0x1E) != 0) increment(counters_.line_errors);  // overrun, parity, framing, break
  record_error(moved.error);
  return moved.error == UsbError::timeout && bytes > 0 ? UsbError::none : moved.error;
}

}  // namespace catena::haptics::usb
