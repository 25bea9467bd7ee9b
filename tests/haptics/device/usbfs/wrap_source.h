/// The in-process bus as a driver's source: the one descriptor, wrapped by libusb at each open.
#pragma once
#include <chrono>
#include <thread>

#include "haptics/device/usb/libusb_transport.h"

namespace catena::haptics::test {

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

}  // namespace catena::haptics::test
