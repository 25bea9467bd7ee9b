// SPDX-License-Identifier: MIT
/// Emulation of the kernel's usbdevfs for one plugged-in emulated Falcon: URBs are queued, completed, reaped and discarded.
/// umockdev_bus.h and in_process_bus.h forward libusb's system calls here.
/// An OUT URB is delivered at once; an IN URB waits for payload, or for the chip's latency timer (an idle packet of 2 bytes).
/// One object per plug-in: after unplug() every request returns ENODEV. Thread-safe: the port's mutex guards device and queues.
#pragma once
#include <linux/ioctl.h>
#include <linux/usbdevice_fs.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "haptics/device/emulator/emulated_falcon.h"

namespace catena::haptics::tests {

/// Faults of the bus that tests can set, besides the device's own. Guarded by the port's mutex.
struct UsbfsFaults {
  bool out_naks = false;  ///< OUT URBs stay pending
  bool idle_packets = true;
  bool claimed_by_another = false;
  int submit_errors = 0;  ///< number of submissions that fail with ENOMEM
};

struct UsbfsCounts {
  std::uint64_t submitted = 0, discarded = 0, reaped = 0, shut_down = 0, clear_halts = 0, claims = 0, bulks = 0, releases = 0,
                after_unplug = 0;
};

/// The device with the mutex that guards it, the faults and the counts.
struct EmulatedPort {
  explicit EmulatedPort(const EmulatedFalconOptions& options = {}) : device(options) {}
  std::mutex mutex;
  EmulatedFalcon device;
  UsbfsFaults faults;
  UsbfsCounts counts;
};

class EmulatedUsbfs {
 public:
  /// Receives whether there is an URB to reap, and the loss of the device. Called under the port's mutex.
  class Node {
   public:
    virtual ~Node() = default;
    virtual void ready(bool something_to_reap) = 0;
    virtual void gone() = 0;
  };

  struct Urb {
    usbdevfs_urb* urb = nullptr;     ///< its status and length are set on completion
    std::uint8_t* buffer = nullptr;  ///< data of the URB
    std::uintptr_t client = 0;       ///< address in the client, the argument of DISCARDURB
    void* owner = nullptr;           ///< data of the caller
  };

  EmulatedUsbfs(EmulatedPort& port, Node& node);
  ~EmulatedUsbfs();
  EmulatedUsbfs(const EmulatedUsbfs&) = delete;
  EmulatedUsbfs& operator=(const EmulatedUsbfs&) = delete;

  // requests; all return 0 or an errno
  int submit(const Urb& urb);
  int reap(Urb& urb);
  int discard(std::uintptr_t client);
  /// USBDEVFS_BULK from any process: one transfer that completes within the request, after the queued ones. `moved`: transferred
  /// bytes. Never waits: returns ETIMEDOUT instead.
  int bulk(unsigned endpoint, std::uint8_t* data, std::size_t size, std::size_t& moved);
  /// Every other request; `data` is the argument's memory, of the size in the request's number. ENOTTY: unknown request.
  int simple(unsigned long request, void* data);

  void unplug();
  /// Completes waiting URBs with available payload, after a test has changed the device.
  void pump();

  static std::vector<std::uint8_t> descriptors();

 private:
  void complete(const Urb& urb, int status, std::size_t length);
  void pump_locked();
  void unplug_locked();
  void control(const Urb& urb);
  int standard_control(const std::uint8_t* setup, std::uint8_t* data, std::size_t room, std::size_t& length);
  void tick_latency();

  EmulatedPort& port_;
  Node& node_;
  std::deque<Urb> in_, out_, done_;
  bool plugged_ = true, stop_ = false;
  std::condition_variable wake_;
  std::thread latency_;
};

}  // namespace catena::haptics::tests
