// SPDX-License-Identifier: MIT
/// Images in host memory and PNG files. Values are display values, stored unchanged; alpha is straight.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"

namespace catena::render {

/// Image with 8 bits per channel.
struct Image8 {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<std::uint8_t> rgba;       ///< row 0 at the top, 4 bytes per pixel

  /// Returns the four bytes of a pixel; x and y must be inside the image.
  const std::uint8_t* pixel(std::uint32_t x, std::uint32_t y) const { return rgba.data() + 4 * (std::size_t(y) * width + x); }
};

/// Image of floats: display values from 0 to 1 before rounding.
struct ImageF32 {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<float> rgba;              ///< row 0 at the top, 4 floats per pixel

  /// Returns the four floats of a pixel; x and y must be inside the image.
  const float* pixel(std::uint32_t x, std::uint32_t y) const { return rgba.data() + 4 * (std::size_t(y) * width + x); }
};

/// Writes an 8-bit PNG file, RGBA (`alpha`) or RGB. A regular file is written under a temporary name and renamed when complete, so that no
/// incomplete file is left. An Error gives the path.
CATENA_EXPORT Outcome write_png(const std::string& path, const Image8& image, bool alpha);
/// Reads an 8-bit PNG file of any kind as RGBA. An Error gives the path.
CATENA_EXPORT Result<Image8> read_png(const std::string& path);

}  // namespace catena::render
