// SPDX-License-Identifier: MIT
/// A USB bus of umockdev with the emulated Falcon on it: sysfs, udev events and the device node are umockdev's, so that the
/// unmodified libusb enumerates, opens and loses the device like a real one. Needs `umockdev-wrapper` around the test.
/// Every plug-in has a new device number and a new node. A node is a link to a PTY: output stopped = nothing to reap,
/// started = POLLOUT, master closed = POLLERR, the kernel's sign of an unplugged device.
/// The requests run on umockdev's own thread and never wait.
#pragma once
#include <memory>
#include <string>

#include "tests/haptics/device/usbfs/emulated_usbfs.h"

namespace catena::haptics::tests {

class UmockdevBus {
 public:
  explicit UmockdevBus(const EmulatedFalconOptions& options = {});
  ~UmockdevBus();
  UmockdevBus(const UmockdevBus&) = delete;
  UmockdevBus& operator=(const UmockdevBus&) = delete;

  void plug(bool stays_powered = false);  ///< plugs the device in; the first plug-in uses the options' power state
  void unplug();                          ///< pending URBs get -ESHUTDOWN, the node POLLERR, udev a "remove" event
  /// Sends udev's "remove" event for an unplug by the device itself (EmulatedFaults::unplug_after_out_bytes).
  void announce_removal();
  /// Runs `f(device)` under the lock, then completes waiting URBs.
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
