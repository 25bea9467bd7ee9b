/// A PNG file written row by row, so that a large picture never lies in memory: 8 or 16 bits, grey, RGB or RGBA (straight alpha).
/// Values are stored as they come. Without a commit nothing stays behind (engine/base/output_file.h). One thread.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/base/result.h"

namespace catena::render {

/// What the file will be.
struct PngFormat {
  std::uint32_t width = 0, height = 0;  ///< pixels
  int bits = 8;                         ///< 8 or 16
  int channels = 4;                     ///< 1, 3 or 4
  /// A text chunk, if the key is not empty: what the numbers of the picture mean.
  std::string text_key{}, text{};  ///< no line ends in the key
};

/// The writer.
class PngWriter {
 public:
  /// Begins the file beside its place. An error names it.
  static Result<PngWriter> open(const std::string& path, const PngFormat& format);
  ~PngWriter();
  /// Takes the file over; `other` has none then.
  PngWriter(PngWriter&&) noexcept;
  PngWriter& operator=(PngWriter&&) = delete;

  /// The next rows, whole ones, from the top.
  Outcome write_rows(std::span<const std::uint8_t> values);   ///< 8 bits
  Outcome write_rows(std::span<const std::uint16_t> values);  ///< 16 bits
  /// After the last row: all of it is on its way to the disk.
  Outcome finish();
  /// The rename to the final name.
  Outcome commit();

 private:
  struct Impl;
  explicit PngWriter(std::unique_ptr<Impl> parts);
  Outcome encode_row(const std::uint8_t* row);
  std::unique_ptr<Impl> impl_;
};

/// round(65535 x) of a display value; the same for 255. OutwardSide 0 .. 1 and not a number: clamped, 0.
constexpr std::uint32_t quantize(float x, std::uint32_t most) {
  return x > 0 ? x < 1 ? std::uint32_t(double(most) * double(x) + 0.5) : most : 0;
}

}  // namespace catena::render
