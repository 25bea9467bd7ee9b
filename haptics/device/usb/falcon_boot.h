// SPDX-License-Identifier: MIT
/// Firmware that a Falcon needs after each power-up: a TI C2000 boot stream of 16-bit words, low byte first
///   key 0x08AA, 8 reserved words, entry address (high, low), then blocks {size in words, address high, address low, data},
///   ending with a block of size 0
/// Catena does not include it: it belongs to the vendor. The structure is checked before any byte is sent. Off the tick.
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

/// Summary of a checked image.
struct FalconImageInfo {
  std::uint32_t entry = 0;  ///< entry point, a word address of 22 bits
  int blocks = 0;
  std::size_t data_words = 0;
};

/// Checks the structure of an image. `name` is its name in the Error, which has the byte offset and what was expected there.
Result<FalconImageInfo> check_falcon_image(std::span<const std::uint8_t> image, const std::string& name);

/// Reads a whole file and checks it.
Result<std::vector<std::uint8_t>> read_falcon_image(const std::string& path);

/// Boot procedure, from a Falcon that was just opened to one whose firmware runs: check whether it runs already; else handshake, send the
/// image in 62-byte chunks (the device echoes every byte; compared), start it, check again. The first uploads often fail in practice:
/// up to 10 attempts. Waiting is bounded by counts of packets and timeouts, not by a clock. I/O thread, or before it starts.
struct FalconBootOptions {
  int max_attempts = 10;       ///< attempts of the whole upload
  int max_handshakes = 100;    ///< handshakes per attempt
  int max_probe_packets = 12;  ///< I/O packets sent to detect running firmware
  /// Called during the upload with the attempt and the fraction of the image that was sent. False: cancel. May be empty.
  std::function<bool(int attempt, double share)> progress;
  /// Called before every packet; true: cancel at once. May be empty.
  std::function<bool()> should_abort;
};

/// Sets up the chip for I/O frames: purge; latency 1 ms; 1.5 Mbaud; purge.
UsbError enter_falcon_run_mode(Ftdi& ftdi) noexcept;

/// Returns whether the firmware responds. An Error: unplugged, or the bus itself fails.
Result<bool> falcon_is_running(Ftdi& ftdi, const FalconBootOptions& options = {});

/// Starts the firmware if it does not run. `image` may be empty: then a device without firmware is an Error that says what to provide.
/// `uploads`, if not null, counts the attempts.
Outcome falcon_boot(Ftdi& ftdi, std::span<const std::uint8_t> image, const FalconBootOptions& options, std::atomic<std::uint64_t>* uploads);

}  // namespace catena::haptics::usb
