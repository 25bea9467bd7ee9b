/// An OpenEXR file of 32-bit floats, written row by row (scan lines, ZIP). OpenEXR holds colours as linear light, premultiplied by
/// alpha: see premultiplied_linear(). Without a commit nothing stays behind (engine/base/output_file.h). One thread.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

struct ExrFormat {
  std::uint32_t width = 0, height = 0;
  std::vector<std::string> channels;  ///< in the order of the values: "R", "G", "B", "A" or "Z"
  std::string comments{};
};

class ExrWriter {
 public:
  static Result<ExrWriter> open(const std::string& path, const ExrFormat& format);
  ~ExrWriter();
  ExrWriter(ExrWriter&&) noexcept;
  ExrWriter& operator=(ExrWriter&&) = delete;

  /// The next rows, whole ones, from the top; the channels of a pixel lie together.
  Outcome write_rows(std::span<const float> values);
  /// After the last row: all of it is on its way to the disk.
  Outcome finish();
  /// The rename to the final name.
  Outcome commit();

 private:
  struct Impl;
  explicit ExrWriter(std::unique_ptr<Impl> parts);
  std::unique_ptr<Impl> impl_;
};

/// The standard's transfer function of a display (sRGB) value: linear below 0.04045, a power of 2.4 above.
float linear_from_display(float display);
/// Of a display colour with straight alpha.
std::array<float, 4> premultiplied_linear(const float* rgba);

}  // namespace catena::render
