// SPDX-License-Identifier: MIT
/// A USB bus of umockdev's with the emulated Falcon on it: sysfs, udev events and the device node are umockdev's, so the
/// unmodified libusb enumerates, opens and loses the device as it would a real one. Needs `umockdev-wrapper` around the test.
/// Every plug-in is a new device number with a new node. A node is a link to a PTY: its output stopped = nothing to reap,
/// started = POLLOUT, the master closed = POLLERR, which is how the kernel tells of an unplugged device.
/// umockdev's own thread runs the requests: they never wait.
#pragma once
#include <memory>
#include <string>

#include "tests/haptics/device/usbfs/emulated_usbfs.h"

namespace catena::haptics::tests {

class UmockdevBus {
 public:
  static bool available();  ///< the wrapper is there

  explicit UmockdevBus(const EmulatedFalconOptions& options = {});
  ~UmockdevBus();
  UmockdevBus(const UmockdevBus&) = delete;
  UmockdevBus& operator=(const UmockdevBus&) = delete;

  void plug(bool power_kept = false);  ///< the device appears; the first time as the options say
  void unplug();                       ///< pending URBs get -ESHUTDOWN, the node POLLERR, udev says "remove"
  /// udev's part of an unplug that the device made by itself (EmulatedFaults::unplug_after_out_bytes).
  void announce_removal();
  /// Runs `f(device)` under the lock, then lets waiting URBs go on.
  template <class F>
  auto with(F&& f);
  EmulatedPort& port();

 private:
  struct State;
  void pump();
  std::unique_ptr<State> state_;
};

template <class F>
auto UmockdevBus::with(F&& f) {
  struct Pump {
    UmockdevBus& bus;
    ~Pump() { bus.pump(); }
  } pump{*this};
  const std::scoped_lock lock(port().mutex);
  return f(port().device);
}

}  // namespace catena::haptics::tests
