// SPDX-License-Identifier: MIT
/// A small libusb client, to test the emulation without the driver.
#pragma once
#include <libusb.h>

#include <cstdint>
#include <string>
#include <vector>

namespace catena::haptics::tests {

/// An open handle with interface 0 claimed; empty if libusb failed.
class RawClient {
 public:
  explicit RawClient(libusb_device_handle* handle) : handle_(handle) {
    if (handle_ != nullptr && libusb_claim_interface(handle_, 0) != 0) close();
  }
  ~RawClient() { close(); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  void close() {
    if (handle_ != nullptr) libusb_close(handle_);
    handle_ = nullptr;
  }
  libusb_device_handle* get() { return handle_; }

  int control(int request, int value) {
    return libusb_control_transfer(handle_, 0x40, static_cast<std::uint8_t>(request), static_cast<std::uint16_t>(value), 0, nullptr, 0,
                                   1000);
  }
  int write(std::vector<std::uint8_t> bytes, unsigned timeout_ms = 1000) {
    int sent = 0;
    const int error = libusb_bulk_transfer(handle_, 0x02, bytes.data(), static_cast<int>(bytes.size()), &sent, timeout_ms);
    return error == 0 && sent != static_cast<int>(bytes.size()) ? LIBUSB_ERROR_IO : error;
  }
  int write_text(const std::string& text) { return write(std::vector<std::uint8_t>(text.begin(), text.end())); }
  /// Payload of the next packet without the two status bytes; skips up to `patience` idle packets.
  int read(std::vector<std::uint8_t>& payload, unsigned timeout_ms = 1000, int patience = 50) {
    payload.clear();
    for (int i = 0; i < patience; ++i) {
      std::uint8_t packet[64];
      int n = 0;
      const int error = libusb_bulk_transfer(handle_, 0x81, packet, sizeof packet, &n, timeout_ms);
      if (error != 0) return error;
      if (n > 2) {
        payload.assign(packet + 2, packet + n);
        return 0;
      }
    }
    return 0;
  }

 private:
  libusb_device_handle* handle_;
};

/// Command with zero motors and no lights.
inline const char* const kRestFrame = "<AAAAAAAAAAAAAA>";

}  // namespace catena::haptics::tests
