// SPDX-License-Identifier: MIT
/// The pages (image file directories) of a TIFF or BigTIFF file, read directly: libtiff finds a page only by reading all before it.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/base/result.h"

namespace catena::chunks {

/// A page: what decides whether pages belong to one image.
struct TiffPage {
  std::uint64_t offset = 0;  ///< Of its directory in the file.
  std::int64_t width = 0, height = 0;
  int bits = 1, samples = 1, format = 1;  ///< Bits a sample, samples a pixel, 1: unsigned, 2: signed, 3: float.
  bool is_separate = false;               ///< Samples are in planes of their own.
  bool is_reduced = false;                ///< A preview or a coarser level of another page.
  std::int64_t depth = 1;                 ///< Slices of a tile; only 1 is read.
  std::vector<std::uint64_t> coarser;     ///< Directories of coarser levels of this page.

  /// Returns whether two pages have the same size and type.
  bool is_like(const TiffPage& other) const {
    return width == other.width && height == other.height && bits == other.bits && samples == other.samples && format == other.format;
  }
};

/// Reads the chain of pages. Returns an Error with a message fragment: the file is no TIFF, a directory lies outside of it, the chain is a
/// loop or has more than a million pages.
Result<std::vector<TiffPage>> read_tiff_pages(int file, std::uint64_t file_bytes);

/// Reads one directory. Same errors.
Result<TiffPage> read_tiff_page(int file, std::uint64_t file_bytes, std::uint64_t offset);

}  // namespace catena::chunks
