// SPDX-License-Identifier: MIT
#include "engine/io/chunks/tiff_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>

#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/chunks/zarr_array.h"

namespace catena::chunks {
namespace {

std::string last_error;  ///< libtiff's last message; one thread

void on_error(const char*, const char* format, va_list arguments) {
  char text[512];
  if (std::vsnprintf(text, sizeof text, format, arguments) > 0) last_error = one_line(text);
}

Error damaged(std::string_view what) {
  const std::string reason = last_error.empty() ? "" : " (" + last_error + ")";
  return Error{fmt::format("is damaged: {}{}", what, reason)};
}

}  // namespace

TiffFile::~TiffFile() {
  if (tiff_ != nullptr) ::TIFFCleanup(tiff_);
}

Result<std::unique_ptr<TiffFile>> TiffFile::open(const std::string& path, struct stat& about) {
  ::TIFFSetErrorHandler(on_error);
  ::TIFFSetWarningHandler(nullptr);
  std::unique_ptr<TiffFile> opened(new TiffFile);
  opened->file_ = FileDescriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!opened->file_ || ::fstat(opened->file_.get(), &about) != 0)
    return Error{fmt::format("cannot be opened ({})", describe_errno(errno)), is_system_failure(errno)};
  if (!S_ISREG(about.st_mode)) return Error{"is not a regular file"};
  opened->bytes_ = static_cast<std::uint64_t>(about.st_size);
  CATENA_TRY(opened->pages_, read_tiff_pages(opened->file_.get(), opened->bytes_));
  last_error.clear();
  // without memory mapping: a file that becomes shorter must not end this process
  opened->tiff_ = ::TIFFFdOpen(opened->file_.get(), path.c_str(), "rm");
  if (opened->tiff_ == nullptr) return damaged("it cannot be opened");
  return opened;
}

std::string TiffFile::description(double (&pixels_per_unit)[2]) {
  char* text = nullptr;
  selected_ = 0;
  if (::TIFFSetSubDirectory(tiff_, pages_.front().offset) == 0) return {};
  float x = 0, y = 0;
  if (::TIFFGetField(tiff_, TIFFTAG_XRESOLUTION, &x) == 1) pixels_per_unit[0] = static_cast<double>(x);
  if (::TIFFGetField(tiff_, TIFFTAG_YRESOLUTION, &y) == 1) pixels_per_unit[1] = static_cast<double>(y);
  return ::TIFFGetField(tiff_, TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text != nullptr ? text : "";
}

Result<TiffTiling> TiffFile::select(std::uint64_t offset, const TiffPage& expected) {
  if (offset == selected_ && offset != 0) return tiling_;
  last_error.clear();
  selected_ = 0;
  CATENA_TRY(const TiffPage page, read_page(offset));
  if (!page.is_like(expected) || page.is_separate != expected.is_separate)
    return Error{fmt::format("has a page of {} x {} pixels of {} bits, expected {} x {} of {} bits as in the first one", page.width,
                             page.height, page.bits * page.samples, expected.width, expected.height, expected.bits * expected.samples)};
  if (::TIFFSetSubDirectory(tiff_, offset) == 0) return damaged("a page cannot be read");
  std::uint16_t compression = COMPRESSION_NONE, photometric = PHOTOMETRIC_MINISBLACK;
  ::TIFFGetFieldDefaulted(tiff_, TIFFTAG_COMPRESSION, &compression);
  ::TIFFGetFieldDefaulted(tiff_, TIFFTAG_PHOTOMETRIC, &photometric);
  if (::TIFFIsCODECConfigured(compression) == 0)
    return Error{fmt::format("has the compression {}, which libtiff does not decode", compression)};
  if (photometric == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG)
    ::TIFFSetField(tiff_, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  else if (photometric == PHOTOMETRIC_YCBCR)
    return Error{"has colors in YCbCr, expected RGB or gray"};
  tiling_ = {};
  tiling_.is_tiled = ::TIFFIsTiled(tiff_) != 0;
  std::uint32_t width = 0, height = 0;
  if (tiling_.is_tiled) {
    ::TIFFGetField(tiff_, TIFFTAG_TILEWIDTH, &width);
    ::TIFFGetField(tiff_, TIFFTAG_TILELENGTH, &height);
  } else {
    width = static_cast<std::uint32_t>(page.width);
    ::TIFFGetFieldDefaulted(tiff_, TIFFTAG_ROWSPERSTRIP, &height);
    height = std::min(height, static_cast<std::uint32_t>(page.height));
  }
  const std::uint64_t bytes = tiling_.is_tiled ? ::TIFFTileSize64(tiff_) : ::TIFFStripSize64(tiff_);
  const double samples = page.is_separate ? 1 : page.samples;
  const double wanted = static_cast<double>(width) * height * samples * page.bits / 8;
  if (width < 1 || height < 1 || width > kMaxChunkBytes || height > kMaxChunkBytes || static_cast<double>(bytes) != wanted)
    return damaged("the size of its tiles or strips is invalid");
  if (bytes > kMaxChunkBytes) return Error{fmt::format("has tiles or strips of {} bytes, expected at most {}", bytes, kMaxChunkBytes)};
  tiling_.width = static_cast<int>(width);
  tiling_.height = static_cast<int>(height);
  height_ = static_cast<int>(page.height);
  selected_ = offset;
  return tiling_;
}

Result<std::vector<std::byte>> TiffFile::decode(int x, int y, int plane) {
  last_error.clear();
  const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
  const auto sample = static_cast<std::uint16_t>(plane);
  std::vector<std::byte> pixels(static_cast<std::size_t>(tiling_.is_tiled ? ::TIFFTileSize64(tiff_) : ::TIFFStripSize64(tiff_)));
  const std::uint32_t index = tiling_.is_tiled ? ::TIFFComputeTile(tiff_, column, row, 0, sample) : ::TIFFComputeStrip(tiff_, row, sample);
  if (::TIFFGetStrileByteCount(tiff_, index) == 0 && last_error.empty()) return pixels;  // sparse: 0
  const auto size = static_cast<tmsize_t>(pixels.size());
  const tmsize_t got = tiling_.is_tiled ? ::TIFFReadEncodedTile(tiff_, index, pixels.data(), size)
                                        : ::TIFFReadEncodedStrip(tiff_, index, pixels.data(), size);
  // the last strip has fewer rows
  const int rows = std::min(tiling_.height, height_ - y / tiling_.height * tiling_.height);
  if (got < 0 || got < size / tiling_.height * (tiling_.is_tiled ? tiling_.height : rows))
    return damaged("a tile or strip cannot be decoded");
  return pixels;
}

}  // namespace catena::chunks
