// SPDX-License-Identifier: MIT
/// Writes an OpenEXR file of 32-bit floats row by row (scan lines, ZIP). OpenEXR stores colors as linear light, premultiplied by alpha: see
/// premultiplied_linear(). Without commit() no file is left behind (engine/base/output_file.h). One thread.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

/// Size, channels and comment of the file.
struct ExrFormat {
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> channels;  ///< in the order of the values: "R", "G", "B", "A" or "Z"
  std::string comments{};
};

/// Writer of one file.
class ExrWriter {
 public:
  /// Begins a temporary file. An Error gives the path.
  static Result<ExrWriter> open(const std::string& path, const ExrFormat& format);
  ~ExrWriter();
  ExrWriter(ExrWriter&&) noexcept;
  ExrWriter& operator=(ExrWriter&&) = delete;

  /// Writes the next rows, from the top; whole rows only, with the channels of a pixel interleaved.
  Outcome write_rows(std::span<const float> values);
  /// Completes the file after the last row: all data has been handed to the disk.
  Outcome finish();
  /// Renames the file to its final name.
  Outcome commit();

 private:
  struct Impl;
  explicit ExrWriter(std::unique_ptr<Impl> parts);
  std::unique_ptr<Impl> impl_;
};

/// Returns linear light for an sRGB display value: linear below 0.04045, a power of 2.4 above.
float linear_from_display(float display);
/// Returns the premultiplied linear color of a display color with straight alpha.
std::array<float, 4> premultiplied_linear(const float* rgba);

}  // namespace catena::render
