// SPDX-License-Identifier: MIT
/// What the kernel's usbdevfs does for one plugged-in device, with the emulated Falcon at the end of the wire: URBs are queued,
/// completed, reaped, discarded. umockdev_bus.h and in_process_bus.h carry libusb's system calls here.
/// An OUT URB is delivered at once; an IN URB waits for payload, or for the chip's latency timer (an idle packet of 2 bytes).
/// One object a plug-in: after unplug() it answers ENODEV for ever. Thread-safe: the port's mutex guards device and queues.
#pragma once
#include <linux/ioctl.h>
#include <linux/usbdevice_fs.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "haptics/device/emulator/emulated_falcon.h"

namespace catena::haptics::tests {

/// What the tests may watch and break, beside the device's own faults. Guarded by the port's mutex.
struct UsbfsFaults {
  bool out_naks = false;  ///< OUT URBs stay pending
  bool idle_packets = true;
  bool claimed_by_another = false;
  int submit_errors = 0;  ///< so many submissions fail with ENOMEM
};

struct UsbfsCounts {
  std::uint64_t submitted = 0, completed = 0, discarded = 0, reaped = 0, stalled = 0, shut_down = 0, clear_halts = 0, claims = 0, bulks = 0,
                releases = 0, idle_packets = 0, after_unplug = 0;
};

/// The device with the lock that everything around it takes.
struct EmulatedPort {
  explicit EmulatedPort(const EmulatedFalconOptions& options = {}) : device(options) {}
  std::mutex mutex;
  EmulatedFalcon device;
  UsbfsFaults faults;
  UsbfsCounts counts;
};

class EmulatedUsbfs {
 public:
  /// Tells the node whether there is something to reap, or that the device is gone. Called under the port's mutex.
  class Node {
   public:
    virtual ~Node() = default;
    virtual void ready(bool something_to_reap) = 0;
    virtual void gone() = 0;
  };

  struct Urb {
    usbdevfs_urb* urb = nullptr;     ///< whose status and length are set
    std::uint8_t* buffer = nullptr;  ///< its data
    std::uintptr_t client = 0;       ///< the client's address of it: what DISCARDURB names
    void* owner = nullptr;           ///< the caller's own
  };

  EmulatedUsbfs(EmulatedPort& port, Node& node);
  ~EmulatedUsbfs();
  EmulatedUsbfs(const EmulatedUsbfs&) = delete;
  EmulatedUsbfs& operator=(const EmulatedUsbfs&) = delete;

  // all return 0 or an errno
  int submit(const Urb& urb);
  int reap(Urb& urb);
  int discard(std::uintptr_t client);
  /// USBDEVFS_BULK: one transfer that completes within the request, whoever asks; behind what is queued. `moved`: its bytes. Never
  /// waits: what would is ETIMEDOUT at once.
  int bulk(unsigned endpoint, std::uint8_t* data, std::size_t size, std::size_t& moved);
  /// Every other request; `data` is the argument's memory, as large as the request says. ENOTTY: not known.
  int simple(unsigned long request, void* data);

  void unplug();
  /// After a test has touched the device: gives waiting URBs what there is now.
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
