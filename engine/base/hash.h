// SPDX-License-Identifier: MIT
/// FNV-1a hash, 64 bit, used for `state_hash`.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace catena {

/// Incremental hash: add data, then read `value`. Use one object per thread.
struct Fnv1a {
  std::uint64_t value = 0xcbf29ce484222325ull;  ///< hash of the data added

  /// Adds `size` bytes.
  void add_bytes(const void* data, std::size_t size) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value = (value ^ p[i]) * 0x100000001b3ull;
  }
  /// Adds the length and the bytes of a text.
  void add_text(std::string_view text) {
    add(text.size());
    add_bytes(text.data(), text.size());
  }
  /// Adds the bytes of a number in the byte order of this system. T must have no padding.
  template <class T>
  void add(const T& item) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>, "no padding, please");
    add_bytes(&item, sizeof item);
  }
};

/// Returns the hash of `size` bytes.
inline std::uint64_t hash_bytes(const void* data, std::size_t size) {
  Fnv1a hash;
  hash.add_bytes(data, size);
  return hash.value;
}

}  // namespace catena
