/// A display (sRGB) colour, as it is written into the picture.
#pragma once

namespace catena::render {

struct Color {
  float r = 0, g = 0, b = 0;
  bool operator==(const Color&) const = default;
};

}  // namespace catena::render
