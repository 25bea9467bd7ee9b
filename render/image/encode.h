// SPDX-License-Identifier: MIT
/// Image compression in memory, for transmission: without alpha, as composited over the background. Any thread.
///   JPEG  2 ms and 0.15 MB per million pixels: for moving images (quality 1 to 100, 85 cannot be distinguished from the original in
///         motion)
///   PNG   20 ms and 0.4 MB: lossless
/// An Error if there is no memory.
#pragma once
#include <string>

#include "engine/base/result.h"
#include "render/image/image.h"

namespace catena::render {

/// Encodes a JPEG; `quality` 1 to 100.
Result<std::string> encode_jpeg(const Image8& image, int quality);
/// Encodes a PNG.
Result<std::string> encode_png(const Image8& image);

}  // namespace catena::render
