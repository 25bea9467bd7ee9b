// SPDX-License-Identifier: MIT
/// Decompression of chunks into memory of a known size. Any thread.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena::chunks {

/// Compressed formats of chunks.
enum class Codec {
  none,
  deflate,  ///< zlib or gzip, recognized by its first bytes.
  blosc,
  zstd,
  lz4,  ///< The size in four bytes, little-endian, then one LZ4 block: numcodecs.
};

/// Returns the codec with a name of numcodecs ("zlib", "gzip", "blosc", "zstd", "lz4"); nullopt: another one.
std::optional<Codec> find_codec(std::string_view id);

/// Decompresses into `out`, which must be filled exactly. Returns an Error with a message fragment ("has 12 bytes, expected 4096").
Outcome decompress(Codec codec, std::span<const std::byte> in, std::span<std::byte> out);

/// Reads at most `max_bytes` of a regular file. Nullopt: there is no such file. Returns an Error with a message fragment; a system failure
/// where the system is at fault.
Result<std::optional<std::vector<std::byte>>> read_chunk_file(const char* path, std::size_t max_bytes);

}  // namespace catena::chunks
