/// A display (sRGB) colour, components from 0 to 1, as scenes write it and as it stands in the picture.
#pragma once

namespace catena {

/// Red, green and blue as they stand in a picture file, 0 to 1.
struct Color {
  float r = 0, g = 0, b = 0;  ///< 0 to 1
  bool operator==(const Color&) const = default;
};

}  // namespace catena
