// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/scene/scene.h"
#include "tests/support/support.h"

namespace catena::scene {
namespace scene_file_test {

std::string error_of(const std::string& text, const std::vector<FieldOverride>& overrides = {}) {
  const auto result = parse_scene(text, "scene.json", overrides);
  return result ? std::string("no error") : result.error().message;
}

/// Expects an error of one line that starts with the file and line and contains all parts.
void expect_error(const std::string& text, int line, std::initializer_list<const char*> parts) {
  const std::string message = error_of(text);
  EXPECT_TRUE(message.starts_with("scene.json:" + std::to_string(line) + ": ")) << message << "\nfor " << text;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
}

/// A scene with the fields circle and sphere on line 1, and `part` from line 2 on.
std::string with(const std::string& part) {
  return "{\"fields\": {\"swirl\": {\"analytic\": \"circle\"}, \"ball\": {\"analytic\": \"sphere\"}},\n" + part + "}";
}

TEST(SceneFile, EmptyScenesAreValid) {
  for (const char* text : {"{}", "{\"fields\": {}, \"chain\": []}", "// nothing\n{}"}) EXPECT_EQ(error_of(text), "no error") << text;
}

TEST(SceneFile, ReadsTheWholeExample) {
  const auto scene = parse_scene(R"({
    "fields": {"density": {"analytic": "sphere", "resolution": 16, "box": [-1, 1]}, "swirl": {"analytic": "circle", "scale": 2.0},
               "wall": {"analytic": "left-ventricle", "grid": "fibre"}, "wind": {"analytic": "uniform", "direction": [0, 0, 1]}},
    "chain": [{"name": "curve", "type": "streamline", "field": "swirl", "seed": [1, 0, 0]},
              {"name": "surface", "type": "isosurface", "field": "density", "level": 0.45}],
    "coupling": {"stiffness": 400, "damping": 1.5, "max_force": 6, "ramp_s": 0.1},
    "workspace": {"metres_per_unit": 0.05, "origin": [1, 2, 3], "rotation": {"axis": [0, 0, 2], "angle_deg": 90}},
    "camera": {"position": [8, -32, 38], "target": [8.25, 0, 29.8], "up": [0, 0, 1], "fovy_deg": 35},
    "volumes": [{"field": "density", "color": [[0.2, 0.1, 0.1, 0.4], [0.7, 0.9, 0.2, 0.1]], "opacity": [[0.2, 0.0], [0.7, 0.1]],
                 "opacity_unit": 0.18, "shade": true}],
    "isosurfaces": [{"field": "density", "level": 0.45, "color": [0.8, 0.7, 0.9], "opacity": 0.5}],
    "streamlines": [{"field": "swirl", "seeds": [[1.6, -0.57, 27.09], [1, 0, 0]], "radius": 0.02, "color": [1, 0.3, 0.2], "kind": "line",
                     "min_speed": 0.1, "length": 3}],
    "cursor": {"probe": [1, 1, 0], "size": 0.1}, "background": [0, 0.5, 1], "quality": "error=2"
  })",
                                 "scene.json");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->entities.count<FieldSource>(), 4u);
  const FieldSource& wall = scene->entities.get<FieldSource>(find_field(*scene, "wall"));
  EXPECT_EQ(wall.parameters.part, "fibre");
  EXPECT_EQ(scene->entities.get<FieldSource>(find_field(*scene, "wind")).parameters.direction, Vec3(0, 0, 1));
  EXPECT_EQ(scene->entities.get<FieldSource>(find_field(*scene, "density")).resolution, 16);
  std::vector<std::string> links;
  scene->entities.each<Link>([&](Entity, const Link& link) { links.push_back(link.name + ":" + link.type); });
  EXPECT_EQ(links, (std::vector<std::string>{"curve:streamline", "surface:isosurface"}));
  EXPECT_EQ(scene->coupling.stiffness_n_per_m, 400);
  EXPECT_EQ(scene->coupling.ramp_s, 0.1);
  EXPECT_TRUE(scene->workspace.is_explicit);
  EXPECT_LT(norm(scene->workspace.rotation * Vec3(1, 0, 0) - Vec3(0, 1, 0)), 1e-15);
  EXPECT_TRUE(scene->camera.is_explicit);
  EXPECT_EQ(scene->camera.fovy_deg, 35);
  scene->entities.each<Volume>([&](Entity, const Volume& v) {
    EXPECT_EQ(v.transfer.colors.size(), 2u);
    ASSERT_EQ(v.transfer.opacities.size(), 2u);
    EXPECT_EQ(v.transfer.opacities[1].alpha, 0.1);
    EXPECT_EQ(v.transfer.opacity_unit, 0.18);
    EXPECT_TRUE(v.shaded);
  });
  scene->entities.each<StreamlineSet>([&](Entity, const StreamlineSet& s) {
    EXPECT_EQ(s.seeds.points.size(), 2u);
    EXPECT_TRUE(s.is_line_field);
    EXPECT_EQ(s.length, 3);
  });
  EXPECT_TRUE(scene->entities.get<Cursor>(scene->cursor).visible);
  EXPECT_EQ(scene->quality, "error=2");
  EXPECT_EQ(scene->background.color.b, 1.0f);
}

TEST(SceneFile, UnknownAndDuplicateKeysAreRefused) {
  expect_error("{\n\"volume\": []}", 2, {"unknown key \"volume\"", "did you mean \"volumes\"?"});
  expect_error(with("\"coupling\": {\n\"stifness\": 3}"), 3, {"unknown key \"stifness\" in \"coupling\"", "damping, max_force"});
  expect_error(with("\"volumes\": [{\"field\": \"ball\",\n\"colour\": []}]"), 3, {"unknown key \"colour\" in \"volumes[0]\"", "\"color\""});
  expect_error("{\"fields\": {},\n\"fields\": {}}", 2, {"duplicate key \"fields\"", "expected"});
  expect_error("{\"fields\": {\"a\": {\"analytic\": \"circle\"},\n\"a\": {\"analytic\": \"circle\"}}}", 2, {"duplicate key \"a\""});
  expect_error("[]", 1, {"object", "expected"});
}

TEST(SceneFile, ChecksFieldSources) {
  const auto field = [](const std::string& body) { return "{\"fields\": {\n\"a\": " + body + "}}"; };
  expect_error(field("{}"), 2, {"none of", "exactly one", "expected"});
  expect_error(field("{\"file\": \"x.vdb\", \"analytic\": \"circle\"}"), 2, {"several of", "exactly one", "expected"});
  expect_error(field("{\"file\":\n\"missing.vdb\"}"), 3, {"missing.vdb", "does not exist", "expected"});
  expect_error(field("{\"file\": \"missing.txt\"}"), 2, {"missing.txt", "unknown kind", "a data file (.vdb, .nii"});
  expect_error(field("{\"analytic\": \"cirle\"}"), 2, {"unknown analytic field \"cirle\"", "saddle", "did you mean \"circle\"?"});
  expect_error(field("{\"analytic\": \"circle\", \"scale\": 0}"), 2, {"\"scale\" is 0", "other than 0 was expected"});
  expect_error(field("{\"analytic\": \"circle\", \"scale\": 1e999}"), 2, {"finite number was expected"});
  expect_error(field("{\"analytic\": \"uniform\", \"direction\": [0, 0, 0]}"), 2, {"\"direction\" is zero", "expected"});
  expect_error(field("{\"analytic\": \"uniform\", \"direction\": [0, 1]}"), 2, {"three finite numbers"});
  expect_error(field("{\"analytic\": \"circle\", \"direction\": [0, 1, 0]}"), 2, {"uniform", "expected"});
  expect_error(field("{\"analytic\": \"left-ventricle\", \"part\": \"wall\"}"), 2, {"unknown part \"wall\"", "transmural"});
  expect_error(field("{\"analytic\": \"circle\", \"resolution\": 1}"), 2, {"from 2 to 1024 was expected"});
  for (const char* box : {"[1, 1]", "[2, -2]", "[1]", "3", "[null, 1]"})
    expect_error(field("{\"analytic\": \"circle\", \"box\": " + std::string(box) + "}"), 2, {"\"box\"", "LO < HI were expected"});
  expect_error(field("{\"analytic\": \"circle\", \"file_\": 1}"), 2, {"unknown key"});
  expect_error("{\"fields\": {\n\"A b\": {\"analytic\": \"circle\"}}}", 2, {"\"A b\"", "[a-z][a-z0-9_]*"});
  expect_error("{\"fields\": []}", 1, {"an object {...} was expected"});
}

TEST(SceneFile, FilesAreRelativeToTheScene) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.vdb", "x");
  test::write_file(folder / "b.raw", "x");
  test::write_file(folder / "a.npy", "x");
  test::write_file(
      folder / "s.json",
      "{\"fields\": {\"a\": {\"file\": \"a.vdb\", \"grid\": \"density\", \"valid\": null}, \"c\": {\"file\": \"a.vdb\", \"valid\": "
      "\"mask\"},\n"
      "\"b\": {\"file\": \"b.raw\", \"shape\": [4, 5, 6], \"spacing\": [1, 2, 3], \"origin\": [0, 0, -1], \"type\": \"uint16\"}}}");
  const auto scene = read_scene(folder / "s.json");
  ASSERT_TRUE(scene) << scene.error().message;
  const auto& a = scene->entities.get<FieldSource>(find_field(*scene, "a")).file;
  EXPECT_EQ(a->path, folder / "a.vdb");
  EXPECT_EQ(a->grid, "density");
  EXPECT_FALSE(a->mask_grid.has_value());
  EXPECT_TRUE(scene->entities.get<FieldSource>(find_field(*scene, "c")).file->mask_required);
  const auto& raw = scene->entities.get<FieldSource>(find_field(*scene, "b")).file->raw;
  ASSERT_TRUE(raw.has_value());
  EXPECT_EQ(raw->shape, (field::Index3{4, 5, 6}));
  EXPECT_EQ(raw->spacing, Vec3(1, 2, 3));
  EXPECT_EQ(raw->type, "uint16");

  const auto message = [&](const std::string& body) {
    test::write_file(folder / "bad.json", "{\"fields\": {\n\"a\": " + body + "}}");
    const auto bad = read_scene(folder / "bad.json");
    return bad ? std::string() : bad.error().message;
  };
  EXPECT_NE(message("{\"file\": \"b.raw\"}").find("bad.json:2: key \"shape\" is missing"), std::string::npos);
  EXPECT_NE(message("{\"file\": \"b.raw\", \"shape\": [1, 5, 6]}").find("from 2 to 65536 were expected"), std::string::npos);
  EXPECT_NE(message("{\"file\": \"b.raw\", \"shape\": [4, 5, 6], \"spacing\": [1, 0, 1]}").find("> 0 were expected"), std::string::npos);
  EXPECT_NE(message("{\"file\": \"b.raw\", \"shape\": [4, 5, 6], \"type\": \"f32\"}").find("float64"), std::string::npos);
  EXPECT_NE(message("{\"file\": \"a.vdb\", \"shape\": [4, 5, 6]}").find("unknown key \"shape\""), std::string::npos);
  EXPECT_NE(message("{\"file\": \"a.vdb\", \"valid\": 3}").find("name of a BoolGrid"), std::string::npos);
  EXPECT_NE(message("{\"file\": \"a.vdb\", \"axes\": \"xyz\"}").find("is given for a file that is not a NumPy array"), std::string::npos);
  EXPECT_NE(message("{\"file\": \"a.npy\", \"axes\": \"xzy\"}").find("\"zyx\" or \"xyz\""), std::string::npos);
}

TEST(SceneFile, UnreadableScenesAreRefused) {
  const test::TemporaryFolder folder;
  for (const std::string& path : {folder / "none.json", folder.path()}) {
    const auto scene = read_scene(path);
    ASSERT_FALSE(scene);
    EXPECT_TRUE(scene.error().message.starts_with(path + ": ")) << scene.error().message;
    EXPECT_NE(scene.error().message.find("expected"), std::string::npos);
  }
}

TEST(SceneFile, ReadsOverrides) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "new.vdb", "x");
  const std::string text = "{\"fields\": {\"a\": {\"file\": \"missing.vdb\", \"grid\": \"density\"}}}";
  const auto scene = parse_scene(text, "scene.json", {{"a", folder / "new.vdb", ""}, {"b", folder / "new.vdb", "speed"}});
  ASSERT_TRUE(scene) << scene.error().message;
  const FieldSource& a = scene->entities.get<FieldSource>(find_field(*scene, "a"));
  EXPECT_EQ(a.file->path, folder / "new.vdb");
  EXPECT_EQ(a.file->grid, "density");
  EXPECT_TRUE(a.grid_is_optional);
  EXPECT_EQ(scene->entities.get<FieldSource>(find_field(*scene, "b")).file->grid, "speed");
  EXPECT_EQ(error_of("{}", {{"a", "gone.vdb", ""}}),
            "--field a=gone.vdb: file \"gone.vdb\" does not exist; a data file (.vdb, .nii, .vti, .vtu, .nrrd, .npy, ..; catena info "
            "--formats lists all) was expected");
  EXPECT_NE(error_of("{}", {{"A", "gone.vdb", ""}}).find("[a-z][a-z0-9_]*"), std::string::npos);
}

TEST(SceneFile, ChecksChains) {
  const auto link = [](const std::string& body) { return with("\"chain\": [\n{" + body + "}]"); };
  expect_error(link("\"type\": \"point\""), 3, {"\"name\" is missing", "expected"});
  expect_error(link("\"name\": \"a\""), 3, {"\"type\" is missing", "expected"});
  expect_error(link("\"name\": \"A\", \"type\": \"point\""), 3, {"\"A\"", "[a-z][a-z0-9_]*"});
  expect_error(link("\"name\": \"9a\", \"type\": \"point\""), 3, {"\"9a\"", "expected"});
  for (const char* taken : {"t", "probe", "force"})
    expect_error(link("\"name\": \"" + std::string(taken) + "\", \"type\": \"point\""), 3, {taken, "taken", "expected"});
  expect_error(link("\"name\": \"a\", \"type\": \"isosurface\", \"field\": \"bal\""), 3,
               {"unknown field \"bal\"", "known: swirl, ball", "did you mean \"ball\"?"});
  expect_error(with("\"chain\": [{\"name\": \"a\", \"type\": \"point\"},\n{\"name\": \"a\", \"type\": \"point\"}]"), 3,
               {"duplicate link name \"a\"", "expected"});
  std::string many;
  for (int i = 0; i < 9; ++i) many += std::string(i == 0 ? "" : ",") + "\n{\"name\": \"l" + std::to_string(i) + "\", \"type\": \"point\"}";
  expect_error(with("\"chain\": [" + many + "]"), 11, {"has 9 links", "at most 8 were expected"});
  expect_error(with("\"chain\": {}"), 2, {"array of links was expected"});
  expect_error(with("\"chain\": [3]"), 2, {"object"});
}

TEST(SceneFile, ReadsCoupling) {
  for (const char* key : {"stiffness", "damping", "max_force", "ramp_s"}) {
    expect_error(with("\"coupling\": {\n\"" + std::string(key) + "\": -1}"), 3, {key, "is -1", ">= 0 was expected"});
    expect_error(with("\"coupling\": {\n\"" + std::string(key) + "\": 1e999}"), 3, {"finite number was expected"});
    expect_error(with("\"coupling\": {\n\"" + std::string(key) + "\": \"soft\"}"), 3, {key, "finite number >= 0 was expected"});
    EXPECT_EQ(error_of(with("\"coupling\": {\"" + std::string(key) + "\": 0}")), "no error");
  }
}

TEST(SceneFile, ReadsWorkspaces) {
  expect_error(with("\"workspace\": {\"metres_per_unit\": 0}"), 2, {"metres_per_unit", "> 0 was expected"});
  expect_error(with("\"workspace\": {\"rotation\": [[1, 0, 0], [0, 2, 0], [0, 0, 1]]}"), 2, {"no rotation", "expected"});
  expect_error(with("\"workspace\": {\"rotation\": [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}"), 2, {"no rotation", "expected"});
  expect_error(with("\"workspace\": {\"rotation\": [1, 0, 0]}"), 2, {"three finite numbers"});
  expect_error(with("\"workspace\": {\"rotation\": {\"axis\": [0, 0, 0], \"angle_deg\": 3}}"), 2, {"\"axis\" is zero", "expected"});
  const auto scene = parse_scene(with("\"workspace\": {\"rotation\": [0, -1, 0, 1, 0, 0, 0, 0, 1]}"), "scene.json");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->workspace.rotation * Vec3(1, 0, 0), Vec3(0, 1, 0));
  EXPECT_FALSE(scene->workspace.is_explicit);
}

TEST(SceneFile, ChecksTransferFunctions) {
  const auto volume = [](const std::string& body) { return with("\"volumes\": [{\"field\": \"ball\",\n" + body + "}]"); };
  expect_error(volume("\"color\": [[0, 0, 0, 0],\n[0, 1, 1, 1]]"), 4, {"\"color\"", "strictly rising values were expected"});
  expect_error(volume("\"color\": [[0, 0, 0, 1.5]]"), 3, {"1.5", "from 0 to 1 were expected"});
  expect_error(volume("\"color\": [[0, 0, 0]]"), 3, {"rows of 4 finite numbers were expected"});
  expect_error(volume("\"color\": []"), 3, {"is empty", "expected"});
  expect_error(volume("\"opacity\": [[0, 0], [1, 1.1]]"), 3, {"\"opacity\" holds 1.1", "0 <= a <= 1 was expected"});
  expect_error(volume("\"opacity\": [[0, -0.1]]"), 3, {"0 <= a <= 1 was expected"});
  const auto opaque = parse_scene(volume("\"opacity\": [[0, 0], [1, 1]]"), "scene.json");
  ASSERT_TRUE(opaque);
  opaque->entities.each<Volume>(
      [](Entity, const Volume& v) { EXPECT_EQ(v.transfer.opacities.back().alpha, TransferFunction::OpacityPoint::kMaxAlpha); });
  expect_error(volume("\"opacity\": [[1, 0], [0, 0]]"), 3, {"strictly rising values were expected"});
  expect_error(volume("\"opacity\": [[1, 0]], \"opacity_unit\": 0"), 3, {"\"opacity_unit\" is 0", "> 0 was expected"});
  expect_error(volume("\"opacity_unit\": 1"), 3, {"expected"});
  expect_error(volume("\"extinction\": [[0, -1]]"), 3, {"sigma >= 0 was expected"});
  expect_error(volume("\"extinction\": [[0, 1]], \"opacity\": [[0, 0.5]]"), 3, {"both", "one of them was expected"});
  expect_error(volume("\"shade\": 1"), 3, {"true or false was expected"});
  expect_error(with("\"volumes\": [{\"field\": \"bal\"}]"), 2, {"unknown field \"bal\"", "known: swirl, ball"});
  expect_error(with("\"volumes\": [{}]"), 2, {"\"field\" is missing"});
  expect_error(with("\"volumes\": {}"), 2, {"array of objects was expected"});
}

TEST(SceneFile, ChecksIsosurfacesAndStreamlines) {
  expect_error(with("\"isosurfaces\": [{\"field\": \"ball\"}]"), 2, {"\"level\" is missing", "expected"});
  expect_error(with("\"isosurfaces\": [{\"field\": \"ball\", \"level\": 1e999}]"), 2, {"finite number was expected"});
  expect_error(with("\"isosurfaces\": [{\"field\": \"ball\", \"level\": 1, \"opacity\": 1.5}]"), 2, {"from 0 to 1 was expected"});
  expect_error(with("\"isosurfaces\": [{\"field\": \"ball\", \"level\": 1, \"color\": [0, 2, 0]}]"), 2, {"from 0 to 1 were expected"});
  const auto lines = [](const std::string& body) { return with("\"streamlines\": [{\"field\": \"swirl\",\n" + body + "}]"); };
  expect_error(lines("\"seeds\": [[1, 0, 0],\n[1, 2]]"), 4, {"array of 2", "three finite numbers [x, y, z] was expected"});
  expect_error(lines("\"seeds\": [[1, 0, 0],\n[1, NaN, 2]]"), 4, {"expected"});
  expect_error(lines("\"seeds\": [[1, 0, null]]"), 3, {"null", "three finite numbers"});
  expect_error(lines("\"seeds\": []"), 3, {"empty", "at least one seed"});
  expect_error(lines("\"radius\": 1"), 2, {"\"seeds\" is missing", "at least one seed"});
  expect_error(lines("\"seeds\": [[1, 0, 0]], \"radius\": 0"), 3, {"\"radius\" is 0", "> 0 was expected"});
  expect_error(lines("\"seeds\": [[1, 0, 0]], \"length\": -1"), 3, {"\"length\" is -1", "> 0 was expected"});
  expect_error(lines("\"seeds\": [[1, 0, 0]], \"min_speed\": -1"), 3, {"\"min_speed\" is -1", ">= 0 was expected"});
  expect_error(lines("\"seeds\": [[1, 0, 0]], \"kind\": \"lines\""), 3, {"vector, line"});
}

TEST(SceneFile, ReadsCamerasAndBackgrounds) {
  const auto camera = [](const std::string& body) { return with("\"camera\": {\"position\": [0, 0, 5],\n" + body + "}"); };
  expect_error(with("\"camera\": {\"fovy_deg\": 30}"), 2, {"\"position\" is missing"});
  expect_error(camera("\"target\": [0, 0, 5]"), 3, {"\"target\"", "two different points were expected"});
  expect_error(camera("\"target\": [0, 0, 0], \"up\": [0, 0, 2]"), 3, {"parallel", "expected"});
  expect_error(camera("\"target\": [0, 0, 0], \"up\": [0, 0, 0]"), 3, {"\"up\" is zero", "expected"});
  for (const char* fovy : {"0", "-30", "180", "200"})
    expect_error(camera("\"target\": [0, 0, 0], \"fovy_deg\": " + std::string(fovy)), 3, {"fovy_deg", "expected"});
  expect_error(camera("\"target\": [0, 0, 0], \"projection\": \"ortho\""), 3, {"perspective, orthographic"});
  expect_error(camera("\"target\": [0, 0, 0], \"projection\": \"orthographic\""), 2, {"\"height\" is missing"});
  expect_error(camera("\"target\": [0, 0, 0], \"height\": 2"), 3, {"orthographic", "expected"});
  const auto scene = parse_scene(camera("\"target\": [0, 0, 0]"), "scene.json");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_GT(norm(cross(scene->camera.up, Vec3(0, 0, 1))), 0.5);
  expect_error(with("\"background\": [0, 0, 2]"), 2, {"transparent", "expected"});
  expect_error(with("\"background\": \"black\""), 2, {"transparent", "expected"});
  EXPECT_TRUE(parse_scene("{\"background\": \"transparent\"}", "f")->background.transparent);
  expect_error(with("\"quality\": \"best\""), 2, {"draft, balanced, reference, time=MS, error=E or step=VOXELS"});
  expect_error(with("\"quality\": \"time=-3\""), 2, {"expected"});
  expect_error(with("\"cursor\": {\"probe\": [1, 2]}"), 2, {"three finite numbers"});
  expect_error(with("\"cursor\": {\"size\": 0}"), 2, {"> 0 was expected"});
}

TEST(SceneFile, CamerasThatSeeNothingAreRefused) {
  const auto camera = [](const std::string& keys) { return with("\"camera\": {" + keys + "}"); };
  expect_error(camera("\"position\": [1e30, 0, 0], \"target\": [0, 0, 0]"), 2, {"too far away", "1e+15"});
  expect_error(camera("\"position\": [1, 0, 0], \"target\": [0, -1e20, 0]"), 2, {"too far away"});
  expect_error(camera("\"position\": [6, 0, 0], \"target\": [6, 0, 0]"), 2, {"two different points"});
  expect_error(camera("\"position\": [6, 0, 0], \"target\": [6.0000000000001, 0, 0]"), 2, {"two different points"});
  expect_error(camera("\"position\": [6, 0, 0], \"target\": [0, 0, NaN]"), 2, {"not valid JSON"});
  expect_error(camera("\"position\": [6, 0, 0], \"target\": [0, 0, 1e999]"), 2, {"finite number"});
  for (const char* fovy : {"0", "-30", "1e-10", "179.9999999", "180", "1e30"})
    expect_error(camera("\"position\": [6, 0, 0], \"target\": [0, 0, 0], \"fovy_deg\": " + std::string(fovy)), 2, {"fovy_deg"});
  for (const char* height : {"0", "-1", "1e-20", "1e20"})
    expect_error(camera(R"("position": [6, 0, 0], "target": [0, 0, 0], "projection": "orthographic", "height": )" + std::string(height)), 2,
                 {"height"});
}

TEST(SceneFile, NumbersOutOfRangeAreRefused) {
  expect_error(with("\"coupling\": {\"stiffness\": 1e308}"), 2, {"1e+308 is too large", "1e-30 to 1e30"});
  expect_error(with("\"stereo\": {\"mode\": \"side-by-side\", \"separation\": 1e308}"), 2, {"too large"});
  expect_error(with("\"isosurfaces\": [{\"field\": \"ball\",\n \"level\": -1e31}]"), 3, {"-1e+31 is too large"});
  expect_error(with("\"workspace\": {\"metres_per_unit\": 1e-320}"), 2, {"is too small"});
  EXPECT_EQ(error_of(with("\"isosurfaces\": [{\"field\": \"ball\", \"level\": 1e29}, {\"field\": \"ball\", \"level\": 0}]")), "no error");
}

}  // namespace scene_file_test
}  // namespace catena::scene
