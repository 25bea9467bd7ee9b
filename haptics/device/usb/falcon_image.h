/// The firmware that a Falcon wants after each power-up: a TI C2000 boot stream of 16-bit words, low byte first
///   key 0x08AA, 8 reserved words, entry address (high, low), then blocks {size in words, address high, address low, data},
///   ending with a block of size 0
/// Catena has none to give: it is the vendor's. The structure is checked before a byte is sent. Off the tick.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"

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

}  // namespace catena::haptics::usb
