// SPDX-License-Identifier: MIT
/// Private to this module: decodes numbers from bytes of either byte order.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace catena::curves {

static_assert(std::endian::native == std::endian::little);

/// Decodes the `sizeof(T)` bytes at `bytes`; no alignment is needed. The host is little-endian.
template <class T>
T decode_number(const char* bytes, bool big_endian) {
  std::array<char, sizeof(T)> own;
  std::memcpy(own.data(), bytes, sizeof(T));
  if (big_endian) std::reverse(own.begin(), own.end());
  return std::bit_cast<T>(own);
}

}  // namespace catena::curves
