// SPDX-License-Identifier: MIT
/// An open TIFF file: its pages, and tiles and strips decoded by libtiff.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/helper_process.h"
#include "engine/base/result.h"
#include "engine/io/chunks/tiff_pages.h"

struct tiff;

namespace catena::chunks {

/// How the pixels of a page are stored: a tile, or a strip as wide as the page.
struct TiffTiling {
  int width = 1, height = 1;
  bool is_tiled = false;
};

/// Used by one thread. Errors are message fragments.
class TiffFile {
 public:
  /// Opens a regular file; `about` receives its state.
  static Result<std::unique_ptr<TiffFile>> open(const std::string& path, struct stat& about);
  ~TiffFile();

  const std::vector<TiffPage>& pages() const { return pages_; }
  /// Selects a directory and checks that it is like `expected`; returns its tiling.
  Result<TiffTiling> select(std::uint64_t offset, const TiffPage& expected);
  /// Decodes the tile or strip that contains a pixel of the selected directory, in native byte order; `plane`: the sample, where samples
  /// are separate, else 0.
  Result<std::vector<std::byte>> decode(int x, int y, int plane);
  /// Returns the description of the first page, and its pixels per unit of length.
  std::string description(double (&pixels_per_unit)[2]);
  /// Reads a directory that is not in the chain of pages.
  Result<TiffPage> read_page(std::uint64_t offset) const { return read_tiff_page(file_.get(), bytes_, offset); }

 private:
  TiffFile() = default;
  FileDescriptor file_;
  std::uint64_t bytes_ = 0, selected_ = 0;
  TiffTiling tiling_;
  int height_ = 1;  ///< Of the selected page.
  ::tiff* tiff_ = nullptr;
  std::vector<TiffPage> pages_;
};

}  // namespace catena::chunks
