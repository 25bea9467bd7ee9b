// SPDX-License-Identifier: MIT
#include "engine/scene/widgets.h"
#include "tests/haptics/build/build_fixture.h"

namespace catena::haptics::build_widgets_test {

using build_tests::expect_error;
using build_tests::program_of;
using build_tests::scene_of;

TEST(ExtractWidgets, WidgetLinksFollowTheScenesLinks) {
  const auto program = program_of(R"({"chain": [{"name": "a", "type": "point", "position": [0, 0, 0]}],
    "widgets": [{"name": "cut", "type": "cutting_plane", "center": [1, 2, 3], "normal": [0, 0, 2]},
                {"name": "s", "type": "seed", "position": [4, 5, 6], "button": 3}], "coupling": {"stiffness": 123}})");
  ASSERT_EQ(program->links.size(), 5u);
  EXPECT_EQ(program->first_widget_link, 1);
  EXPECT_EQ(program->scene_link_count(), 1u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(program->links[1 + k].name, widget::kSharedLinkNames[k]);
  field::Cursor cursor;
  std::int32_t evaluations = 0;
  EXPECT_EQ(program->links[4].stiffness_n_per_m.at(Vec3(0.0), cursor, evaluations), 123);
  ASSERT_EQ(program->widgets.size(), 2u);
  EXPECT_EQ(program->widget_names, (std::vector<std::string>{"cut", "s"}));
  EXPECT_EQ(program->widgets[0].pose.points[0], Vec3(1, 2, 3));
  EXPECT_DOUBLE_EQ(program->widgets[0].radius, 0.48);
  EXPECT_DOUBLE_EQ(program->widgets[1].grab_distance, 0.12);
  EXPECT_EQ(program->widgets[1].button, 3);
}

TEST(ExtractWidgets, WithoutWidgetsThereAreNoWidgetLinks) {
  const auto program = program_of(R"({"chain": [{"name": "a", "type": "point", "position": [0, 0, 0]}]})");
  EXPECT_EQ(program->links.size(), 1u);
  EXPECT_EQ(program->first_widget_link, -1);
  EXPECT_EQ(program->scene_link_count(), 1u);
}

TEST(ExtractWidgets, EightSceneLinksAndFourWidgetLinksFit) {
  std::string links;
  for (int i = 0; i < 8; ++i)
    links += std::string(i > 0 ? ",\n" : "") + R"({"name": "l)" + std::to_string(i) + R"(", "type": "point", "position": [0, 0, 0]})";
  const std::string text = "{\"chain\": [" + links + R"(], "widgets": [{"name": "s", "type": "seed", "position": [0, 0, 0]}]})";
  EXPECT_EQ(program_of(text)->links.size(), 12u);
}

TEST(ExtractWidgets, PosesAreTheScenesCurrentOnes) {
  scene::Scene scene = scene_of(R"({"widgets": [{"name": "s", "type": "seed", "position": [0, 0, 0]}]})");
  const scene::Entity e = scene::find_widget(scene, "s");
  EXPECT_EQ(program_of(scene)->widgets[0].revision, 0u);
  scene.entities.get<scene::Widget>(e).report.pose.points[0] = {1, 1, 1};  // a pose set by the hand
  EXPECT_EQ(program_of(scene)->widgets[0].pose.points[0], Vec3(1, 1, 1));
  widget::Pose pose;
  pose.points[0] = {2, 2, 2};
  ASSERT_TRUE(scene::set_widget_pose(scene, e, pose));
  EXPECT_EQ(program_of(scene)->widgets[0].pose.points[0], Vec3(2, 2, 2));
  EXPECT_EQ(program_of(scene)->widgets[0].revision, 1u);
}

// A seed or level that names a widget gives the same links as the numbers.
TEST(ExtractWidgets, LinksFollowASeedAndAnIsolevel) {
  const std::string fields = R"("fields": {"v": {"analytic": "circle"}, "d": {"analytic": "sphere"}}, )";
  const auto chain = [](const std::string& seed, const std::string& level) {
    return R"("chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": )" + seed +
           R"(}, {"name": "surface", "type": "isosurface", "field": "d", "level": )" + level + "}]";
  };
  scene::Scene with = scene_of("{" + fields + chain(R"({"widget": "s"})", R"({"widget": "l"})") +
                               R"(, "widgets": [{"name": "s", "type": "seed", "position": [0.5, 0, 0.25]},
                                    {"name": "l", "type": "isolevel", "field": "d", "position": [0, 0.75, 0]}]})");
  scene::Scene without = scene_of("{" + fields + chain("[0.5, 0, 0.25]", "0.75") + "}");
  const auto a = program_of(with), b = program_of(without);
  ASSERT_EQ(a->links.size(), 6u);
  const Vec3 probe(0.4, 0.3, 0.2);
  test::ChainDriver first(*a), second(*b);
  first.at(0, probe);
  second.at(0, probe);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(first.link(i).proxy, second.link(i).proxy);
  // a moved widget changes the spec hash, so that the link restarts
  with.entities.get<scene::Widget>(scene::find_widget(with, "s")).report.pose.points[0] = {0.6, 0, 0.25};
  with.entities.get<scene::Widget>(scene::find_widget(with, "l")).report.value = 0.5;
  const auto moved = program_of(with);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NE(moved->links[i].spec_hash, a->links[i].spec_hash);
  EXPECT_NEAR(norm(test::ChainDriver(*moved).at(0, {0.6, 0.1, 0.2}).links[1].proxy), 0.5, 1e-9);
}

TEST(ExtractWidgets, ARulerGoesAlongLinksByName) {
  const std::string text =
      R"({"chain": [{"name": "a", "type": "point", "position": [0, 0, 0]}, {"name": "b", "type": "point", "position": [1, 0, 0]}],
"widgets": [{"name": "r", "type": "ruler", "from": [0, 0, 0], "to": [1, 0, 0],
"along": [)";
  EXPECT_EQ(program_of(text + "\"b\", \"a\"]}]}")->widgets[0].along_links, (std::vector<int>{1, 0}));
}

TEST(ExtractWidgets, UnsupportedUsesAreErrorsInOneLine) {
  for (const char* method : {"pipe", "balance", "closest", "linear"})
    expect_error(std::string("{\"coupling\": {\"method\": \"") + method +
                     "\"},\n\"widgets\": [{\"name\": \"s\", \"type\": \"seed\", \"position\": [0, 0, 0]}]}",
                 2, {"widgets need a proxy chain", "\"method\": \"chain\""});
  const std::string widgets = R"("widgets": [{"name": "s", "type": "seed", "position": [0, 0, 0]}])";
  const std::string fields = R"({"fields": {"v": {"analytic": "circle"}, "d": {"analytic": "sphere"}},)";
  expect_error(
      fields + widgets + ",\n\"chain\": [{\"name\": \"c\", \"type\": \"streamline\", \"field\": \"v\", \"seed\": {\"widget\": \"x\"}}]}", 2,
      {"unknown widget \"x\""});
  expect_error(
      fields + widgets + ",\n\"chain\": [{\"name\": \"c\", \"type\": \"isosurface\", \"field\": \"d\", \"level\": {\"widget\": \"s\"}}]}",
      2, {"is of type \"seed\"; an isolevel was expected"});
  expect_error(fields + widgets + ",\n\"chain\": [{\"name\": \"widget_x\", \"type\": \"point\", \"position\": [0, 0, 0]}]}", 1,
               {"\"widget_x\"", "reserved for widgets"});
}

}  // namespace catena::haptics::build_widgets_test
