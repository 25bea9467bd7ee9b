#include "engine/scene/stereo.h"

#include <array>

#include "engine/base/numbers.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

constexpr std::array<std::string_view, kStereoModes> kWords{
    "mono",     "left",          "right",          "side-by-side",      "side-by-side-half", "cross-eyed", "top-bottom", "top-bottom-half",
    "anaglyph", "anaglyph-grey", "row-interlaced", "column-interlaced", "checkerboard"};

}  // namespace

std::string_view stereo_word(StereoMode mode) { return kWords[static_cast<std::size_t>(mode)]; }

std::optional<StereoMode> stereo_mode(std::string_view word) {
  for (std::size_t i = 0; i < kWords.size(); ++i)
    if (kWords[i] == word) return static_cast<StereoMode>(i);
  return std::nullopt;
}

std::string stereo_words() {
  std::string text;
  for (std::size_t i = 0; i < kWords.size(); ++i)
    text += std::string(i == 0 ? "" : i + 1 == kWords.size() ? " or " : ", ") + std::string(kWords[i]);
  return text;
}

bool needs_a_pair(StereoMode mode) {
  return mode == StereoMode::left || mode == StereoMode::right || mode == StereoMode::cross_eyed || mode == StereoMode::anaglyph ||
         mode == StereoMode::anaglyph_grey;
}

Outcome read_stereo(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "stereo"));
  CATENA_CHECK(json::only_keys(node, {"mode", "separation", "zero_parallax", "views", "swap"}));
  Stereo& stereo = scene.stereo;
  CATENA_TRY(const std::string word, json::get_string(node, "mode", std::string(stereo_word(stereo.mode))));
  const auto mode = stereo_mode(word);
  if (!mode) return json::error_at(*node.find("mode"), "\"mode\" is not known; " + stereo_words() + " was expected");
  stereo.mode = *mode;
  CATENA_TRY(stereo.separation, json::get_optional_number(node, "separation", json::Range::not_negative));
  if (stereo.separation > kMostStereoSeparation)
    return json::error_at(*node.find("separation"), "\"separation\" is " + to_text(*stereo.separation) + "; at most " +
                                                        to_text(kMostStereoSeparation) + " world units were expected");
  CATENA_TRY(stereo.zero_parallax, json::get_optional_number(node, "zero_parallax", json::Range::positive));
  CATENA_TRY(stereo.views, json::get_integer(node, "views", 2, 2, kMostStereoViews));
  if (stereo.views != 2 && needs_a_pair(stereo.mode))
    return json::error_at(*node.find("views"),
                          "\"views\" is " + std::to_string(stereo.views) + " with mode \"" + word + "\"; 2 was expected");
  CATENA_TRY(stereo.swap, json::get_boolean(node, "swap", false));
  return Done{};
}

}  // namespace catena::scene
