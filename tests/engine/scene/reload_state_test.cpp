// SPDX-License-Identifier: MIT
#include "engine/base/json_edit.h"
#include "engine/scene/document.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/to_json.h"
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::reload_state_test {

std::string edited(const std::string& text, std::string_view pointer, const std::string& value) {
  return value_of(json::set_value(text, "scene.json", pointer, value));
}

std::uint64_t version(Scene& scene, const char* name) { return value_of(resolve_field(scene, name, {})).get()->version(); }
std::uint64_t drawn_version(Scene& scene, const char* name) {
  return value_of(resolve_rendered_field(scene, find_field(scene, name), {})).get()->version();
}

/// A scene of the text with the state of an older scene.
Scene reloaded(Scene& old, const std::string& text, const std::string& path = "s.json") {
  Scene fresh = parsed(text, path);
  transfer_state(old, fresh);
  return fresh;
}

const std::string kText = R"({
  "fields": {"s": {"analytic": "sphere", "resolution": 8}, "t": {"analytic": "sphere", "scale": 2, "resolution": 8}, "v": {"analytic": "circle"}},
  "volumes": [{"field": "s"}],
  "streamlines": [{"field": "v", "seeds": [[1, 0, 0], [0.5, 0, 0]]},
                  {"field": "v", "seeds": {"line": {"from": [0.2, 0, 0], "to": [1, 0, 0], "count": 3}}}]
})";

std::vector<Entity> sets_of(const Scene& scene) { return entities_of<StreamlineSet>(scene); }

TEST(ReloadState, UnchangedFieldsAreKept) {
  Scene old = parsed(kText);
  const std::uint64_t s = version(old, "s"), t = version(old, "t"), drawn_s = drawn_version(old, "s"), drawn_t = drawn_version(old, "t");
  std::string text = edited(kText, "/fields/t/scale", "3");
  text = edited(text, "/fields/again", R"({"analytic": "sphere", "resolution": 9})");
  Scene fresh = reloaded(old, text);
  EXPECT_EQ(version(fresh, "s"), s);
  EXPECT_EQ(drawn_version(fresh, "s"), drawn_s);
  EXPECT_NE(version(fresh, "t"), t);
  EXPECT_NE(drawn_version(fresh, "t"), drawn_t);
  EXPECT_EQ(version(fresh, "again"), s);  // equal formulas are one field, sampled on two grids
  EXPECT_NE(drawn_version(fresh, "again"), drawn_s);
}

TEST(ReloadState, FilesAreReadOnceUnlessTheirGridOrMaskChanges) {
  const test::TemporaryFolder folder;
  write_grids(folder / "a.vdb");
  test::write_file(folder / "q.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nf 1 2 3\n");
  const std::string text = R"({"fields": {"a": {"file": "a.vdb", "grid": "ball"}}, "volumes": [{"field": "a"}],
                               "meshes": [{"name": "m", "file": "q.obj"}, {"name": "n", "file": "q.obj", "scale": 2}]})";
  Scene old = parsed(text, folder / "s.json");
  const std::uint64_t a = drawn_version(old, "a");
  const auto m = resolve_mesh(old, "m", {}), n = resolve_mesh(old, "n", {});
  ASSERT_TRUE(m && n);
  const auto loads = field::load_counters().grids;
  std::string changed = edited(text, "/meshes/1/scale", "3");
  changed = edited(changed, "/volumes/0/shade", "true");
  Scene fresh = reloaded(old, edited(changed, "/fields/b", R"({"file": "./a.vdb", "grid": "ball"})"), folder / "s.json");
  EXPECT_EQ(drawn_version(fresh, "a"), a);
  EXPECT_EQ(version(fresh, "b"), a);
  EXPECT_EQ(*resolve_mesh(fresh, "m", {}), *m);
  EXPECT_NE(*resolve_mesh(fresh, "n", {}), *n);
  EXPECT_EQ(field::load_counters().grids, loads);
  Scene other = reloaded(fresh, edited(changed, "/fields/a", R"({"file": "a.vdb", "grid": "flow"})"), folder / "s.json");
  EXPECT_NE(version(other, "a"), a);
  EXPECT_EQ(field::load_counters().grids, loads + 1);
}

TEST(ReloadState, UnchangedLinesAreKept) {
  Scene old = parsed(kText);
  std::vector<std::vector<flow::CurvePtr>> lines;
  for (const Entity set : sets_of(old)) lines.push_back(*resolve_lines(old, set));
  // Colors and radii change; seeds and fields do not.
  std::string text = edited(kText, "/streamlines/0/color", "[1, 1, 0]");
  text = edited(text, "/streamlines/1/radius", "0.03");
  Scene fresh = reloaded(old, text);
  std::vector<Entity> sets = sets_of(fresh);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(*resolve_lines(fresh, sets[i]), lines[i]) << i;
  // Other seeds: lines of unchanged seeds are kept.
  text = edited(text, "/streamlines/0/seeds/1", "[0.25, 0, 0]");
  text = edited(text, "/streamlines/1/seeds/line/count", "2");
  Scene third = reloaded(fresh, text);
  sets = sets_of(third);
  const auto points = resolve_lines(third, sets[0]), pattern = resolve_lines(third, sets[1]);
  ASSERT_TRUE(points && pattern);
  EXPECT_EQ((*points)[0], lines[0][0]);
  EXPECT_NE((*points)[1], lines[0][1]);
  EXPECT_EQ(pattern->size(), 2u);
  // Another field: no line is kept.
  Scene fourth = reloaded(third, edited(text, "/fields/v/scale", "2"));
  EXPECT_NE((*resolve_lines(fourth, sets_of(fourth)[0]))[0], lines[0][0]);
}

TEST(ReloadState, UnusedCurvesAreReleased) {
  Scene scene = parsed(kText);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(resolve_lines(scene, sets_of(scene)[0]));
    Scene fresh = reloaded(scene, edited(kText, "/streamlines/0/seeds/1", "[" + to_json(0.5 + 0.01 * i) + ", 0, 0]"));
    scene = std::move(fresh);
  }
  EXPECT_LE(scene.traced_curves.size(), 4u);
}

TEST(ReloadState, AutomaticColoursAreKept) {
  Scene old = parsed(kText);
  drawn_version(old, "s");
  const TransferFunction made = only<Volume>(old).transfer;
  ASSERT_FALSE(made.colors.empty() || made.extinctions.empty());
  const auto carried = [&](const std::string& text) {
    Scene before = parsed(kText);
    drawn_version(before, "s");
    return only<Volume>(reloaded(before, text)).transfer;
  };
  const TransferFunction shaded = carried(edited(kText, "/volumes/0/shade", "true"));
  EXPECT_EQ(to_json(shaded.colors), to_json(made.colors));
  EXPECT_EQ(to_json(shaded.extinctions), to_json(made.extinctions));
  const TransferFunction opaque = carried(edited(kText, "/volumes/0/opacity", "[[0, 0.1]]"));
  EXPECT_EQ(to_json(opaque.colors), to_json(made.colors));
  EXPECT_TRUE(opaque.extinctions.empty());
  const TransferFunction ranged = carried(edited(kText, "/volumes/0/range", "[0, 1]"));
  EXPECT_TRUE(ranged.colors.empty() && ranged.extinctions.empty());
  const TransferFunction other = carried(edited(kText, "/volumes/0/field", "\"t\""));
  EXPECT_TRUE(other.colors.empty() && other.extinctions.empty());
  const TransferFunction named = carried(edited(kText, "/volumes/0/color", "\"magma\""));
  EXPECT_TRUE(named.colors.empty());
  EXPECT_EQ(to_json(named.extinctions), to_json(made.extinctions));
}

/// A cached component of another module.
struct CachedComponent {
  int value = 0;
};

TEST(ReloadState, CachedComponentsMoveToEqualDescriptions) {
  const auto carried = [](const std::string& text) {
    Scene old = parsed(kText);
    const std::vector<Entity> sets = sets_of(old);
    old.cache.emplace<CachedComponent>(sets[0], {1});
    old.cache.emplace<CachedComponent>(sets[1], {2});
    Scene fresh = reloaded(old, text);
    std::string values;
    for (const Entity e : sets_of(fresh))
      values += fresh.cache.has<CachedComponent>(e) ? std::to_string(fresh.cache.get<CachedComponent>(e).value) : "-";
    return values;
  };
  EXPECT_EQ(carried(kText), "12");
  EXPECT_EQ(carried(edited(kText, "/background", "[0, 0, 0]")), "12");
  EXPECT_EQ(carried(edited(kText, "/streamlines/0/radius", "0.1")), "-2");
  EXPECT_EQ(carried(*json::remove_value(kText, "", "/streamlines/0")), "2");
  EXPECT_EQ(carried(*json::insert_item(kText, "", "/streamlines/0", R"({"field": "v", "seeds": [[1, 1, 0]]})")), "-12");
  // A change of any field invalidates the cache.
  EXPECT_EQ(carried(edited(kText, "/fields/t/scale", "3")), "--");
}

TEST(ReloadState, TheCursorKeepsItsState) {
  Scene old = parsed("{}"), fresh = parsed(R"({"cursor": {"size": 0.25, "show_occluded": false, "drop_line": true}})");
  Cursor& cursor = old.entities.get<Cursor>(old.cursor);
  cursor.probe = {1, 2, 3};
  cursor.names = {"a"};
  cursor.proxies = {{1, 2, 4}};
  cursor.visible = true;
  old.animation_phase = 3.5;
  transfer_state(old, fresh);
  const Cursor& after = fresh.entities.get<Cursor>(fresh.cursor);
  EXPECT_EQ(after.probe, Vec3(1, 2, 3));
  EXPECT_EQ(after.names, std::vector<std::string>{"a"});
  EXPECT_EQ(after.proxies.size(), 1u);
  EXPECT_TRUE(after.visible);
  EXPECT_EQ(after.size, 0.25);
  EXPECT_FALSE(after.show_occluded);
  EXPECT_TRUE(after.drop_line);
  EXPECT_EQ(fresh.animation_phase, 3.5);
}

Scene scene_with_widget(const std::string& name, const std::string& item, const widget::Pose& pose) {
  Scene scene = parsed("{}");
  Widget widget;
  widget.where = *json::parse(item, "");
  widget.spec.kind = widget::Kind::seed;
  widget.spec.pose = widget.report.pose = pose;
  const Entity e = scene.entities.create();
  scene.entities.emplace<Name>(e, {name});
  scene.entities.emplace<Widget>(e, std::move(widget));
  return scene;
}

widget::Pose at(const Vec3& p) {
  widget::Pose pose;
  pose.points[0] = p;
  return pose;
}

TEST(ReloadState, AWidgetKeepsItsPoseUnlessTheTextChangesIt) {
  using enum widget::Mode;
  const struct {
    const char *what, *name, *item;
    Vec3 stated, position;
    widget::Mode mode;
    std::uint64_t revision;
  } kCases[] = {{"the stated pose is unchanged", "w", R"({"position": [0, 0, 0], "radius": 2})", {0, 0, 0}, {5, 6, 7}, drag, 4},
                {"the stated pose was set to the current one", "w", R"({"position": [5, 6, 7]})", {5, 6, 7}, {5, 6, 7}, drag, 4},
                {"the stated pose was set to another one", "w", R"({"position": [1, 1, 1]})", {1, 1, 1}, {1, 1, 1}, idle, 5},
                {"another widget", "x", R"({"position": [0, 0, 0], "radius": 1})", {0, 0, 0}, {0, 0, 0}, idle, 0}};
  for (const auto& [what, name, item, stated, position, mode, revision] : kCases) {
    SCOPED_TRACE(what);
    Scene old = scene_with_widget("w", R"({"position": [0, 0, 0], "radius": 1})", at({0, 0, 0}));
    Widget& before = old.entities.get<Widget>(entities_of<Widget>(old).at(0));
    before.spec.revision = before.report.revision = 4;
    before.report.pose = at({5, 6, 7});
    before.report.mode = drag;
    Scene fresh = scene_with_widget(name, item, at(stated));
    transfer_state(old, fresh);
    const auto after = only<Widget>(fresh);
    EXPECT_EQ(after.report.pose, at(position));
    EXPECT_EQ(after.report.mode, mode);
    EXPECT_EQ(after.spec.revision, revision);
    EXPECT_EQ(after.report.revision, revision);
    EXPECT_EQ(after.spec.pose, at(stated));
  }
}

TEST(WriteValues, WrittenValuesReadBack) {
  Camera camera;
  camera.position = {0.1, 1.0 / 3, -1e-7};
  camera.target = {5, 6, 7e14};
  camera.up = {0.3, 0.2, 0.1};
  camera.orthographic = true;
  camera.ortho_height = 2.0 / 3;
  const std::vector<TransferFunction::ColorPoint> colors{{0.1, {0.1f, 0.2f, 0.3f}}, {0.7, {1, 0, 0.96f}}};
  const std::vector<TransferFunction::OpacityPoint> opacities{{0.1, 0}, {1.0 / 3, 0.25}};
  const std::string text =
      "{\"fields\": {\"s\": {\"analytic\": \"sphere\"}}, \"camera\": " + to_json(camera) + ", \"volumes\": [{\"field\": " + to_json("s") +
      ", \"color\": " + to_json(colors) + ", \"opacity\": " + to_json(opacities) + ", \"shade\": " + to_json(true) + "}], \"clip\": [" +
      to_json(ClipPlane{{{1, 2, 3}, {0.1, 0.2, 0.3}}}) + "], \"background\": " + to_json(Background{{0.1f, 0, 1}, false}) +
      ", \"lights\": [" + to_json(Light{{1, 2, 3}, {1, 0.5f, 0.1f}, 0.7, true}) + "]}";
  const Scene scene = parsed(text);
  EXPECT_EQ(to_json(scene.camera), to_json(camera));
  EXPECT_EQ(scene.camera.position, camera.position);
  EXPECT_EQ(scene.camera.ortho_height, camera.ortho_height);
  const auto volume = only<Volume>(scene);
  EXPECT_EQ(volume.transfer.colors[1].color.b, 0.96f);
  EXPECT_EQ(to_json(volume.transfer.colors), "[[0.1, 0.1, 0.2, 0.3], [0.7, 1, 0, 0.96]]");
  EXPECT_EQ(to_json(volume.transfer.opacities), to_json(opacities));
  EXPECT_EQ(scene.clip_planes.at(0).normal, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(scene.background.color.r, 0.1f);
  EXPECT_EQ(to_json(scene.illumination.lights.at(0)), to_json(Light{{1, 2, 3}, {1, 0.5f, 0.1f}, 0.7, true}));
  EXPECT_EQ(to_json(Background{{}, true}), "\"transparent\"");
}

TEST(WriteValues, APoseHasTheKeysOfItsType) {
  widget::Pose pose;
  pose.points = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  pose.orientation = Quat(0.5, 0.5, -0.5, 0.5);
  const auto keys = [&](widget::Kind kind) {
    std::string text;
    for (const auto& [key, value] : pose_members(kind, pose)) text += key + "=" + value.value_or("none") + " ";
    return text;
  };
  EXPECT_EQ(keys(widget::Kind::cutting_plane), "center=[1, 2, 3] normal=none orientation=[0.5, 0.5, -0.5, 0.5] ");
  EXPECT_EQ(keys(widget::Kind::seed), "position=[1, 2, 3] ");
  EXPECT_EQ(keys(widget::Kind::isolevel), "position=[1, 2, 3] ");
  EXPECT_EQ(keys(widget::Kind::rake), "from=[1, 2, 3] to=[4, 5, 6] ");
  EXPECT_EQ(keys(widget::Kind::ruler), "from=[1, 2, 3] to=[4, 5, 6] ");
  EXPECT_EQ(keys(widget::Kind::box), "min=[1, 2, 3] max=[4, 5, 6] ");
}

}  // namespace catena::scene::reload_state_test
