// SPDX-License-Identifier: MIT
/// Metadata of a Zarr array, version 2: the file .zarray, checked before anything is read.
///   dtype        numbers of 1 to 8 bytes, either byte order; |b1 as uint8
///   order        C or F; compressor null, zlib, gzip, blosc, zstd, lz4; filters: none, or delta
///   fill_value   a number, "NaN", "Infinity", "-Infinity", or null: 0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/io/chunks/codecs.h"

namespace catena::chunks {

/// Most axes of an array, and largest decoded chunk, bytes.
inline constexpr std::size_t kMaxZarrAxes = 8;
inline constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{512} << 20;

/// A number type in a file.
struct StoredType {
  std::string name;  ///< Name as in engine/field/number_type.h.
  std::size_t bytes = 0;
  bool is_swapped = false;  ///< The byte order is not the host's.
};

/// An array and the layout of its chunks.
struct ZarrArray {
  std::string folder;  ///< Folder of the array, relative to the store; empty: the store itself.
  std::vector<std::int64_t> shape, chunk;
  StoredType type;
  bool is_fortran = false;
  Codec codec = Codec::none;
  bool has_delta = false;
  StoredType delta_type;  ///< Type of the stored differences.
  char separator = '.';
  std::array<std::byte, 8> fill{};  ///< The fill value, native byte order.

  /// Returns the bytes of a decoded chunk.
  std::size_t chunk_bytes() const;
  /// Decodes the contents of a chunk's file into numbers in native byte order. Returns an Error with a message fragment.
  Result<std::vector<std::byte>> decode(std::span<const std::byte> file) const;
};

/// Parses the text of .zarray; `name`: of the file, for messages, complete.
Result<ZarrArray> parse_zarr_array(const std::string& text, const std::string& name);

/// Parses a type of NumPy such as "<u2". Returns an Error with a message fragment ("dtype is ...").
Result<StoredType> parse_numpy_type(std::string_view text);

/// Converts a number in native byte order to double.
double to_double(const StoredType& type, const std::byte* number);

}  // namespace catena::chunks
