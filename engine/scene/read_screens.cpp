// SPDX-License-Identifier: MIT
/// Reads "screens": flat displays for which images are rendered, defined by their corners.
#include <algorithm>

#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

const Table<DisplayScreen>& screen_table() {
  static const auto table = [] {
    Table<DisplayScreen> t;
    t.bind(schema::text("name", "Unique name of the screen, for the option `--screen`.").required(), &DisplayScreen::name);
    t.bind(schema::vec3("lower_left", "world", "Lower left corner of the screen, as seen by a viewer in front of it.")
               .with_range_text("to 1e15")
               .required(),
           &DisplayScreen::lower_left);
    t.bind(schema::vec3("lower_right", "world", "Lower right corner of the screen, as seen by a viewer in front of it.")
               .with_range_text("to 1e15")
               .required(),
           &DisplayScreen::lower_right);
    t.bind(schema::vec3("upper_left", "world",
                        "Upper left corner of the screen, as seen by a viewer in front of it; the corners must span a rectangle.")
               .with_range_text("to 1e15")
               .required(),
           &DisplayScreen::upper_left);
    t.check([](Scene& scene, const json::Node& node, DisplayScreen& screen) -> Outcome {
      const Vec3 right = screen.lower_right - screen.lower_left, up = screen.upper_left - screen.lower_left;
      constexpr double kSquare = 1e-6;  // maximum cosine of the angle between the edges
      if (!(norm(right) > 0 && norm(up) > 0) || !(std::fabs(dot(direction(right), direction(up))) <= kSquare))
        return json::error_at(node, "the corners of screen " + in_quotes(screen.name) +
                                        " do not span a rectangle; lower left, lower right and upper left of one were expected");
      const auto& all = scene.stereo.screens;
      if (std::any_of(all.begin(), all.end(), [&](const DisplayScreen& other) { return other.name == screen.name; }))
        return json::error_at(*node.find("name"), "a second screen is called " + in_quotes(screen.name) + "; a unique name was expected");
      return Done{};
    });
    return t;
  }();
  return table;
}

}  // namespace

Part screens_part() {
  return {make_list_component("screens", "Flat displays for which images can be rendered.", screen_table(), static_cast<int>(kMaxScreens)),
          [](Scene& scene, const json::Node& node) {
            return each_item(node, [&](const json::Node& item) -> Outcome {
              if (scene.stereo.screens.size() == kMaxScreens)
                return json::error_at(item,
                                      "there are more than " + std::to_string(kMaxScreens) + " screens; that many at most were expected");
              DisplayScreen screen;
              CATENA_CHECK(screen_table().read(scene, item, screen));
              scene.stereo.screens.push_back(std::move(screen));
              return Done{};
            });
          }};
}

}  // namespace catena::scene
