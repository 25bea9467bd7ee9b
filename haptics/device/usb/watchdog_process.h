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
class WatchdogMemory {
 public:
  /// `off`: the packet that takes the force away, for bulk OUT `endpoint`.
  static Result<std::unique_ptr<WatchdogMemory>> make(std::uint8_t endpoint, std::span<const std::uint8_t> off);
  ~WatchdogMemory();
  WatchdogMemory(const WatchdogMemory&) = delete;
  WatchdogMemory& operator=(const WatchdogMemory&) = delete;

  watchdog::Page& page() const { return *page_; }
  int fd() const { return fd_; }

 private:
  WatchdogMemory(int fd, watchdog::Page* page) : fd_(fd), page_(page) {}
  int fd_;
  watchdog::Page* page_;
};

/// Something that watches one open device. Destroyed without quit() it takes the force away: as if the program were gone.
class ExternalWatchdog {
 public:
  virtual ~ExternalWatchdog() = default;
  virtual bool alive() noexcept = 0;
  virtual void quit() noexcept = 0;  ///< the motors have had their zero: it ends at once, and writes nothing
};

using StartWatchdog = std::function<Result<std::unique_ptr<ExternalWatchdog>>(Transport&, const WatchdogMemory&)>;

/// Starts the program at `path` in a session of its own; waits until it watches.
StartWatchdog watchdog_process(const std::string& path);

}  // namespace catena::haptics::usb
