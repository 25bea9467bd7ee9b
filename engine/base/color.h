// SPDX-License-Identifier: MIT
/// Color in the display (sRGB) encoding, components from 0 to 1: the form used in scene files and in image files.
#pragma once

namespace catena {

/// Red, green and blue of an sRGB color, as stored in an image file.
struct Color {
  float r = 0, g = 0, b = 0;  ///< 0 to 1
  bool operator==(const Color&) const = default;
};

}  // namespace catena
