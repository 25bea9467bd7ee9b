// SPDX-License-Identifier: MIT
/// Destinations of an image's pixels: one sink per file. A sink is fed with bands of rows from the top; a file is written completely or not
/// at all.
#pragma once
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "render/quality/tiled_render.h"

namespace catena::app {

/// One output file.
class ImageSink {
 public:
  virtual ~ImageSink() = default;  ///< Removes the file unless commit() was called
  /// Writes the next band of rows.
  virtual Outcome write(const render::Band& band) = 0;
  /// Call after the last band (of the last frame): flushes all data to the file.
  virtual Outcome finish() = 0;
  /// Renames the temporary file to its final name.
  virtual Outcome commit() = 0;
};

/// Format of an image or of a video's frames.
struct ImageFormat {
  std::uint32_t width = 0, height = 0;
  bool alpha = false;  ///< The image has an alpha channel: the background is transparent
  int bits = 8;
  double fps = 25;
  std::string object_legend;  ///< For id images: JSON list of the objects
};

/// Opens a sink for a color image. "x.png": 8 or 16 bits, straight alpha. "x.exr": linear light, premultiplied, 32-bit floats. "x.mp4",
/// ".webm", ".gif": video. /dev/...: PNG.
Result<std::unique_ptr<ImageSink>> open_image_sink(const std::string& path, const ImageFormat& shape);
/// Opens a sink for a depth image (.exr) with one channel Z: distance along the view axis in world units; infinite where nothing opaque is
/// visible.
Result<std::unique_ptr<ImageSink>> open_depth_sink(const std::string& path, const ImageFormat& shape);
/// Opens a sink for a 16-bit gray image (.png) of the id of the opaque object in each pixel, 0 for none; the object legend is the text
/// chunk "Objects".
Result<std::unique_ptr<ImageSink>> open_id_sink(const std::string& path, const ImageFormat& shape);

}  // namespace catena::app
