// SPDX-License-Identifier: MIT
/// Conversion between the display (sRGB, IEC 61966-2-1) encoding of colors and linear radiance, in which light is added. 1 is white in
/// both.
#pragma once
#include <cmath>

#include "engine/base/color.h"

namespace catena::render {

/// Returns the linear value of an encoded component.
inline double to_linear(double encoded) { return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4); }
/// Returns the encoded value of a linear component; larger than 1 where it is brighter than white.
inline double to_display(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

/// Returns the linear color of an encoded one.
inline Color to_linear(const Color& c) {
  return {float(to_linear(double(c.r))), float(to_linear(double(c.g))), float(to_linear(double(c.b)))};
}

}  // namespace catena::render
