/// FNV-1a, 64 bit: the hash of `state_hash`.
#pragma once
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace catena {

/// A running hash: feed it, then read `value`. Any thread, each its own.
struct Fnv1a {
  std::uint64_t value = 0xcbf29ce484222325ull;  ///< the hash of what was fed so far

  /// Feeds `size` bytes.
  void add_bytes(const void* data, std::size_t size) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value = (value ^ p[i]) * 0x100000001b3ull;
  }
  /// Feeds the bytes of a number, as this machine orders them.
  template <class T>
  void add(const T& item) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>, "no padding, please");
    add_bytes(&item, sizeof item);
  }
};

/// The hash of `size` bytes at once.
inline std::uint64_t hash_bytes(const void* data, std::size_t size) {
  Fnv1a hash;
  hash.add_bytes(data, size);
  return hash.value;
}

}  // namespace catena
