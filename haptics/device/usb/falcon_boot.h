/// From a Falcon that was just opened to one whose firmware runs: look whether it does already; else hand shake, send the
/// image in 62-byte chunks (the device echoes every byte; compared), start it, look again. Uploads fail at first in practice:
/// up to 10 tries. Waiting is bounded by counts of packets and time-outs, not by a clock. I/O thread, or before it starts.
#pragma once
#include <functional>

#include "haptics/device/usb/falcon_codec.h"
#include "haptics/device/usb/ftdi.h"

namespace catena::haptics::usb {

struct FalconBootOptions {
  int tries = 10;             ///< of the whole upload
  int handshake_tries = 100;  ///< of each
  int probe_tries = 12;       ///< I/O packets that ask for running firmware
  /// Told now and then: what is being done, and the share of the image that is sent. False: give up.
  std::function<bool(int attempt, double share)> progress;
  /// Asked before every packet; true: give up at once.
  std::function<bool()> give_up;
};

/// Purge; latency 1 ms; 1.5 Mbaud; purge.
UsbError falcon_run_mode(Ftdi& ftdi) noexcept;

/// Does firmware answer? The error: unplugged, or the bus itself fails.
Result<bool> falcon_is_running(Ftdi& ftdi, const FalconBootOptions& options = {});

/// After it the firmware runs. `image` may be empty: then a device without firmware is an error that says what to give.
/// `uploads`, if given, counts the tries.
Outcome falcon_boot(Ftdi& ftdi, std::span<const std::uint8_t> image, const FalconBootOptions& options, std::atomic<std::uint64_t>* uploads);

}  // namespace catena::haptics::usb
