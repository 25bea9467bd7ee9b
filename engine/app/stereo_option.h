/// "--stereo MODE", "--eye-separation S" and "--zero-parallax F": over what the scene says.
#pragma once
#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>
#include <string>

#include "engine/base/result.h"
#include "engine/scene/stereo.h"

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

inline void add_stereo_options(CLI::App& command, StereoChoice& choice) {
  command.add_option("--stereo", choice.mode,
                     scene::stereo_words() + " (default: the scene's); each eye has the size of --size, *-half squeezes all into it");
  command.add_option("--eye-separation", choice.separation,
                     "between the eyes, world units (default: the scene's, or a 30th of --zero-parallax)");
  command.add_option("--zero-parallax", choice.zero_parallax,
                     "distance from the eyes to where both see the same, world units (default: the scene's, or the camera's target)");
}

}  // namespace catena::app
