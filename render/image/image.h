/// Pictures on the host and PNG files. Values are display values, unchanged; alpha is straight.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

/// A picture of 8 bits a channel.
struct Image8 {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<std::uint8_t> rgba;       ///< row 0 at the top, 4 bytes a pixel

  /// The four bytes of a pixel; x and y lie within the picture.
  const std::uint8_t* pixel(std::uint32_t x, std::uint32_t y) const { return rgba.data() + 4 * (std::size_t(y) * width + x); }
};

/// The same before rounding: display values from 0 to 1.
struct ImageF32 {
  std::uint32_t width = 0, height = 0;  ///< pixels
  std::vector<float> rgba;              ///< row 0 at the top, 4 floats a pixel

  /// The four floats of a pixel; x and y lie within the picture.
  const float* pixel(std::uint32_t x, std::uint32_t y) const { return rgba.data() + 4 * (std::size_t(y) * width + x); }
};

/// Writes RGBA (`alpha`) or RGB, 8 bits. A regular file is written beside its place and renamed when complete; nothing half-written stays.
Outcome write_png(const std::string& path, const Image8& picture, bool alpha);
/// Reads an 8-bit PNG file of any kind as RGBA. An error names the file.
Result<Image8> read_png(const std::string& path);

}  // namespace catena::render
