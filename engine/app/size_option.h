/// "--size WxH".
#pragma once
#include <cstdint>
#include <string>

#include "engine/base/numbers.h"
#include "engine/base/result.h"

namespace catena::app {

inline constexpr std::uint32_t kMaxPixels = 16384;  ///< each way, of a picture drawn in one piece

struct Size {
  std::uint32_t width = 1024, height = 768;
};

/// `most`: pixels each way.
inline Result<Size> parse_size(const std::string& text, int most = kMaxPixels) {
  const auto x = text.find('x');
  if (x != std::string::npos) {
    const auto width = parse_integer(text.substr(0, x)), height = parse_integer(text.substr(x + 1));
    if (width && height && *width >= 1 && *height >= 1 && *width <= most && *height <= most)
      return Size{static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height)};
  }
  return Error{"--size " + text + ": expected WIDTHxHEIGHT, each 1 to " + std::to_string(most) + ", such as 1024x768"};
}

}  // namespace catena::app
