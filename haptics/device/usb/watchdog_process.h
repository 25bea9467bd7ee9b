/// A driver's side of the watchdog process (haptics/watchdog): the page that both see, and the process as something that is started for
/// an open device and told to end. Not on the haptic thread; the page's numbers are for any.
#pragma once
#include <sys/types.h>

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "haptics/device/usb/ftdi.h"
#include "haptics/watchdog/watch.h"

namespace catena::haptics::usb {

/// The shared page. Its size is sealed: nobody can take it from under the other.
class WatchdogSharedMemory {
 public:
  /// `off`: the packet that takes the force away, for bulk OUT `endpoint`.
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

/// Something that watches one open device. Destroyed without quit() it takes the force away: as if the program were gone.
class ExternalWatchdog {
 public:
  virtual ~ExternalWatchdog() = default;
  virtual bool is_alive() noexcept = 0;
  virtual void quit() noexcept = 0;  ///< the motors have had their zero: it ends at once, and writes nothing
};

using WatchdogLauncher = std::function<Result<std::unique_ptr<ExternalWatchdog>>(Transport&, const WatchdogSharedMemory&)>;

/// Starts the program at `path` in a session of its own; waits until it watches.
WatchdogLauncher make_watchdog_launcher(const std::string& path);

}  // namespace catena::haptics::usb
