// SPDX-License-Identifier: MIT
#include "engine/io/chunks/hdf5_filters.h"

#include <blosc.h>
#include <hdf5.h>
#include <lz4.h>
#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include "engine/io/chunks/codecs.h"

namespace catena::chunks {
namespace {

/// Decompresses `bytes` of *buffer to `size` bytes by `decode`, which returns whether it succeeded; replaces the buffer. Returns 0 on
/// failure.
template <class Decode>
std::size_t replace(std::size_t bytes, std::uint64_t size, std::size_t* buffer_bytes, void** buffer, const Decode& decode) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{512} << 20;
  if (size < 1 || size > kMaxBytes) return 0;
  void* const out = std::malloc(size);
  const bool success =
      out != nullptr && decode(std::span(static_cast<const std::byte*>(*buffer), bytes), std::span(static_cast<std::byte*>(out), size));
  if (!success) {
    std::free(out);
    return 0;
  }
  std::free(*buffer);
  *buffer = out;
  *buffer_bytes = size;
  return size;
}

std::uint64_t big_endian(const std::byte* at, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | std::to_integer<std::uint64_t>(at[i]);
  return value;
}

/// The size of the data (8 bytes) and of a block (4), then each block with its size (4); a block of full size is not compressed.
bool decode_lz4_blocks(std::span<const std::byte> in, std::span<std::byte> out) {
  constexpr std::size_t kHead = 12;
  const std::uint64_t block = big_endian(in.data() + 8, 4);
  if (block < 1 || block > LZ4_MAX_INPUT_SIZE) return false;
  std::size_t from = kHead, to = 0;
  while (to < out.size()) {
    if (in.size() - from < 4) return false;
    const std::uint64_t size = std::min<std::uint64_t>(block, out.size() - to), stored = big_endian(in.data() + from, 4);
    from += 4;
    if (stored > in.size() - from) return false;
    if (stored == size) {
      std::memcpy(out.data() + to, in.data() + from, size);
    } else if (::LZ4_decompress_safe(reinterpret_cast<const char*>(in.data()) + from, reinterpret_cast<char*>(out.data()) + to,
                                     static_cast<int>(stored), static_cast<int>(size)) != static_cast<int>(size)) {
      return false;
    }
    from += stored;
    to += size;
  }
  return true;
}

std::size_t lz4_filter(unsigned flags, std::size_t, const unsigned*, std::size_t bytes, std::size_t* buffer_bytes, void** buffer) {
  constexpr std::size_t kHead = 12;
  if ((flags & H5Z_FLAG_REVERSE) == 0 || bytes < kHead) return 0;
  return replace(bytes, big_endian(static_cast<const std::byte*>(*buffer), 8), buffer_bytes, buffer, decode_lz4_blocks);
}

std::size_t blosc_filter(unsigned flags, std::size_t, const unsigned*, std::size_t bytes, std::size_t* buffer_bytes, void** buffer) {
  std::size_t size = 0;
  if ((flags & H5Z_FLAG_REVERSE) == 0 || bytes < BLOSC_MIN_HEADER_LENGTH || ::blosc_cbuffer_validate(*buffer, bytes, &size) != 0) return 0;
  return replace(bytes, size, buffer_bytes, buffer, [](auto in, auto out) { return static_cast<bool>(decompress(Codec::blosc, in, out)); });
}

std::size_t zstd_filter(unsigned flags, std::size_t, const unsigned*, std::size_t bytes, std::size_t* buffer_bytes, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0) return 0;
  return replace(bytes, ::ZSTD_getFrameContentSize(*buffer, bytes), buffer_bytes, buffer,
                 [](auto in, auto out) { return static_cast<bool>(decompress(Codec::zstd, in, out)); });
}

}  // namespace

void register_hdf5_filters() {
  ::H5PLset_loading_state(0);
  constexpr H5Z_class2_t kFilters[] = {{H5Z_CLASS_T_VERS, 32004, 0, 1, "lz4", nullptr, nullptr, lz4_filter},
                                       {H5Z_CLASS_T_VERS, 32001, 0, 1, "blosc", nullptr, nullptr, blosc_filter},
                                       {H5Z_CLASS_T_VERS, 32015, 0, 1, "zstd", nullptr, nullptr, zstd_filter}};
  for (const H5Z_class2_t& filter : kFilters) ::H5Zregister(&filter);
}

}  // namespace catena::chunks
