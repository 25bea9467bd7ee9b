// SPDX-License-Identifier: MIT
// Components written by their descriptions read back as equal components.
#include "engine/scene/to_json.h"
#include "tests/engine/scene/scene_fixture.h"

namespace components_test {

using namespace catena;
using namespace catena::scene;

constexpr const char* kHead = R"({"fields": {"s": {"analytic": "sphere"}, "v": {"analytic": "circle"}},
 "widgets": [{"name": "iso", "type": "isolevel", "field": "s", "position": [0, 0, 1]},
             {"name": "rake", "type": "rake", "from": [0, 0, 0], "to": [1, 0, 0]},
             {"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 1, 0]}],
)";

/// Each item of a list reads as the component T, whose description equals it.
template <class T>
void comes_back(const std::string& key, std::initializer_list<const char*> items) {
  for (const std::string item : items) {
    const Scene scene = parsed(kHead + ("\"" + key + "\": [" + item + "]}"));
    EXPECT_EQ(to_json(scene, only<T>(scene)), item);
  }
}

TEST(Components, WrittenComponentsReadBack) {
  comes_back<Volume>("volumes",
                     {R"({"field": "s"})", R"({"field": "s", "color": "magma", "range": [0, 2], "shade": true, "clip": false})",
                      R"({"field": "s", "color": [[0, 1, 0.5, 0], [1, 0, 0, 0]], "opacity": [[0, 0], [1, 0.5]], "opacity_unit": 0.25})",
                      R"({"field": "s", "extinction": [[0, 2]], "projection": "maximum"})"});
  comes_back<Isosurface>("isosurfaces", {R"({"field": "s", "level": 1, "color": [1, 0.25, 0], "opacity": 0.5})",
                                         R"({"field": "s", "level": {"widget": "iso"}, "color_by": {"field": "v", "color": "grey"}})"});
  comes_back<Slice>(
      "slices",
      {R"({"field": "v", "axis": "y", "at": 0.5, "color": "viridis", "opacity": 0.25, "contours": {"spacing": 0.1}, "shade": true})",
       R"({"field": "s", "point": [0, 1, 2], "normal": [1, 1, 0], "contours": {"levels": [0.5, 1], "width": 2}})",
       R"({"field": "s", "widget": "cut"})"});
  comes_back<StreamlineSet>(
      "streamlines",
      {R"({"field": "v", "seeds": [[1, 0, 0]], "radius": 0.1, "color": [1, 0.3, 0.2], "kind": "line"})",
       R"({"field": "v", "seeds": {"widget": "rake", "count": 5}, "color_by": {"quantity": "speed"}})",
       R"({"field": "v", "seeds": {"plane": {"origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "count": [2, 3]}}, "color": [1, 0.3, 0.2]})",
       R"({"field": "v", "seeds": {"evenly_spaced": {"distance": 0.5, "count": 20000}}, "color": [0, 1, 0], "arrows": 2})"});
}

TEST(Components, TheSchemaKeyIsAString) {
  EXPECT_TRUE(parse_scene(R"({"$schema": "scene.schema.json"})", "s.json"));
  EXPECT_FALSE(parse_scene(R"({"$schema": 3})", "s.json"));
}

TEST(Components, ColorByHasEitherAFieldOrAQuantity) {
  const std::string seeds = R"("streamlines": [{"field": "v", "seeds": [[1, 0, 0]], )";
  expect_error(parse_scene(std::string(kHead) + seeds + R"("color_by": {"quantity": "speed", "field": "s"}}]})", "s.json"),
               "s.json:", {"exactly one of them was expected"});
}

}  // namespace components_test
