// SPDX-License-Identifier: MIT
// "glyphs" of the scene file: every key, writing and reading back, and errors with their line.
#include "engine/scene/to_json.h"
#include "engine/scene/visibility.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::glyphs_test {

constexpr const char* kFile =
    "solid m\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid m\n";

class Glyphs : public InFolder {
 protected:
  Result<Scene> parse(const std::string& glyphs, const std::string& more = "") {
    test::write_file(folder_ / "m.stl", kFile);
    return parse_scene(R"({"fields": {"s": {"analytic": "sphere"}, "v": {"analytic": "circle"}},
      "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 1], "normal": [0, 2, 0]},
                  {"name": "seed", "type": "seed", "position": [1, 0, 0]}],
      "slices": [{"field": "s", "axis": "x", "at": 1}, {"field": "s", "axis": "x", "at": 0}],
      "isosurfaces": [{"field": "s", "level": 1}], "meshes": [{"name": "m", "file": "m.stl", "visible": false}],)"
                       "\n\"glyphs\": " +
                           glyphs + more + "}",
                       folder_ / "s.json");
  }
};

TEST_F(Glyphs, EveryKeyIsRead) {
  const Scene scene =
      value_of(parse(R"([{"field": "v", "on": {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}}, "spacing": 0.25, "scale": "constant",
      "length": 0.5, "reference_speed": 2, "min_speed": 0.1, "radius": 0.02, "anchor": "tail", "color": [1, 0, 0], "clip": false, "visible": false},
     {"field": "v", "on": {"slice": 1}, "kind": "line", "color_by": {"quantity": "speed", "color": "magma", "range": [0, 2]}},
     {"field": "v", "on": {"plane": {"widget": "cut"}}, "color_by": {"field": "s"}}, {"field": "v", "on": {"isosurface": 0}, "anchor": "head"},
     {"field": "v", "on": {"mesh": "m"}}, {"field": "v"}])"));
  const std::vector<GlyphSet> sets = all_of<GlyphSet>(scene);
  ASSERT_EQ(sets.size(), 6u);
  EXPECT_EQ(sets[0].support, GlyphSet::Support::box);
  EXPECT_EQ(sets[0].box->hi, Vec3(1, 2, 3));
  EXPECT_TRUE(sets[0].constant_length);
  EXPECT_EQ(std::tuple(sets[0].spacing, sets[0].length, sets[0].reference_speed, sets[0].min_speed, sets[0].radius),
            std::tuple(0.25, 0.5, 2, 0.1, 0.02));
  EXPECT_EQ(sets[0].anchor, GlyphSet::Anchor::tail);
  EXPECT_EQ(sets[0].color.g, 0);
  EXPECT_FALSE(sets[0].clipped);
  EXPECT_TRUE(is_hidden(scene.entities, entities_of<GlyphSet>(scene).at(0)));
  EXPECT_EQ(sets[1].support, GlyphSet::Support::slice);
  EXPECT_EQ(scene.entities.get<Slice>(sets[1].support_entity).point.x, 0);
  EXPECT_TRUE(sets[1].is_line_field);
  EXPECT_EQ(sets[1].color_by->source, ColorBy::Source::speed);
  EXPECT_EQ(sets[2].support, GlyphSet::Support::plane);
  EXPECT_EQ(sets[2].point, Vec3(0, 0, 1));
  EXPECT_NEAR(sets[2].normal.y, 1, 1e-12);
  EXPECT_EQ(sets[2].color_by->source, ColorBy::Source::field);
  EXPECT_EQ(sets[3].support, GlyphSet::Support::isosurface);
  EXPECT_EQ(sets[3].anchor, GlyphSet::Anchor::head);
  EXPECT_EQ(sets[4].support_entity, find_mesh(scene, "m")) << "felt, not drawn";
  // The defaults: in the domain, scaled by magnitude, centered, clipped.
  EXPECT_EQ(sets[5].support, GlyphSet::Support::box);
  EXPECT_FALSE(sets[5].box || sets[5].constant_length || sets[5].color_by);
  EXPECT_EQ(sets[5].spacing, 0);
  EXPECT_EQ(sets[5].anchor, GlyphSet::Anchor::center);
  EXPECT_TRUE(sets[5].clipped);
}

TEST_F(Glyphs, WrittenGlyphsReadBack) {
  for (
      const std::string item :
      {R"({"field": "v"})", R"({"field": "v", "on": {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}}, "spacing": 0.25, "scale": "constant"})",
       R"({"field": "v", "on": {"plane": {"axis": "y", "at": 0.5}}, "length": 2, "reference_speed": 3, "min_speed": 0.5, "radius": 0.1})",
       R"({"field": "v", "on": {"plane": {"point": [1, 2, 3], "normal": [0, 1, 1]}}, "anchor": "head", "color": [1, 0, 0], "clip": false})",
       R"({"field": "v", "on": {"plane": {"widget": "cut"}}, "kind": "line"})",
       R"({"field": "v", "on": {"slice": 1}, "color_by": {"quantity": "speed", "color": "magma"}})",
       R"({"field": "v", "on": {"isosurface": 0}, "color_by": {"field": "s"}})", R"({"field": "v", "on": {"mesh": "m"}})"}) {
    const Scene scene = value_of(parse("[" + item + "]"));
    EXPECT_EQ(to_json(scene, only<GlyphSet>(scene)), item);
  }
}

TEST_F(Glyphs, ErrorsNameTheLine) {
  for (const auto& [text, expected] :
       {std::pair{R"({})", "an array of objects was expected"},
        {R"([{}])", "\"field\" is missing"},
        {R"([{"field": "t"}])", "unknown field"},
        {R"([{"field": "v", "on": "slice"}])", "an object {...} was expected"},
        {R"([{"field": "v", "on": {}}])", "names 0 things; one of box, plane, slice, isosurface, mesh was expected"},
        {R"([{"field": "v", "on": {"slice": 0, "mesh": "m"}}])", "names 2 things"},
        {R"([{"field": "v", "on": {"surface": 0}}])", "surface"},
        {R"([{"field": "v", "on": {"slice": 2}}])", "from 0 to 1"},
        {R"([{"field": "v", "on": {"slice": {"axis": "x", "at": 0}}}])", "slice"},
        {R"([{"field": "v", "on": {"isosurface": -1}}])", "isosurface"},
        {R"([{"field": "v", "on": {"mesh": "n"}}])", "unknown mesh \"n\"; known: m"},
        {R"([{"field": "v", "on": {"box": {"min": [0, 0, 0]}}}])", "max"},
        {R"([{"field": "v", "on": {"box": {"min": [0, 0, 0], "max": [1, -1, 1]}}}])", "\"max\" lies below \"min\""},
        {R"([{"field": "v", "on": {"plane": {}}}])", "a set of glyphs has no plane"},
        {R"([{"field": "v", "on": {"plane": {"axis": "x", "at": 0, "normal": [1, 0, 0]}}}])", "has both an axis and a point or normal"},
        {R"([{"field": "v", "on": {"plane": {"axis": "x", "at": 0, "offset": 1}}}])", "offset"},
        {R"([{"field": "v", "on": {"plane": {"widget": "seed"}}}])", "a cutting plane was expected"},
        {R"([{"field": "v", "spacing": 0}])", "spacing"},
        {R"([{"field": "v", "length": -1}])", "length"},
        {R"([{"field": "v", "scale": "speed"}])", "magnitude"},
        {R"([{"field": "v", "anchor": "middle"}])", "center"},
        {R"([{"field": "v", "anchor": "tail", "kind": "line"}])", "neither head nor tail"},
        {R"([{"field": "v", "color_by": {"quantity": "arc_length"}}])", "speed"},
        {R"([{"field": "v", "color_by": {}}])", "neither"},
        {R"([{"field": "v", "color_by": "speed"}])", "object"},
        {R"([{"field": "v", "colour": [1, 0, 0]}])", "color"}})
    expect_error(parse(text), folder_ / "s.json:6: ", {expected});
  expect_error(parse_scene(R"({"fields": {"v": {"analytic": "circle"}}, "glyphs": [{"field": "v", "on": {"slice": 0}}]})", "s.json"),
               "s.json:1: ", {"the scene has no slices; one was expected for glyphs"});
}

TEST_F(Glyphs, AScalarBarRefersToGlyphs) {
  const std::string sets = R"([{"field": "v", "color_by": {"quantity": "speed"}}, {"field": "v"}])";
  const Scene scene = value_of(parse(sets, R"(, "scalar_bars": [{"glyphs": 0}, {"field": "v"}])"));
  ASSERT_EQ(scene.annotations.scalar_bars.size(), 2u);
  for (const ScalarBar& bar : scene.annotations.scalar_bars) EXPECT_TRUE(scene.entities.has<GlyphSet>(bar.target));
  expect_error(parse(sets, R"(, "scalar_bars": [{"glyphs": 1}])"), folder_ / "s.json:", {"this set of glyphs shows no values"});
}

}  // namespace catena::scene::glyphs_test
