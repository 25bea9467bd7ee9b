// SPDX-License-Identifier: MIT
#include "engine/scene/widgets.h"

#include <limits>

#include "engine/scene/prepare.h"
#include "engine/scene/streamlines.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::widgets_test {

using widget::Kind;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Scene scene_of(const std::string& rest) {
  return parsed(R"({"fields": {"s": {"analytic": "sphere", "resolution": 21, "box": [-1, 1]}, "v": {"analytic": "circle"}},)" + rest + "}");
}

/// Moves the first point of a widget, as from a panel.
void move(Scene& scene, const char* name, const Vec3& to) {
  ASSERT_TRUE(set_widget_pose(scene, find_widget(scene, name), {{to, Vec3(0)}, kIdentityRotation}));
}

Widget& get(Scene& scene, const char* name) { return scene.entities.get<Widget>(find_widget(scene, name)); }

/// A haptic state with the current report of every widget.
HapticState state_of(Scene& scene) {
  HapticState state;
  scene.entities.each<Widget>([&](Entity, Widget& w) { state.widgets[static_cast<std::size_t>(state.widget_count++)] = w.report; });
  return state;
}

WidgetChanges driven(Scene& scene) { return value_of(propagate_widgets(scene)); }

/// Samples a field on n^3 nodes of a cube, as if it were of a file.
void load_grid(Scene& scene, const char* name, int n, double lo, double hi) {
  const Entity e = find_field(scene, name);
  scene.entities.get<FieldSource>(e).loaded = value_of(field::try_sample_on_grid(*resolve_field(scene, e, {}), n, lo, hi));
}

const std::string kCut = R"({"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1])";
const std::string kSeed = R"({"name": "p", "type": "seed", "position": [1, 0, 0]})";

TEST(Widgets, SizesFollowTheScenesExtent) {
  const auto spec_of = [](const std::string& rest, const char* name) {
    Scene scene = scene_of(rest);
    return value_of(resolve_widget(scene, find_widget(scene, name)));
  };
  const widget::Spec alone = spec_of("\"widgets\": [" + kCut + "}]", "cut");
  EXPECT_EQ(alone.length, 4);
  EXPECT_DOUBLE_EQ(alone.radius, 0.48);
  EXPECT_DOUBLE_EQ(alone.snap, 0.08);
  EXPECT_DOUBLE_EQ(alone.release, 0.2);
  EXPECT_DOUBLE_EQ(alone.grab_distance, 0.08);
  EXPECT_DOUBLE_EQ(alone.step, 0.08);
  const widget::Spec handle = spec_of("\"widgets\": [" + kSeed + "]", "p");
  EXPECT_DOUBLE_EQ(handle.radius, 0.048);
  EXPECT_DOUBLE_EQ(handle.grab_distance, 0.12);
  EXPECT_DOUBLE_EQ(handle.step, 0.08);
  // The domain of a file is ten times as long.
  Scene scene = scene_of("\"widgets\": [" + kCut + R"(, "grab_distance": 0.5}], "volumes": [{"field": "s"}])");
  load_grid(scene, "s", 5, -20, 20);
  const widget::Spec large = value_of(resolve_widget(scene, find_widget(scene, "cut")));
  EXPECT_EQ(large.length, 40);
  EXPECT_DOUBLE_EQ(large.radius, 4.8);
  EXPECT_EQ(large.grab_distance, 0.5) << "stated";
}

TEST(Widgets, TheDefaultOfSnapOrReleaseFitsAStatedOne) {
  Scene scene =
      scene_of("\"widgets\": [" + kCut + R"(, "snap": 3}, {"name": "b", "type": "cutting_plane", "center": [0, 0, 0], "normal": [1, 0, 0],
    "release": 0.01}])");
  const auto a = resolve_widget(scene, find_widget(scene, "cut")), b = resolve_widget(scene, find_widget(scene, "b"));
  ASSERT_TRUE(a && b);
  EXPECT_DOUBLE_EQ(a->release, 7.5);
  EXPECT_DOUBLE_EQ(b->snap, 0.004);
}

TEST(Widgets, AnIsolevelHasTheFieldsValue) {
  Scene scene = scene_of(R"("widgets": [{"name": "l", "type": "isolevel", "field": "s", "position": [0.3, 0, 0.4]}])");
  EXPECT_TRUE(value_of(resolve_widget(scene, find_widget(scene, "l"))).field);
  EXPECT_DOUBLE_EQ(get(scene, "l").report.value, 0.5);
  Scene wrong = scene_of(
      "\n"
      R"("widgets": [{"name": "l", "type": "isolevel", "field": "v", "position": [0, 0, 0]}])");
  expect_error(resolve_widget(wrong, find_widget(wrong, "l")), "s.json:2: ", {"a scalar field was expected"});
}

TEST(Widgets, AnIsolevelOutsideItsFieldIsRefused) {
  Scene scene = scene_of(
      "\n"
      R"("widgets": [{"name": "l", "type": "isolevel", "field": "s", "position": [5, 0, 0]}])");
  load_grid(scene, "s", 5, -1, 1);
  expect_error(resolve_widget(scene, find_widget(scene, "l")), "s.json:2: ", {"outside the domain"});
}

TEST(Widgets, ReportsAreApplied) {
  Scene scene = scene_of("\"widgets\": [" + kCut + "}, " + kSeed + "]");
  HapticState state = state_of(scene);
  EXPECT_FALSE(update_widgets(scene, state)) << "nothing new";
  state.widgets[1].pose.points[0] = {1, 2, 3};
  state.widgets[1].mode = widget::Mode::drag;
  state.widgets[1].active_planes = 6;
  EXPECT_TRUE(update_widgets(scene, state));
  EXPECT_EQ(get(scene, "p").report.pose.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(get(scene, "p").report.mode, widget::Mode::drag);
  EXPECT_EQ(get(scene, "p").report.active_planes, 6);
  EXPECT_EQ(get(scene, "p").spec.pose.points[0], Vec3(1, 0, 0)) << "as stated";
  // A change of the mode alone is applied.
  state.widgets[1].mode = widget::Mode::idle;
  EXPECT_FALSE(update_widgets(scene, state));
  EXPECT_EQ(get(scene, "p").report.mode, widget::Mode::idle);
}

TEST(Widgets, InvalidReportsAreIgnored) {
  Scene scene = scene_of("\"widgets\": [" + kSeed + "]");
  const widget::Report before = get(scene, "p").report;
  const auto ignored = [&](auto&& change) {
    HapticState state = state_of(scene);
    state.widgets[0].pose.points[0].z = 1;
    change(state);
    return !update_widgets(scene, state) && get(scene, "p").report.pose == before.pose;
  };
  EXPECT_TRUE(ignored([](auto& s) { s.widgets[0].pose.points[0].x = kNaN; }));
  EXPECT_TRUE(ignored([](auto& s) { s.widgets[0].pose.orientation.y = kNaN; }));
  EXPECT_TRUE(ignored([](auto& s) { s.widgets[0].pose.orientation = Quat(0, 0, 0, 0); }));
  EXPECT_TRUE(ignored([](auto& s) { s.widgets[0].value = kNaN; }));
  EXPECT_TRUE(ignored([](auto& s) { s.widgets[0].revision = 7; }));
  EXPECT_TRUE(ignored([](auto& s) { s.widget_count = 0; }));
  EXPECT_TRUE(ignored([](auto& s) { s.widget_count = 2; }));
  EXPECT_FALSE(ignored([](auto&) {}));
}

TEST(Widgets, ASetPoseIsNotOverwrittenByOlderReports) {
  Scene scene = scene_of("\"widgets\": [" + kSeed + R"(, {"name": "b", "type": "box", "min": [0, 0, 0], "max": [1, 1, 1]}])");
  HapticState old = state_of(scene);
  old.widgets[0].pose.points[0] = {9, 9, 9};
  const Entity p = find_widget(scene, "p");
  ASSERT_TRUE(set_widget_pose(scene, p, {{Vec3(2, 0, 0), Vec3(kNaN)}, kIdentityRotation})) << "what the kind does not read does not count";
  EXPECT_EQ(get(scene, "p").spec.revision, 1u);
  EXPECT_EQ(get(scene, "p").spec.pose.points[0], Vec3(2, 0, 0));
  EXPECT_FALSE(update_widgets(scene, old)) << "of the tick that has not yet heard of it";
  EXPECT_EQ(get(scene, "p").report.pose.points[0], Vec3(2, 0, 0));
  HapticState fresh = old;
  fresh.widgets[0].revision = 1;
  EXPECT_TRUE(update_widgets(scene, fresh));
  EXPECT_EQ(get(scene, "p").report.pose.points[0], Vec3(9, 9, 9));
  // An invalid pose is refused and changes nothing.
  EXPECT_FALSE(set_widget_pose(scene, p, {{Vec3(kNaN), Vec3(0)}, kIdentityRotation}));
  EXPECT_EQ(get(scene, "p").spec.revision, 1u);
  EXPECT_FALSE(set_widget_pose(scene, find_widget(scene, "b"), {{Vec3(0), Vec3(1, 0, 1)}, kIdentityRotation}));
  EXPECT_TRUE(set_widget_pose(scene, find_widget(scene, "b"), {{Vec3(0), Vec3(1, 2, 1)}, kIdentityRotation}));
}

TEST(Widgets, SlicesAndClipsFollow) {
  Scene scene = scene_of("\"widgets\": [" + kCut + R"(}, {"name": "b", "type": "box", "min": [-1, -1, -1], "max": [1, 1, 1]}],
    "slices": [{"field": "s", "widget": "cut"}], "clip": [{"widget": "cut"}, {"widget": "b"}])");
  driven(scene);
  EXPECT_FALSE(driven(scene).any()) << "nothing moved";
  HapticState state = state_of(scene);
  state.widgets[0].pose = {{Vec3(0.1, 0.2, 0.3), Vec3(0)}, rotation_from_vector({0.5 * 3.14159265358979323846, 0, 0})};
  ASSERT_TRUE(update_widgets(scene, state));
  WidgetChanges changes = driven(scene);
  EXPECT_TRUE(changes.slices && changes.clip);
  EXPECT_FALSE(changes.seeds || changes.levels || changes.links);
  const auto slice = only<Slice>(scene);
  EXPECT_EQ(slice.point, Vec3(0.1, 0.2, 0.3));
  EXPECT_LT(norm(slice.normal - Vec3(0, -1, 0)), 1e-15) << "a quarter turn about x carries z to -y";
  EXPECT_EQ(scene.clip_planes[0].point, slice.point);
  EXPECT_EQ(scene.clip_planes[0].normal, slice.normal);
  EXPECT_EQ(scene.clip_planes[1].point, Vec3(-1, -1, -1)) << "the box has not moved";
  state.widgets[1].pose.points[1].x = 0.5;
  ASSERT_TRUE(update_widgets(scene, state));
  changes = driven(scene);
  EXPECT_TRUE(changes.clip && !changes.slices);
  EXPECT_EQ(scene.clip_planes[2].point.x, 0.5);
  EXPECT_EQ(scene.clip_planes[2].normal, Vec3(-1, 0, 0));
}

TEST(Widgets, LevelsFollowWithinTheFieldsRange) {
  Scene scene = scene_of(R"("widgets": [{"name": "l", "type": "isolevel", "field": "s", "position": [0.5, 0, 0]}],
    "isosurfaces": [{"field": "s", "level": {"widget": "l"}}])");
  EXPECT_TRUE(driven(scene).levels);
  EXPECT_EQ(only<Isosurface>(scene).level, 0.5);
  HapticState state = state_of(scene);
  state.widgets[0].value = 0.75;
  state.widgets[0].pose.points[0] = {0.75, 0, 0};
  ASSERT_TRUE(update_widgets(scene, state));
  EXPECT_TRUE(driven(scene).levels);
  EXPECT_EQ(only<Isosurface>(scene).level, 0.75);
  // A value out of the range of the rendered grid.
  state.widgets[0].value = 99;
  ASSERT_TRUE(update_widgets(scene, state));
  driven(scene);
  const auto grid = resolve_rendered_field(scene, find_field(scene, "s"), {});
  ASSERT_TRUE(grid);
  EXPECT_EQ(only<Isosurface>(scene).level, grid->scalar->max_value());
  EXPECT_TRUE(check_level(*grid->scalar, only<Isosurface>(scene).level, {}));
  // If the widget is moved from a panel, the value follows its position.
  move(scene, "l", {0, 0.25, 0});
  EXPECT_TRUE(driven(scene).levels);
  EXPECT_EQ(only<Isosurface>(scene).level, 0.25);
}

TEST(Widgets, ChangesOfWidgetsWithLinksAreReported) {
  Scene scene = scene_of("\"widgets\": [" + kCut + "}, " + kSeed + R"(],
    "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": {"widget": "p"}}])");
  EXPECT_TRUE(has_haptic_link(scene, find_widget(scene, "p")));
  EXPECT_FALSE(has_haptic_link(scene, find_widget(scene, "cut")));
  EXPECT_FALSE(driven(scene).links) << "the program is made of the pose as stated";
  HapticState state = state_of(scene);
  state.widgets[0].pose.points[0].x = 0.1;
  ASSERT_TRUE(update_widgets(scene, state));
  EXPECT_FALSE(driven(scene).links) << "no link names the plane";
  state.widgets[1].pose.points[0].x = 0.9;
  ASSERT_TRUE(update_widgets(scene, state));
  EXPECT_TRUE(driven(scene).links);
  EXPECT_FALSE(driven(scene).links);
}

TEST(Widgets, LinesFollowTheirSeeds) {
  Scene scene = scene_of("\"widgets\": [" + kSeed + R"(], "streamlines": [{"field": "v", "seeds": {"widget": "p"}}])");
  driven(scene);
  const Entity set = entities_of<StreamlineSet>(scene).at(0);
  const auto first = resolve_lines(scene, set), again = resolve_lines(scene, set);
  ASSERT_TRUE(first && again);
  ASSERT_EQ(first->size(), 1u);
  EXPECT_EQ(*first, *again) << "traced once";
  move(scene, "p", {0.5, 0, 0});
  EXPECT_TRUE(driven(scene).seeds);
  const auto moved = resolve_lines(scene, set);
  ASSERT_TRUE(moved);
  ASSERT_EQ(moved->size(), 1u);
  EXPECT_NE(moved->front(), first->front());
  EXPECT_NEAR(moved->front()->period(), 3.14159265358979, 1e-6) << "the circle through the seed";
  // The link's curve is the rendered curve.
  const field::AnyField v = *resolve_field(scene, find_field(scene, "v"), {});
  EXPECT_EQ(*resolve_streamline(scene, {v.vector.get()}, {0.5, 0, 0}, {}), moved->front());
}

TEST(Widgets, SeedsWithoutALineAreLeftOut) {
  // The middle seed is at a point of zero velocity.
  Scene scene = scene_of(R"("widgets": [{"name": "r", "type": "rake", "from": [-1, 0, 0], "to": [1, 0, 0]},)" + kSeed + R"(],
    "streamlines": [{"field": "v", "seeds": {"widget": "r", "count": 3}}])");
  driven(scene);
  EXPECT_EQ(value_of(resolve_lines(scene, entities_of<StreamlineSet>(scene).at(0))).size(), 2u);

  // A seed outside the domain of a grid, with both tracers.
  for (const char* tolerance : {"1e-10", "1e-5"}) {
    Scene grid = scene_of("\"widgets\": [" + kSeed + R"(], "streamlines": [{"field": "v", "seeds": {"widget": "p"}, "tolerance": )" +
                          tolerance + "}]");
    load_grid(grid, "v", 9, -2, 2);
    driven(grid);
    const Entity set = entities_of<StreamlineSet>(grid).at(0);
    EXPECT_EQ(resolve_lines(grid, set)->size(), 1u);
    move(grid, "p", {7, 0, 0});
    driven(grid);
    EXPECT_TRUE(value_of(resolve_lines(grid, set)).empty());
    move(grid, "p", {0, 1, 0});
    driven(grid);
    EXPECT_EQ(resolve_lines(grid, set)->size(), 1u) << "and back";
  }
}

TEST(Widgets, CurvesOfMovingSeedsAreReleased) {
  Scene scene = scene_of("\"widgets\": [" + kSeed + R"(], "streamlines": [{"field": "v", "seeds": {"widget": "p"}},
    {"field": "v", "seeds": [[0.3, 0, 0], [0.4, 0, 0]]}])");
  const std::vector<Entity> sets = entities_of<StreamlineSet>(scene);
  driven(scene);
  const auto fixed = resolve_lines(scene, sets[1]);
  ASSERT_TRUE(fixed);
  const field::AnyField v = *resolve_field(scene, find_field(scene, "v"), {});
  const auto felt = *resolve_streamline(scene, {v.vector.get()}, {0.7, 0, 0}, {});
  for (int i = 0; i < 500; ++i) {
    move(scene, "p", {0.5 + 0.001 * i, 0, 0});
    driven(scene);
    ASSERT_TRUE(resolve_lines(scene, sets[0]));
    ASSERT_LE(scene.traced_curves.size(), 4u) << "two fixed ones, the felt one, the moving one";
  }
  EXPECT_EQ(*resolve_lines(scene, sets[1]), *fixed);
  EXPECT_EQ(*resolve_streamline(scene, {v.vector.get()}, {0.7, 0, 0}, {}), felt) << "what a link holds stays";
  // A link with a moving seed, without rendered lines.
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(resolve_streamline(scene, {v.vector.get()}, {0.1 + 0.001 * i, 0.2, 0}, {}));
    ASSERT_LE(scene.traced_curves.size(), 64u);
  }
}

TEST(Widgets, FixedSeedsKeepTheirErrors) {
  Scene scene = scene_of(
      "\n"
      R"("streamlines": [{"field": "v", "seeds": [[1, 0, 0], [0, 0, 0]]}])");
  expect_error(resolve_lines(scene, entities_of<StreamlineSet>(scene).at(0)), "s.json:2: ", {});
}

}  // namespace catena::scene::widgets_test
