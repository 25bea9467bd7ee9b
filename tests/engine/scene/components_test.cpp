// SPDX-License-Identifier: MIT
// Components written by their descriptions read back as equal components.
#include <gtest/gtest.h>

#include "engine/scene/scene.h"
#include "engine/scene/to_json.h"

namespace components_test {

using namespace catena;
using namespace catena::scene;

constexpr const char* kHead = R"({"fields": {"s": {"analytic": "sphere"}, "v": {"analytic": "circle"}},
 "widgets": [{"name": "iso", "type": "isolevel", "field": "s", "position": [0, 0, 1]},
             {"name": "rake", "type": "rake", "from": [0, 0, 0], "to": [1, 0, 0]},
             {"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 1, 0]}],
)";

Scene scene_of(const std::string& part) {
  auto scene = parse_scene(kHead + part + "}", "s.json");
  EXPECT_TRUE(scene) << scene.error().message << "\n" << part;
  return scene ? std::move(*scene) : Scene();
}

/// The first T of the scene, written by its description.
template <class T>
std::string written(const Scene& scene) {
  std::string text;
  scene.entities.each<T>([&](Entity, const T& item) {
    if (text.empty()) text = to_json(scene, item);
  });
  return text;
}

template <class T>
void comes_back(const std::string& key, const std::string& item) {
  EXPECT_EQ(written<T>(scene_of("\"" + key + "\": [" + item + "]")), item);
  const std::string again = written<T>(scene_of("\"" + key + "\": [" + written<T>(scene_of("\"" + key + "\": [" + item + "]")) + "]"));
  EXPECT_EQ(again, item);
}

TEST(Components, WrittenComponentsReadBack) {
  comes_back<Volume>("volumes", R"({"field": "s"})");
  comes_back<Volume>("volumes", R"({"field": "s", "color": "magma", "range": [0, 2], "shade": true, "clip": false})");
  comes_back<Volume>("volumes",
                     R"({"field": "s", "color": [[0, 1, 0.5, 0], [1, 0, 0, 0]], "opacity": [[0, 0], [1, 0.5]], "opacity_unit": 0.25})");
  comes_back<Volume>("volumes", R"({"field": "s", "extinction": [[0, 2]], "projection": "maximum"})");
  comes_back<Isosurface>("isosurfaces", R"({"field": "s", "level": 1, "color": [1, 0.25, 0], "opacity": 0.5})");
  comes_back<Isosurface>("isosurfaces", R"({"field": "s", "level": {"widget": "iso"}, "color_by": {"field": "v", "color": "grey"}})");
  comes_back<Slice>(
      "slices",
      R"({"field": "v", "axis": "y", "at": 0.5, "color": "viridis", "opacity": 0.25, "contours": {"spacing": 0.1}, "shade": true})");
  comes_back<Slice>("slices", R"({"field": "s", "point": [0, 1, 2], "normal": [1, 1, 0], "contours": {"levels": [0.5, 1], "width": 2}})");
  comes_back<Slice>("slices", R"({"field": "s", "widget": "cut"})");
  comes_back<StreamlineSet>("streamlines",
                            R"({"field": "v", "seeds": [[1, 0, 0]], "radius": 0.1, "color": [1, 0.3, 0.2], "kind": "line"})");
  comes_back<StreamlineSet>("streamlines", R"({"field": "v", "seeds": {"widget": "rake", "count": 5}, "color_by": {"quantity": "speed"}})");
  comes_back<StreamlineSet>(
      "streamlines",
      R"({"field": "v", "seeds": {"plane": {"origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "count": [2, 3]}}, "color": [1, 0.3, 0.2]})");
  comes_back<StreamlineSet>(
      "streamlines", R"({"field": "v", "seeds": {"evenly_spaced": {"distance": 0.5, "count": 20000}}, "color": [0, 1, 0], "arrows": 2})");
}

TEST(Components, TheSchemaKeyIsAString) {
  EXPECT_TRUE(parse_scene(R"({"$schema": "scene.schema.json"})", "s.json"));
  EXPECT_FALSE(parse_scene(R"({"$schema": 3})", "s.json"));
}

TEST(Components, ColorByHasEitherAFieldOrAQuantity) {
  const std::string seeds = R"("streamlines": [{"field": "v", "seeds": [[1, 0, 0]], )";
  const auto both = parse_scene(std::string(kHead) + seeds + R"("color_by": {"quantity": "speed", "field": "s"}}]})", "s.json");
  ASSERT_FALSE(both);
  EXPECT_NE(both.error().message.find("exactly one of them was expected"), std::string::npos) << both.error().message;
}

}  // namespace components_test
