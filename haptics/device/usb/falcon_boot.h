/// The firmware that a Falcon wants after each power-up: a TI C2000 boot stream of 16-bit words, low byte first
///   key 0x08AA, 8 reserved words, entry address (high, low), then blocks {size in words, address high, address low, data},
///   ending with a block of size 0
/// Catena has none to give: it is the vendor's. The structure is checked before a byte is sent. Off the tick.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "haptics/device/usb/falcon_codec.h"
#include "haptics/device/usb/ftdi.h"

namespace catena::haptics::usb {

inline constexpr std::size_t kFalconImageMaxBytes = std::size_t{512} * 1024;

struct FalconImageInfo {
  std::uint32_t entry = 0;  ///< word address, 22 bits
  int blocks = 0;
  std::size_t data_words = 0;
};

/// `name` for the message, which gives the byte offset and what was expected there.
Result<FalconImageInfo> check_falcon_image(std::span<const std::uint8_t> image, const std::string& name);

/// The whole file, checked.
Result<std::vector<std::uint8_t>> read_falcon_image(const std::string& path);

/// From a Falcon that was just opened to one whose firmware runs: look whether it does already; else hand shake, send the
/// image in 62-byte chunks (the device echoes every byte; compared), start it, look again. Uploads fail at first in practice:
/// up to 10 tries. Waiting is bounded by counts of packets and time-outs, not by a clock. I/O thread, or before it starts.
struct FalconBootOptions {
  int max_attempts = 10;       ///< of the whole upload
  int max_handshakes = 100;    ///< of each
  int max_probe_packets = 12;  ///< I/O packets that ask for running firmware
  /// Told now and then: what is being done, and the share of the image that is sent. False: give up.
  std::function<bool(int attempt, double share)> progress;
  /// Asked before every packet; true: give up at once.
  std::function<bool()> should_abort;
};

/// Purge; latency 1 ms; 1.5 Mbaud; purge.
UsbError enter_falcon_run_mode(Ftdi& ftdi) noexcept;

/// Does firmware answer? The error: unplugged, or the bus itself fails.
Result<bool> falcon_is_running(Ftdi& ftdi, const FalconBootOptions& options = {});

/// After it the firmware runs. `image` may be empty: then a device without firmware is an error that says what to give.
/// `uploads`, if given, counts the tries.
Outcome falcon_boot(Ftdi& ftdi, std::span<const std::uint8_t> image, const FalconBootOptions& options, std::atomic<std::uint64_t>* uploads);

}  // namespace catena::haptics::usb
