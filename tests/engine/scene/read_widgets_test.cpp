// SPDX-License-Identifier: MIT
/// "widgets" of the scene file, and the keys of items that follow widgets.
#include "engine/scene/widgets.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::read_widgets_test {

using widget::Kind;

const std::string kFields = R"({"fields": {"s": {"analytic": "sphere"}, "v": {"analytic": "circle"}},)";

/// Parses a scene whose `rest` is on line 2.
Result<Scene> parse(const std::string& rest) { return parse_scene(kFields + "\n" + rest + "}", "s.json"); }

Scene with_widget(const std::string& item) { return value_of(parse("\"widgets\": [" + item + "]")); }

TEST(ReadWidgets, ReadsACuttingPlaneWithAllKeys) {
  const Scene scene = with_widget(R"({"name": "cut", "type": "cutting_plane", "center": [1, 2, 3], "normal": [0, 0, -7], "radius": 0.5,
    "snap": 0.1, "release": 0.2, "grab_distance": 0.3, "step": 0.4, "rotation": "axis", "rotate_on_contact": true, "button": 32, "color": [0, 0.5, 1]})");
  const auto w = only<Widget>(scene);
  EXPECT_EQ(w.spec.kind, Kind::cutting_plane);
  EXPECT_EQ(w.spec.pose.points[0], Vec3(1, 2, 3));
  EXPECT_LT(norm(plane_normal(w.spec.pose) - Vec3(0, 0, -1)), 1e-15);
  EXPECT_EQ(std::tuple(w.spec.radius, w.spec.snap, w.spec.release, w.spec.grab_distance, w.spec.step), std::tuple(0.5, 0.1, 0.2, 0.3, 0.4));
  EXPECT_EQ(w.spec.rotation, widget::RotationMode::axis);
  EXPECT_TRUE(w.spec.rotate_on_contact);
  EXPECT_EQ(w.spec.button, 32);
  EXPECT_EQ(w.color.g, 0.5f);
  EXPECT_EQ(w.report.pose, w.spec.pose) << "where it is before a hand has touched it";
  EXPECT_TRUE(find_widget(scene, "cut"));
  EXPECT_FALSE(find_widget(scene, "cu"));
  EXPECT_FALSE(find_field(scene, "cut")) << "widgets have names of their own";
}

TEST(ReadWidgets, AUnitOrientationIsKeptBitExactly) {
  const auto orientation = [](const std::string& key) {
    return only<Widget>(with_widget(R"({"name": "c", "type": "cutting_plane", "center": [0, 0, 0], )" + key + "}")).spec.pose.orientation;
  };
  EXPECT_EQ(orientation(R"("orientation": [0.6, 0, 0.8, 0])"), Quat(0.6, 0, 0.8, 0));
  const Quat q = orientation(R"("orientation": [0.6000001, 0, 0.8, 0])");
  EXPECT_NEAR(q.w * q.w + q.y * q.y, 1, 1e-15);
  EXPECT_EQ(orientation(R"("normal": [0, 0, 1])"), kIdentityRotation);
}

TEST(ReadWidgets, ReadsTheOtherTypes) {
  const Scene scene = value_of(parse(R"("chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [1, 0, 0]}],
    "widgets": [{"name": "s", "type": "seed", "position": [1, 2, 3]}, {"name": "r", "type": "rake", "from": [0, 0, 0], "to": [1, 0, 0]},
      {"name": "l", "type": "isolevel", "field": "s", "position": [0.5, 0, 0]}, {"name": "b", "type": "box", "min": [0, 0, 0], "max": [1, 2, 3]},
      {"name": "u", "type": "ruler", "from": [0, 0, 0], "to": [0, 1, 0], "along": ["curve"]}])"));
  const auto get = [&](const char* name) { return scene.entities.get<Widget>(find_widget(scene, name)); };
  EXPECT_EQ(get("s").spec.pose.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(get("r").spec.pose.points[1], Vec3(1, 0, 0));
  EXPECT_EQ(get("l").field, find_field(scene, "s"));
  EXPECT_EQ(get("b").spec.pose.points[1], Vec3(1, 2, 3));
  EXPECT_EQ(get("u").along_links, std::vector<std::string>{"curve"});
}

TEST(ReadWidgets, FollowersHaveTheStatedPose) {
  const Scene scene = value_of(parse(R"("widgets": [{"name": "cut", "type": "cutting_plane", "center": [1, 0, 0], "normal": [2, 0, 0]},
      {"name": "b", "type": "box", "min": [0, 0, 0], "max": [1, 2, 3]}, {"name": "r", "type": "rake", "from": [0, 0, 0], "to": [1, 0, 0]}],
    "slices": [{"field": "s", "widget": "cut"}], "clip": [{"widget": "cut", "side": "behind"}, {"widget": "b"}],
    "streamlines": [{"field": "v", "seeds": {"widget": "r", "count": 3}}])"));
  const auto slice = only<Slice>(scene);
  EXPECT_EQ(slice.point, Vec3(1, 0, 0));
  EXPECT_LT(norm(slice.normal - Vec3(1, 0, 0)), 1e-15);
  ASSERT_EQ(scene.clip_planes.size(), 7u);
  EXPECT_LT(norm(scene.clip_planes[0].normal - Vec3(-1, 0, 0)), 1e-15);
  // The box keeps its inside, like a box without a widget.
  for (std::size_t i = 1; i < 7; ++i) {
    EXPECT_GT(dot(scene.clip_planes[i].normal, Vec3(0.5, 1, 1.5) - scene.clip_planes[i].point), 0);
    EXPECT_LT(dot(scene.clip_planes[i].normal, (i % 2 == 1 ? Vec3(-1, -1, -1) : Vec3(2, 3, 4)) - scene.clip_planes[i].point), 0);
  }
  const auto set = only<StreamlineSet>(scene);
  ASSERT_EQ(set.seeds.points.size(), 3u);
  EXPECT_EQ(set.seeds.points[1], Vec3(0.5, 0, 0));
}

void refused(const std::string& text, const std::string& expected) { expect_error(parse(text), "s.json:2: ", {expected}); }

TEST(ReadWidgets, ErrorsNameTheLine) {
  const std::string cut = R"("name": "c", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1])";
  for (const auto& [item, expected] : std::initializer_list<std::pair<std::string, std::string>>{
           {R"({"type": "seed", "position": [0, 0, 0]})", "name"},
           {R"({"name": "A", "type": "seed", "position": [0, 0, 0]})", "[a-z][a-z0-9_]*"},
           {R"({"name": "a", "position": [0, 0, 0]})", "type"},
           {R"({"name": "a", "type": "sphere", "position": [0, 0, 0]})", "cutting_plane"},
           {R"({"name": "a", "type": "seed"})", "position"},
           {R"({"name": "a", "type": "seed", "position": [0, 0]})", "position"},
           {R"({"name": "a", "type": "seed", "position": [0, 0, 1e999]})", "s.json:2"},
           {R"({"name": "a", "type": "seed", "position": [0, 0, 0], "snap": 1})", "snap"},
           {R"({"name": "a", "type": "seed", "position": [0, 0, 0]}, {"name": "a", "type": "seed", "position": [0, 0, 0]})",
            "already used for a widget"},
           {"{" + cut + R"(, "snap": 0.2, "release": 0.2})", "a distance greater than \"snap\" was expected"},
           {"{" + cut + R"(, "radius": 0})", "radius"},
           {"{" + cut + R"(, "step": -1})", "step"},
           {"{" + cut + R"(, "grab_distance": 1e200})", "1e-30 to 1e30"},
           {"{" + cut + R"(, "button": 0})", "button"},
           {"{" + cut + R"(, "button": 33})", "button"},
           {"{" + cut + R"(, "rotation": "none"})", "free"},
           {"{" + cut + R"(, "rotate_on_contact": 1})", "true or false was expected"},
           {"{" + cut + R"(, "color": [2, 0, 0]})", "color"},
           {"{" + cut + R"(, "orientation": [1, 0, 0, 0]})", "both"},
           {R"({"name": "c", "type": "cutting_plane", "center": [0, 0, 0]})", "neither"},
           {R"({"name": "c", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 0]})", "is zero"},
           {R"({"name": "c", "type": "cutting_plane", "center": [0, 0, 0], "orientation": [1, 0, 0]})", "[w, x, y, z]"},
           {R"({"name": "c", "type": "cutting_plane", "center": [0, 0, 0], "orientation": [1, 0, 0, 0.01]})", "unit quaternion"},
           {R"({"name": "l", "type": "isolevel", "position": [0, 0, 0]})", "field"},
           {R"({"name": "l", "type": "isolevel", "field": "w", "position": [0, 0, 0]})", "unknown field"},
           {R"({"name": "b", "type": "box", "min": [0, 0, 0], "max": [1, 0, 1]})", "a box was expected"},
           {R"({"name": "u", "type": "ruler", "from": [0, 0, 0], "to": [1, 0, 0], "along": "curve"})", "names of links"},
           {R"({"name": "u", "type": "ruler", "from": [0, 0, 0], "to": [1, 0, 0], "along": []})", "names of links"},
           {R"({"name": "u", "type": "ruler", "from": [0, 0, 0], "to": [1, 0, 0], "along": ["curve"]})", "not a link of the chain"}})
    refused("\"widgets\": [" + item + "]", expected);
  refused("\"widgets\": {}", "an array of objects was expected");
  refused("\"widgets\": [1]", "widgets[0]");
  std::string nine;
  for (int i = 0; i < 9; ++i)
    nine += (i ? "," : "") + ("{\"name\": \"w" + std::to_string(i) + R"(", "type": "seed", "position": [0, 0, 0]})");
  refused("\"widgets\": [" + nine + "]", "more than 8 widgets");
}

TEST(ReadWidgets, ErrorsOfFollowersNameTheLine) {
  const std::string widgets = R"("widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1]},
 {"name": "p", "type": "seed", "position": [0, 0, 0]}, {"name": "r", "type": "rake", "from": [0, 0, 0], "to": [0, 0, 1]},
 {"name": "b", "type": "box", "min": [0, 0, 0], "max": [1, 1, 1]}], )";
  // Followers may precede the widgets in the file.
  for (const auto& [text, expected] : std::initializer_list<std::pair<std::string, std::string>>{
           {R"("slices": [{"field": "s", "widget": "cat"}])", "did you mean \"cut\""},
           {R"("slices": [{"field": "s", "widget": "b"}])", "a cutting plane was expected"},
           {R"("slices": [{"field": "s", "widget": "cut", "normal": [0, 0, 1]}])", "one of them was expected"},
           {R"("slices": [{"field": "s", "widget": 3}])", "widget"},
           {R"("clip": [{"widget": "p"}])", "a cutting plane or a box was expected"},
           {R"("clip": [{"widget": "cut", "side": "left"}])", "behind"},
           {R"("clip": [{"widget": "b", "side": "front"}])", "is given with a box widget"},
           {R"("clip": [{"widget": "cut", "box": {"min": [0, 0, 0], "max": [1, 1, 1]}}])", "one of \"plane\", \"box\" and \"widget\""},
           {R"("clip": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "side": "front"}])", "without \"widget\""},
           {R"("clip": [{"widget": "b"}, {"widget": "b"}])", "more than 8 clip planes"},
           {R"("streamlines": [{"field": "v", "seeds": {"widget": "r"}}])", "\"count\" is missing"},
           {R"("streamlines": [{"field": "v", "seeds": {"widget": "r", "count": 0}}])", "count"},
           {R"("streamlines": [{"field": "v", "seeds": {"widget": "p", "count": 2}}])", "a rake was expected"},
           {R"("streamlines": [{"field": "v", "seeds": {"widget": "b"}}])", "a seed or a rake was expected"},
           {R"("streamlines": [{"field": "v", "seeds": {"widget": "p", "line": {}}}])", "line"},
           {R"("isosurfaces": [{"field": "s", "level": {"widget": "p"}}])", "an isolevel was expected"},
           {R"("isosurfaces": [{"field": "s", "level": {"widget": "p", "at": 1}}])", "at"}})
    refused(text + ",\n" + widgets.substr(0, widgets.size() - 2), expected);
}

}  // namespace catena::scene::read_widgets_test
