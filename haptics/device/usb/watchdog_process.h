// SPDX-License-Identifier: MIT
/// A driver's side of the watchdog process (haptics/watchdog): the shared memory page, and the process that is started for an open device
/// and ended with it. Not on the haptic thread; the page's atomic values may be used on any thread.
#pragma once
#include <sys/types.h>

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "haptics/device/usb/ftdi.h"
#include "haptics/watchdog/watch.h"

namespace catena::haptics::usb {

/// The shared memory page. Its size is sealed, so that neither process can truncate it while the other uses it.
class WatchdogSharedMemory {
 public:
  /// Makes the page. `off`: zero-force packet, for bulk OUT `endpoint`.
  static Result<std::unique_ptr<WatchdogSharedMemory>> make(std::uint8_t endpoint, std::span<const std::uint8_t> off);
  ~WatchdogSharedMemory();
  WatchdogSharedMemory(const WatchdogSharedMemory&) = delete;
  WatchdogSharedMemory& operator=(const WatchdogSharedMemory&) = delete;

  watchdog::SharedPage& page() const { return *page_; }
  int fd() const { return fd_; }

 private:
  WatchdogSharedMemory(int fd, watchdog::SharedPage* page) : fd_(fd), page_(page) {}
  int fd_;
  watchdog::SharedPage* page_;
};

/// A watchdog of one open device. If it is destroyed without quit() it cuts the force, as if the program had exited.
class ExternalWatchdog {
 public:
  virtual ~ExternalWatchdog() = default;
  virtual bool is_alive() noexcept = 0;
  /// Ends the watchdog at once, without a packet: the driver has already sent zero force.
  virtual void quit() noexcept = 0;
};

/// Starts a watchdog for an open device and its shared page; an Error where it cannot be started.
using WatchdogLauncher = std::function<Result<std::unique_ptr<ExternalWatchdog>>(Transport&, const WatchdogSharedMemory&)>;

/// Returns a launcher that starts the program at `path` in a session of its own and waits until it watches.
WatchdogLauncher make_watchdog_launcher(const std::string& path);

}  // namespace catena::haptics::usb
