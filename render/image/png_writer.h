// SPDX-License-Identifier: MIT
/// Writes a PNG file row by row, so that a large image is never in memory: 8 or 16 bits, gray, RGB or RGBA (straight alpha). Values are
/// stored unchanged. Without commit() no file is left behind (engine/base/output_file.h). One thread.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/base/export.h"
#include "engine/base/result.h"

namespace catena::render {

/// Format of the file.
struct PngFormat {
  std::uint32_t width = 0, height = 0;  ///< pixels, greater than 0
  int bits = 8;                         ///< 8 or 16
  int channels = 4;                     ///< 1, 3 or 4
  /// Text chunk, if the key is not empty: meaning of the image's values.
  std::string text_key{}, text{};  ///< no line breaks in the key
};

/// Writer of one file.
class CATENA_EXPORT PngWriter {
 public:
  /// Begins a temporary file. An Error gives the path.
  static Result<PngWriter> open(const std::string& path, const PngFormat& format);
  ~PngWriter();
  /// Moves the writer; `other` is empty afterwards.
  PngWriter(PngWriter&&) noexcept;
  PngWriter& operator=(PngWriter&&) = delete;

  /// Writes the next rows, from the top; whole rows only.
  Outcome write_rows(std::span<const std::uint8_t> values);   ///< 8 bits
  Outcome write_rows(std::span<const std::uint16_t> values);  ///< 16 bits
  /// Completes the file after the last row: all data has been handed to the disk.
  Outcome finish();
  /// Renames the file to its final name.
  Outcome commit();

 private:
  struct Impl;
  explicit PngWriter(std::unique_ptr<Impl> parts);
  Outcome encode_row(const std::uint8_t* row);
  std::unique_ptr<Impl> impl_;
};

/// Returns round(most x) of a display value, with `max_value` 65535 or 255. Values outside 0 .. 1 are clamped; NaN gives 0.
constexpr std::uint32_t quantize(float x, std::uint32_t max_value) {
  return x > 0 ? x < 1 ? std::uint32_t(double(max_value) * double(x) + 0.5) : max_value : 0;
}

}  // namespace catena::render
