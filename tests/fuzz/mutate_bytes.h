// SPDX-License-Identifier: MIT
/// Deterministic mutations of a binary file: bits and bytes changed, extreme numbers, parts cut, duplicated and exchanged.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "tests/fuzz/mutate.h"

namespace catena::test {

inline constexpr auto kExtremeNumbers =
    std::to_array<std::uint64_t>({0, 1, 2, 0x7f, 0x80, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff, 0x100000000,
                                  0x7fffffffffffffff, 0x8000000000000000, 0xffffffffffffffff, 0x7ff8000000000000});

/// Applies one to `max_changes` changes within bytes [first, last).
inline std::string mutate_bytes(std::string bytes, Random& random, std::size_t max_changes = 3, std::size_t first = 0,
                                std::size_t last = ~std::size_t{0}) {
  const std::size_t changes = 1 + random.below(max_changes);
  for (std::size_t i = 0; i < changes && first < bytes.size(); ++i) {
    const std::size_t end = std::min(last, bytes.size()), at = first + random.below(end - first);
    switch (random.below(8)) {
      case 0:
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1u << random.below(8)));
        break;
      case 2:
      case 3:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 4:
      case 5: {
        // a number of 1, 2, 4 or 8 bytes: extreme, or close to its value
        const std::size_t width = std::min(std::size_t{1} << random.below(4), end - at);
        std::uint64_t number = 0;
        std::memcpy(&number, bytes.data() + at, width);
        number = random.below(2) == 0 ? kExtremeNumbers[random.below(std::size(kExtremeNumbers))] : number + random.below(17) - 8;
        std::memcpy(bytes.data() + at, &number, width);
        break;
      }
      case 6: {
        const std::size_t from = first + random.below(end - first), count = std::min({random.below(64), end - at, end - from});
        std::memmove(bytes.data() + at, bytes.data() + from, count);
        break;
      }
      default:
        if (random.below(4) == 0)
          bytes.erase(at, 1 + random.below(64));
        else if (random.below(3) == 0)
          bytes.insert(at, bytes.substr(first + random.below(end - first), random.below(64)));
        else
          bytes[at] = static_cast<char>(bytes[at] + 1);
    }
  }
  return bytes;
}

}  // namespace catena::test
