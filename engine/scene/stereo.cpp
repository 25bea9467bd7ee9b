// SPDX-License-Identifier: MIT
#include "engine/scene/stereo.h"

#include <array>

#include "engine/base/numbers.h"
#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

constexpr std::array<std::string_view, kStereoModeCount> kStereoWords{
    "mono",     "left",          "right",          "side-by-side",      "side-by-side-half", "cross-eyed", "top-bottom", "top-bottom-half",
    "anaglyph", "anaglyph-grey", "row-interlaced", "column-interlaced", "checkerboard"};

}  // namespace

std::string_view to_string(StereoMode mode) { return kStereoWords[static_cast<std::size_t>(mode)]; }

std::optional<StereoMode> parse_stereo_mode(std::string_view word) {
  for (std::size_t i = 0; i < kStereoWords.size(); ++i)
    if (kStereoWords[i] == word) return static_cast<StereoMode>(i);
  return std::nullopt;
}

std::string stereo_mode_names() {
  std::string text;
  for (std::size_t i = 0; i < kStereoWords.size(); ++i)
    text += std::string(i == 0 ? "" : i + 1 == kStereoWords.size() ? " or " : ", ") + std::string(kStereoWords[i]);
  return text;
}

bool needs_two_views(StereoMode mode) {
  return mode == StereoMode::left || mode == StereoMode::right || mode == StereoMode::cross_eyed || mode == StereoMode::anaglyph ||
         mode == StereoMode::anaglyph_gray;
}

namespace {

const Table<Stereo>& stereo_table() {
  static const auto table = [] {
    Table<Stereo> t;
    const Key mode = schema::choice("mode", {kStereoWords.begin(), kStereoWords.end()}, "Composition of the eyes' images.");
    t.custom(mode.with_default("\"mono\""), [](Scene&, const json::Node& node, Stereo& stereo) -> Outcome {
      CATENA_TRY(const std::string word, json::get_string(node, "mode", std::string(to_string(stereo.mode))));
      const auto named = parse_stereo_mode(word);
      if (!named) return json::error_at(*node.find("mode"), "\"mode\" is not known; " + stereo_mode_names() + " was expected");
      stereo.mode = *named;
      return Done{};
    });
    t.bind(schema::number("separation", "world", "Distance between neighbouring eyes.")
               .within(0, kMaxStereoSeparation)
               .with_default("1/30 of `zero_parallax`"),
           &Stereo::separation);
    t.bind(schema::number("zero_parallax", "world", "Distance from the eyes at which their images coincide.")
               .positive()
               .with_default("the distance of the camera's target"),
           &Stereo::zero_parallax);
    t.bind(schema::integer("views", "", "Number of views; a number other than 2 only for modes that accept any number of views.", 2,
                           kMaxStereoViews),
           &Stereo::view_count);
    t.bind(schema::boolean("swap_eyes", "Exchange of the images of the left and the right eye."), &Stereo::swap_eyes);
    t.check([](Scene&, const json::Node& node, Stereo& stereo) -> Outcome {
      if (stereo.view_count == 2 || !needs_two_views(stereo.mode)) return Done{};
      return json::error_at(*node.find("views"), "\"views\" is " + std::to_string(stereo.view_count) + " with mode \"" +
                                                     std::string(to_string(stereo.mode)) + "\"; 2 was expected");
    });
    return t;
  }();
  return table;
}

}  // namespace

Part stereo_part() {
  return {{"stereo", "Stereo: images for two or more eyes.", schema::Section::Layout::object, stereo_table().keys()},
          [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_CHECK(json::expect_object(node, "stereo"));
            return stereo_table().read(scene, node, scene.stereo);
          }};
}

}  // namespace catena::scene
