// SPDX-License-Identifier: MIT
#include "engine/scene/label_palette.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/vec.h"
#include "engine/scene/color_maps.h"

namespace catena::scene {
namespace {

constexpr int kLevels = 14;                                                      // candidates per RGB component
constexpr double kDarkest = 45, kLightest = 88, kGreyest = 20, kBrightest = 90;  // limits of CIELAB lightness and chroma
constexpr double kLightness = 0.5;                                               // weight of the lightness in distances
constexpr Color kFirst{0.88f, 0.38f, 0.30f};

struct Candidate {
  Color color;
  Vec3 place;                                             ///< CIELAB, lightness weighted
  double away = std::numeric_limits<double>::infinity();  ///< squared distance to the nearest chosen color
};

std::vector<Color> choose() {
  std::vector<Candidate> all;
  const auto add = [&](const Color& color) {
    const Vec3 lab = lab_from_srgb({color.r, color.g, color.b});
    const double chroma = std::hypot(lab.y, lab.z);
    if (lab.x >= kDarkest && lab.x <= kLightest && chroma >= kGreyest && chroma <= kBrightest)
      all.push_back({color, {kLightness * lab.x, lab.y, lab.z}});
  };
  add(kFirst);
  const auto level = [](int k) { return static_cast<float>(k) / (kLevels - 1); };
  for (int r = 0; r < kLevels; ++r)
    for (int g = 0; g < kLevels; ++g)
      for (int b = 0; b < kLevels; ++b) add({level(r), level(g), level(b)});
  std::vector<Color> colors;
  std::size_t next = 0;
  while (colors.size() < kPaletteColors) {
    const Candidate best = all[next];
    colors.push_back(best.color);
    for (Candidate& one : all) {
      const Vec3 d = one.place - best.place;
      one.away = std::min(one.away, dot(d, d));
    }
    next = static_cast<std::size_t>(std::ranges::max_element(all, {}, &Candidate::away) - all.begin());
  }
  return colors;
}

}  // namespace

Color palette_color(std::size_t index) {
  static const std::vector<Color> palette = choose();
  return palette[index % palette.size()];
}

}  // namespace catena::scene
