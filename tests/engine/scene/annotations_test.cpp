// SPDX-License-Identifier: MIT
/// Text and legends over the image of a scene: every key, and a one-line error for every mistake.
#include "engine/scene/annotations.h"

#include "engine/scene/prepare.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::annotations_test {

std::string with(const std::string& body) {
  return R"({"fields": {"d": {"analytic": "sphere", "resolution": 5}, "e": {"analytic": "plane"}, "v": {"analytic": "circle"}},
  "volumes": [{"field": "d"}],
  "streamlines": [{"field": "v", "seeds": [[1, 0, 0]]}, {"field": "v", "seeds": [[1, 0, 0]], "color_by": {"quantity": "speed"}}],
)" + body +
         "}";
}

void refused(const std::string& body, const std::vector<std::string>& parts) {
  expect_error(parse_scene(with(body), "s.json"), "s.json:4: ", parts);
}

TEST(Annotations, EveryKeyIsRead) {
  const Scene scene = parsed(with(R"("title": "A field",
    "scalar_bars": [{"volume": 0, "title": "rho", "position": "left", "ticks": 9, "format": "%.2f kg"},
                    {"streamlines": 1, "position": "bottom"}, {"field": "v"}, {"field": "d", "position": "top", "title": ""}],
    "labels": [{"at": [1, 2, 3], "text": "here", "color": [1, 0.5, 0], "size": 20, "dot": false, "occluded": true}, {"at": [0, 0, 0], "text": "µ"}],
    "orientation_marker": {"position": "top-right", "size": 120, "names": ["R", "A", "S"]},
    "status": true, "overlay": {"font": "Liberation Sans", "scale": 1.5, "color": [1, 1, 0]})"));
  const Annotations& all = scene.annotations;
  EXPECT_EQ(all.title, "A field");
  ASSERT_EQ(all.scalar_bars.size(), 4u);
  EXPECT_TRUE(scene.entities.has<Volume>(all.scalar_bars[0].target));
  EXPECT_EQ(all.scalar_bars[0].title, "rho");
  EXPECT_EQ(all.scalar_bars[0].side, ImageSide::left);
  EXPECT_EQ(all.scalar_bars[0].ticks, 9);
  EXPECT_EQ(all.scalar_bars[0].format, "%.2f kg");
  EXPECT_TRUE(scene.entities.has<StreamlineSet>(all.scalar_bars[1].target));
  EXPECT_EQ(all.scalar_bars[1].side, ImageSide::bottom);
  EXPECT_FALSE(all.scalar_bars[1].title);
  EXPECT_EQ(all.scalar_bars[2].target, all.scalar_bars[1].target) << "the set that has colours";
  EXPECT_EQ(all.scalar_bars[3].target, all.scalar_bars[0].target);
  EXPECT_EQ(all.scalar_bars[3].title, "") << "no title, on purpose";
  ASSERT_EQ(all.labels.size(), 2u);
  EXPECT_EQ(all.labels[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(all.labels[0].color->g, 0.5f);
  EXPECT_EQ(all.labels[0].size_pt, 20);
  EXPECT_FALSE(all.labels[0].show_dot);
  EXPECT_TRUE(all.labels[0].hide_when_occluded);
  EXPECT_FALSE(all.labels[1].color);
  ASSERT_TRUE(all.orientation_marker);
  EXPECT_EQ(all.orientation_marker->corner, ImageCorner::top_right);
  EXPECT_EQ(all.orientation_marker->names[2], "S");
  EXPECT_TRUE(all.show_status);
  EXPECT_EQ(all.font, "Liberation Sans");
  EXPECT_EQ(all.scale, 1.5);
  EXPECT_EQ(all.color->b, 0.0f);
}

TEST(Annotations, ThereAreNoAnnotationsByDefault) {
  const Scene scene = parsed(with(R"("orientation_marker": false)"));
  const Annotations& all = scene.annotations;
  EXPECT_TRUE(all.scalar_bars.empty() && all.labels.empty() && all.title.empty() && !all.orientation_marker && !all.show_status);
  const auto bar = first_scalar_bar(scene.entities);
  ASSERT_TRUE(bar);
  EXPECT_TRUE(scene.entities.has<Volume>(bar->target));
  EXPECT_FALSE(first_scalar_bar(EntityStore()));
}

TEST(Annotations, ErrorsAreOneLine) {
  refused(R"("scalar_bars": {})", {"array of objects was expected"});
  refused(R"("scalar_bars": [{}])", {"names no item", "\"volume\": INDEX", "expected"});
  refused(R"("scalar_bars": [{"volume": 0, "field": "d"}])", {"several items", "expected"});
  refused(R"("scalar_bars": [{"volume": 1}])", {"\"volume\"", "expected"});
  refused(R"("scalar_bars": [{"streamlines": 0}])", {"shows no values", "\"color_by\" was expected"});
  refused(R"("scalar_bars": [{"field": "e"}])", {"no volume", "\"e\"", "expected"});
  refused(R"("scalar_bars": [{"field": "x"}])", {"unknown field \"x\""});
  refused(R"("scalar_bars": [{"volume": 0, "position": "middle"}])", {"right, left, bottom, top"});
  refused(R"("scalar_bars": [{"volume": 0, "ticks": 1}])", {"\"ticks\"", "expected"});
  for (const char* format : {"%d", "%s", "%n", "%", "2", "%.2f %.2f", "%.200f", "%*f", "%-5f", "%.f"})
    refused(R"("scalar_bars": [{"volume": 0, "format": ")" + std::string(format) + "\"}]", {"\"format\"", "%.2f", "expected"});
  refused(R"("scalar_bars": [{"volume": 0, "tick": 3}])", {"\"tick\"", "ticks"});
  refused(R"("labels": [{"text": "a"}])", {"\"at\" is missing"});
  refused(R"("labels": [{"at": [0, 0, 0]}])", {"\"text\" is missing"});
  refused(R"("labels": [{"at": [0, 0, 0], "text": "a", "size": 0}])", {"\"size\"", "> 0 was expected"});
  refused(R"("labels": [{"at": [0, 0, 0], "text": "a", "size": 1000}])", {"576"});
  refused(R"("labels": [{"at": [0, 0, 0], "text": "a", "color": [2, 0, 0]}])", {"from 0 to 1"});
  refused(R"("title": 3)", {"title", "expected"});
  refused(R"("orientation_marker": 3)", {"true, false or an object was expected"});
  refused(R"("orientation_marker": {"position": "left"})", {"bottom-left, bottom-right, top-left, top-right"});
  refused(R"("orientation_marker": {"names": ["a"]})", {"names of the x, y and z axes were expected"});
  refused(R"("status": "on")", {"true or false was expected"});
  refused(R"("overlay": {"scale": 0})", {"> 0 was expected"});
  refused(R"("overlay": {"scale": 100})", {"from 0 to 20"});
  refused(R"("overlay": {"fonts": "x"})", {"\"fonts\"", "font"});
  expect_error(parse_scene(R"({"scalar_bars": [{"volume": 0}]})", "s.json"), "s.json:1: ", {"has no volumes"});
}

TEST(Annotations, TheCursorHasTheStatusOfEveryLink) {
  Scene scene = parsed("{}");
  HapticState state;
  state.link_count = 2;
  state.links[1].status = LinkStatus::boundary;
  update_cursor(scene, state);
  update_cursor(scene, state);
  EXPECT_EQ(scene.entities.get<Cursor>(scene.cursor).statuses, (std::vector{LinkStatus::ok, LinkStatus::boundary}));
}

}  // namespace catena::scene::annotations_test
