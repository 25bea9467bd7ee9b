/// "--stereo MODE", "--eye-separation S" and "--zero-parallax F": over what the scene says.
#pragma once
#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>
#include <string>

#include "engine/app/size_option.h"
#include "engine/base/result.h"
#include "engine/scene/stereo.h"
#include "render/extract/extract_stereo.h"

namespace catena::app {

struct StereoChoice {
  std::string mode;
  std::optional<double> separation, zero_parallax;

  Outcome apply(scene::Stereo& stereo) const {
    if (!mode.empty()) {
      const auto known = scene::stereo_mode(mode);
      if (!known) return Error{"--stereo " + mode + ": expected " + scene::stereo_words()};
      stereo.mode = *known;
    }
    if (separation) {
      if (!(*separation >= 0) || !std::isfinite(*separation))
        return Error{"--eye-separation: expected a finite number of at least 0, world units"};
      stereo.separation = separation;
    }
    if (zero_parallax) {
      if (!(*zero_parallax > 0) || !std::isfinite(*zero_parallax))
        return Error{"--zero-parallax: expected a finite number above 0, world units"};
      stereo.zero_parallax = zero_parallax;
    }
    return Done{};
  }
};

/// Several pictures in one may be more than a picture can hold.
inline Outcome check_packed(const scene::Stereo& stereo, const Size& size) {
  const auto packed = render::packed_size(render::packing_of(stereo), render::views_of(stereo), size.width, size.height);
  if (packed.width >= 1 && packed.height >= 1 && packed.width <= kMaxPixels && packed.height <= kMaxPixels) return Done{};
  return Error{"--size " + std::to_string(size.width) + "x" + std::to_string(size.height) + ": with " +
               std::to_string(render::views_of(stereo)) + " views " + std::string(scene::stereo_word(stereo.mode)) + " the picture has " +
               std::to_string(packed.width) + "x" + std::to_string(packed.height) + " pixels, expected 1 to " + std::to_string(kMaxPixels) +
               " each way"};
}

inline void add_stereo_options(CLI::App& command, StereoChoice& choice) {
  command.add_option("--stereo", choice.mode,
                     scene::stereo_words() + " (default: the scene's); each eye has the size of --size, *-half squeezes all into it");
  command.add_option("--eye-separation", choice.separation,
                     "between the eyes, world units (default: the scene's, or a 30th of --zero-parallax)");
  command.add_option("--zero-parallax", choice.zero_parallax,
                     "distance from the eyes to where both see the same, world units (default: the scene's, or the camera's target)");
}

}  // namespace catena::app
