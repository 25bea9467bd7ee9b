// SPDX-License-Identifier: MIT
/// The in-process bus as a driver's source: the one descriptor, wrapped by libusb at each open.
#pragma once
#include <chrono>
#include <thread>

#include "haptics/device/usb/libusb_transport.h"
#include "tests/haptics/device/usbfs/falcon_fixture.h"
#include "tests/support/results.h"

namespace catena::haptics::tests {

class WrapSource final : public usb::TransportSource {
 public:
  explicit WrapSource(int fd) : fd_(fd) {}
  Result<std::unique_ptr<usb::Transport>> open() override {
    CATENA_TRY(std::unique_ptr<usb::Transport> transport, usb::LibusbTransport::wrap(fd_));
    return transport;
  }
  bool wait_for_arrival(int timeout_ms) noexcept override {
    std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
    return false;
  }

 private:
  int fd_;
};

/// The driver over the in-process bus.
inline std::unique_ptr<usb::Falcon> open_wrapped_falcon(int fd) {
  return test::value_of(usb::Falcon::open(std::make_unique<WrapSource>(fd), patient_options()));
}

}  // namespace catena::haptics::tests
