// SPDX-License-Identifier: MIT
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::slices_test {

Result<Scene> parse(const std::string& slices) {
  return parse_scene("{\"fields\": {\"s\": {\"analytic\": \"sphere\"}},\n\"slices\": " + slices + "}", "s.json");
}

TEST(SceneSlices, EveryKeyIsRead) {
  const std::vector<Slice> slices = all_of<Slice>(value_of(parse(
      R"([{"field": "s", "point": [1, 2, 3], "normal": [0, 1, -2], "color": "inferno", "range": [0.5, 2], "opacity": 0.25,
    "contours": {"levels": [0.5, 1, 1.5], "color": [1, 0, 0], "width": 2.5}, "shade": true, "clip": false},
    {"field": "s", "axis": "y", "at": -0.5, "color": [[0, 1, 0, 0], [1, 0, 0, 1]], "contours": {"count": 7}},
    {"field": "s", "axis": "z", "at": 0, "contours": {"spacing": 0.2}}])")));
  ASSERT_EQ(slices.size(), 3u);
  EXPECT_EQ(slices[0].point, Vec3(1, 2, 3));
  EXPECT_EQ(slices[0].normal, Vec3(0, 1, -2));
  EXPECT_EQ(slices[0].color_by.named.map, "inferno");
  EXPECT_EQ(std::pair(slices[0].color_by.named.range->at(1), slices[0].opacity), std::pair(2.0, 0.25));
  EXPECT_TRUE(slices[0].lit);
  EXPECT_FALSE(slices[0].clipped);
  EXPECT_EQ(slices[0].contours->levels, (std::vector<double>{0.5, 1, 1.5}));
  EXPECT_EQ(std::tuple(slices[0].contours->color.r, slices[0].contours->width), std::tuple(1, 2.5));
  EXPECT_EQ(slices[1].point, Vec3(0, -0.5, 0));
  EXPECT_EQ(slices[1].normal, Vec3(0, 1, 0));
  EXPECT_EQ(slices[1].color_by.colors.size(), 2u);
  EXPECT_EQ(slices[1].contours->count, 7);
  // The defaults: opaque, unlit, clipped, contours of one pixel.
  EXPECT_EQ(slices[2].opacity, 1);
  EXPECT_FALSE(slices[2].lit);
  EXPECT_TRUE(slices[2].clipped);
  EXPECT_EQ(slices[2].contours->spacing, 0.2);
  EXPECT_EQ(slices[2].contours->width, 1);
}

TEST(SceneSlices, ErrorsNameTheLine) {
  for (const auto& [text, expected] :
       {std::pair{R"({})", "an array of objects was expected"},
        {R"([{"field": "t", "axis": "x", "at": 0}])", "unknown field"},
        {R"([{"field": "s"}])", "\"axis\" with \"at\", or \"point\" with \"normal\", was expected"},
        {R"([{"field": "s", "at": 1}])", "without \"axis\""},
        {R"([{"field": "s", "axis": "w", "at": 1}])", "axis"},
        {R"([{"field": "s", "axis": "x"}])", "at"},
        {R"([{"field": "s", "axis": "x", "at": 1, "normal": [0, 0, 1]}])", "both an axis and a point or normal"},
        {R"([{"field": "s", "point": [0, 0, 0]}])", "normal"},
        {R"([{"field": "s", "point": [0, 0, 0], "normal": [0, 0, 0]}])", "a vector other than [0, 0, 0]"},
        {R"([{"field": "s", "axis": "x", "at": 1, "opacity": 1.5}])", "a number from 0 to 1"},
        {R"([{"field": "s", "axis": "x", "at": 1, "color": "virids"}])", "viridis"},
        {R"([{"field": "s", "axis": "x", "at": 1, "contours": {}}])", "none or several of \"levels\", \"count\" and \"spacing\""},
        {R"([{"field": "s", "axis": "x", "at": 1, "contours": {"count": 3, "spacing": 1}}])", "none or several of \"levels\""},
        {R"([{"field": "s", "axis": "x", "at": 1, "contours": {"count": 0}}])", "count"},
        {R"([{"field": "s", "axis": "x", "at": 1, "contours": {"spacing": 0}}])", "spacing"},
        {R"([{"field": "s", "axis": "x", "at": 1, "contours": {"levels": [1, 1]}}])", "rising numbers were expected"},
        {R"([{"field": "s", "axis": "x", "at": 1, "contours": {"levels": []}}])", "rising numbers"},
        {R"([{"field": "s", "axis": "x", "at": 1, "contours": {"count": 2, "width": 1e4}}])", "from 0 to 100"},
        {R"([{"field": "s", "axis": "x", "at": 1, "contour": {}}])", "contours"}})
    expect_error(parse(text), "s.json:2", {expected});
}

TEST(SceneMeshes, AppearanceIsReadAndChecked) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quad.obj", kQuad);
  const auto mesh = [&](const std::string& keys) {
    return parse_scene(R"({"fields": {"s": {"analytic": "sphere"}}, "meshes": [{"name": "m", "file": "quad.obj")" + keys + "}]}",
                       folder / "s.json");
  };
  const auto surface = only<SurfaceMesh>(value_of(
      mesh(R"(, "opacity": 0.5, "shading": "smooth", "edges": true, "color_by": {"field": "s", "color": "plasma", "range": [0, 2]})")));
  EXPECT_EQ(surface.opacity, 0.5);
  EXPECT_TRUE(surface.smooth_shading && surface.show_edges);
  ASSERT_TRUE(surface.color_by);
  EXPECT_EQ(surface.color_by->named.map, "plasma");
  const auto plain = only<SurfaceMesh>(value_of(mesh("")));
  EXPECT_EQ(plain.opacity, 1);
  EXPECT_FALSE(plain.smooth_shading || plain.show_edges || plain.color_by);
  for (const auto& [keys, expected] : {std::pair{R"(, "opacity": -0.1)", "opacity"},
                                       {R"(, "opacity": 1.1)", "a number from 0 to 1 was expected"},
                                       {R"(, "shading": "round")", "flat"},
                                       {R"(, "range": [0, 1])", "unknown key \"range\""},
                                       {R"(, "color_by": {"field": "t"})", "unknown field"}})
    expect_error(mesh(keys), folder / "s.json:1: ", {expected});
}

}  // namespace catena::scene::slices_test
