// SPDX-License-Identifier: MIT
/// Changes of a recording's bytes with recomputed hashes, so that they reach the code behind the hash checks.
#pragma once
#include <algorithm>
#include <cstring>
#include <string>

#include "engine/base/hash.h"
#include "haptics/servo/log/format.h"
#include "tests/fuzz/mutate.h"

namespace catena::test {

inline std::uint64_t block_hash(const char* data, std::size_t size) {
  Fnv1a hash;
  hash.add_bytes(data, size);
  return hash.value;
}

/// Recomputes the hashes of all blocks that can be reached by their lengths.
inline void rewrite_hashes(std::string& bytes) {
  for (std::size_t at = haptics::log::kPreambleBytes; at + sizeof(haptics::log::BlockHeader) <= bytes.size();) {
    haptics::log::BlockHeader head;
    std::memcpy(&head, bytes.data() + at, sizeof head);
    if (head.magic != haptics::log::BlockHeader::kBlockMagic || head.length > bytes.size() - at - sizeof head) return;
    head.payload_hash = block_hash(bytes.data() + at + sizeof head, head.length);
    head.header_hash = block_hash(reinterpret_cast<const char*>(&head), haptics::log::BlockHeader::kHashedBytes);
    std::memcpy(bytes.data() + at, &head, sizeof head);
    at += sizeof head + head.length;
  }
}

/// Changes bytes and numbers in place, so that the blocks keep their positions.
inline std::string mutate_in_place(std::string bytes, Random& random, std::size_t from = haptics::log::kPreambleBytes,
                                   std::size_t behind = std::string::npos) {
  constexpr std::uint64_t kNumbers[] = {
      0, 1, 2, 7, 8, 9, 255, 0x7fffffff, 0x80000000u, 0xffffffffu, ~std::uint64_t{0}, ~std::uint64_t{0} >> 1};
  for (std::size_t i = 0, n = 1 + random.below(4); i < n; ++i) {
    const std::size_t at = from + random.below(std::min(behind, bytes.size()) - from - 8);
    if (random.below(2) == 0) {
      bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1u << random.below(8)));
    } else {
      const std::uint64_t number = kNumbers[random.below(std::size(kNumbers))];
      std::memcpy(bytes.data() + at, &number, random.below(2) == 0 ? 4 : 8);
    }
  }
  return bytes;
}

}  // namespace catena::test
