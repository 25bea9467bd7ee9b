/// Private to this room: numbers out of bytes of either order.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace catena::curves {

static_assert(std::endian::native == std::endian::little);

template <class T>
T decode_number(const char* bytes, bool big_endian) {
  std::array<char, sizeof(T)> own;
  std::memcpy(own.data(), bytes, sizeof(T));
  if (big_endian) std::reverse(own.begin(), own.end());
  return std::bit_cast<T>(own);
}

}  // namespace catena::curves
