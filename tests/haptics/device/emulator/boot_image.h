// SPDX-License-Identifier: MIT
/// A synthetic boot stream in the C2000 format, for tests, because the vendor's firmware may not be redistributed.
#pragma once
#include <cstdint>
#include <vector>

namespace catena::haptics::tests {

/// A stream with blocks of the given sizes (words), filled with a pattern.
inline std::vector<std::uint8_t> boot_image(const std::vector<int>& blocks) {
  std::vector<std::uint16_t> words{0x08AA, 0, 0, 0, 0, 0, 0, 0, 0, 0x003F, 0x8000};
  std::uint16_t pattern = 0x1234;
  for (const int size : blocks) {
    words.insert(words.end(), {static_cast<std::uint16_t>(size), 0x003F, 0x8000});
    for (int i = 0; i < size; ++i) words.push_back(pattern = static_cast<std::uint16_t>(pattern * 25173u + 13849u));
  }
  words.push_back(0);
  std::vector<std::uint8_t> bytes;
  for (const std::uint16_t word : words) {
    bytes.push_back(static_cast<std::uint8_t>(word));
    bytes.push_back(static_cast<std::uint8_t>(word >> 8));
  }
  return bytes;
}

}  // namespace catena::haptics::tests
