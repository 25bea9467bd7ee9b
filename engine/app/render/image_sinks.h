/// Where the pixels of a picture go: one sink a file, fed with bands of rows from the top, complete or not there at all.
#pragma once
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "render/quality/tiled_render.h"

namespace catena::app {

class ImageSink {
 public:
  virtual ~ImageSink() = default;  ///< without commit() nothing stays
  virtual Outcome write(const render::Band& band) = 0;
  /// After the last band: all of it is on its way to the disk.
  virtual Outcome finish() = 0;
  /// The rename to the final name.
  virtual Outcome commit() = 0;
};

struct ImageFormat {
  std::uint32_t width = 0, height = 0;
  bool alpha = false;  ///< the background is transparent
  int bits = 8;
  double fps = 25;
  std::string object_legend;  ///< of ids: JSON
};

/// "x.png": 8 or 16 bits, straight alpha. "x.exr": linear light, premultiplied, 32-bit floats. "x.mp4", ".webm", ".gif": video.
/// /dev/...: PNG.
Result<std::unique_ptr<ImageSink>> open_image_sink(const std::string& path, const ImageFormat& shape);
/// One channel Z: distance along the view axis in world units; infinite where nothing opaque is seen.
Result<std::unique_ptr<ImageSink>> open_depth_sink(const std::string& path, const ImageFormat& shape);
/// 16-bit grey: the id of the opaque object in each pixel, 0 for none; the legend is the text chunk "Objects".
Result<std::unique_ptr<ImageSink>> open_id_sink(const std::string& path, const ImageFormat& shape);

}  // namespace catena::app
