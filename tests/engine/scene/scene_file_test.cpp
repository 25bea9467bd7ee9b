// SPDX-License-Identifier: MIT
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::scene_file_test {

void refused(const std::string& text, int line, const std::vector<std::string>& parts) {
  expect_error(parse_scene(text, "scene.json"), "scene.json:" + std::to_string(line) + ": ", parts);
}

/// A scene with the fields circle and sphere on line 1, and `part` from line 2 on.
std::string with(const std::string& part) {
  return "{\"fields\": {\"swirl\": {\"analytic\": \"circle\"}, \"ball\": {\"analytic\": \"sphere\"}},\n" + part + "}";
}

const FieldSource& source_of(const Scene& scene, const char* name) { return scene.entities.get<FieldSource>(find_field(scene, name)); }

TEST(SceneFile, EmptyScenesAreValid) {
  for (const char* text : {"{}", "{\"fields\": {}, \"chain\": []}", "// nothing\n{}"}) parsed(text);
}

TEST(SceneFile, ReadsTheWholeExample) {
  const Scene scene = parsed(R"({
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
  })");
  EXPECT_EQ(scene.entities.count<FieldSource>(), 4u);
  EXPECT_EQ(source_of(scene, "wall").parameters.part, "fibre");
  EXPECT_EQ(source_of(scene, "wind").parameters.direction, Vec3(0, 0, 1));
  EXPECT_EQ(source_of(scene, "density").resolution, 16);
  std::string links;
  for (const Link& link : all_of<Link>(scene)) links += link.name + ":" + link.type + " ";
  EXPECT_EQ(links, "curve:streamline surface:isosurface ");
  EXPECT_EQ(scene.coupling.stiffness_n_per_m, 400);
  EXPECT_EQ(scene.coupling.ramp_s, 0.1);
  EXPECT_TRUE(scene.workspace.is_explicit);
  EXPECT_LT(norm(scene.workspace.rotation * Vec3(1, 0, 0) - Vec3(0, 1, 0)), 1e-15);
  EXPECT_TRUE(scene.camera.is_explicit);
  EXPECT_EQ(scene.camera.fovy_deg, 35);
  const auto volume = only<Volume>(scene);
  EXPECT_EQ(volume.transfer.colors.size(), 2u);
  ASSERT_EQ(volume.transfer.opacities.size(), 2u);
  EXPECT_EQ(volume.transfer.opacities[1].alpha, 0.1);
  EXPECT_EQ(volume.transfer.opacity_unit, 0.18);
  EXPECT_TRUE(volume.shaded);
  const auto lines = only<StreamlineSet>(scene);
  EXPECT_EQ(lines.seeds.points.size(), 2u);
  EXPECT_TRUE(lines.is_line_field);
  EXPECT_EQ(lines.length, 3);
  EXPECT_TRUE(scene.entities.get<Cursor>(scene.cursor).visible);
  EXPECT_EQ(scene.quality, "error=2");
  EXPECT_EQ(scene.background.color.b, 1.0f);
}

TEST(SceneFile, UnknownAndDuplicateKeysAreRefused) {
  refused("{\n\"volume\": []}", 2, {"unknown key \"volume\"", "did you mean \"volumes\"?"});
  refused(with("\"coupling\": {\n\"stifness\": 3}"), 3, {"unknown key \"stifness\" in \"coupling\"", "damping, max_force"});
  refused(with("\"volumes\": [{\"field\": \"ball\",\n\"colour\": []}]"), 3, {"unknown key \"colour\" in \"volumes[0]\"", "\"color\""});
  refused("{\"fields\": {},\n\"fields\": {}}", 2, {"duplicate key \"fields\"", "expected"});
  refused("{\"fields\": {\"a\": {\"analytic\": \"circle\"},\n\"a\": {\"analytic\": \"circle\"}}}", 2, {"duplicate key \"a\""});
  refused("[]", 1, {"object", "expected"});
}

TEST(SceneFile, ChecksFieldSources) {
  const auto field = [](const std::string& body) { return "{\"fields\": {\n\"a\": " + body + "}}"; };
  refused(field("{}"), 2, {"none of", "exactly one", "expected"});
  refused(field("{\"file\": \"x.vdb\", \"analytic\": \"circle\"}"), 2, {"several of", "exactly one", "expected"});
  refused(field("{\"file\":\n\"missing.vdb\"}"), 3, {"missing.vdb", "does not exist", "expected"});
  refused(field("{\"file\": \"missing.txt\"}"), 2, {"missing.txt", "unknown kind", "a data file (.vdb, .nii"});
  refused(field("{\"analytic\": \"cirle\"}"), 2, {"unknown analytic field \"cirle\"", "saddle", "did you mean \"circle\"?"});
  refused(field("{\"analytic\": \"circle\", \"scale\": 0}"), 2, {"\"scale\" is 0", "other than 0 was expected"});
  refused(field("{\"analytic\": \"circle\", \"scale\": 1e999}"), 2, {"finite number was expected"});
  refused(field("{\"analytic\": \"uniform\", \"direction\": [0, 0, 0]}"), 2, {"\"direction\" is zero", "expected"});
  refused(field("{\"analytic\": \"uniform\", \"direction\": [0, 1]}"), 2, {"three finite numbers"});
  refused(field("{\"analytic\": \"circle\", \"direction\": [0, 1, 0]}"), 2, {"uniform", "expected"});
  refused(field("{\"analytic\": \"left-ventricle\", \"part\": \"wall\"}"), 2, {"unknown part \"wall\"", "transmural"});
  refused(field("{\"analytic\": \"circle\", \"resolution\": 1}"), 2, {"from 2 to 1024 was expected"});
  for (const char* box : {"[1, 1]", "[2, -2]", "[1]", "3", "[null, 1]"})
    refused(field("{\"analytic\": \"circle\", \"box\": " + std::string(box) + "}"), 2, {"\"box\"", "LO < HI were expected"});
  refused(field("{\"analytic\": \"circle\", \"file_\": 1}"), 2, {"unknown key"});
  refused("{\"fields\": {\n\"A b\": {\"analytic\": \"circle\"}}}", 2, {"\"A b\"", "[a-z][a-z0-9_]*"});
  refused("{\"fields\": []}", 1, {"an object {...} was expected"});
}

TEST(SceneFile, FilesAreRelativeToTheScene) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.vdb", "b.raw", "a.npy"}) test::write_file(folder / name, "x");
  test::write_file(folder / "s.json", R"({"fields": {"a": {"file": "a.vdb", "grid": "density", "valid": null},
    "c": {"file": "a.vdb", "valid": "mask"},
    "b": {"file": "b.raw", "shape": [4, 5, 6], "spacing": [1, 2, 3], "origin": [0, 0, -1], "type": "uint16"}}})");
  const Scene scene = value_of(read_scene(folder / "s.json"));
  const auto& a = source_of(scene, "a").file;
  EXPECT_EQ(a->path, folder / "a.vdb");
  EXPECT_EQ(a->grid, "density");
  EXPECT_FALSE(a->mask_grid.has_value());
  EXPECT_TRUE(source_of(scene, "c").file->mask_required);
  const auto& raw = source_of(scene, "b").file->raw;
  ASSERT_TRUE(raw.has_value());
  EXPECT_EQ(raw->shape, (field::Index3{4, 5, 6}));
  EXPECT_EQ(raw->spacing, Vec3(1, 2, 3));
  EXPECT_EQ(raw->type, "uint16");

  for (const auto& [keys, part] : {std::pair{R"("b.raw")", "key \"shape\" is missing"},
                                   {R"("b.raw", "shape": [1, 5, 6])", "from 2 to 65536 were expected"},
                                   {R"("b.raw", "shape": [4, 5, 6], "spacing": [1, 0, 1])", "> 0 were expected"},
                                   {R"("b.raw", "shape": [4, 5, 6], "type": "f32")", "float64"},
                                   {R"("a.vdb", "shape": [4, 5, 6])", "unknown key \"shape\""},
                                   {R"("a.vdb", "valid": 3)", "name of a BoolGrid"},
                                   {R"("a.vdb", "axes": "xyz")", "is given for a file that is not a NumPy array"},
                                   {R"("a.npy", "axes": "xzy")", "\"zyx\" or \"xyz\""}}) {
    test::write_file(folder / "bad.json", "{\"fields\": {\n\"a\": {\"file\": " + std::string(keys) + "}}}");
    expect_error(read_scene(folder / "bad.json"), folder / "bad.json:2: ", {part});
  }
}

TEST(SceneFile, UnreadableScenesAreRefused) {
  const test::TemporaryFolder folder;
  for (const std::string& path : {folder / "none.json", folder.path()}) expect_error(read_scene(path), path + ": ", {"expected"});
}

TEST(SceneFile, ReadsOverrides) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "new.vdb", "x");
  const std::string text = "{\"fields\": {\"a\": {\"file\": \"missing.vdb\", \"grid\": \"density\"}}}";
  const Scene scene = value_of(parse_scene(text, "scene.json", {{"a", folder / "new.vdb", ""}, {"b", folder / "new.vdb", "speed"}}));
  const FieldSource& a = source_of(scene, "a");
  EXPECT_EQ(a.file->path, folder / "new.vdb");
  EXPECT_EQ(a.file->grid, "density");
  EXPECT_TRUE(a.grid_is_optional);
  EXPECT_EQ(source_of(scene, "b").file->grid, "speed");
  EXPECT_EQ(message_of(parse_scene("{}", "scene.json", {{"a", "gone.vdb", ""}})),
            "--field a=gone.vdb: file \"gone.vdb\" does not exist; a data file (.vdb, .nii, .vti, .vtu, .nrrd, .npy, ..; catena info "
            "--formats lists all) was expected");
  expect_error(parse_scene("{}", "scene.json", {{"A", "gone.vdb", ""}}), "", {"[a-z][a-z0-9_]*"});
}

TEST(SceneFile, ChecksChains) {
  const auto link = [](const std::string& body) { return with("\"chain\": [\n{" + body + "}]"); };
  refused(link("\"type\": \"point\""), 3, {"\"name\" is missing", "expected"});
  refused(link("\"name\": \"a\""), 3, {"\"type\" is missing", "expected"});
  refused(link("\"name\": \"A\", \"type\": \"point\""), 3, {"\"A\"", "[a-z][a-z0-9_]*"});
  refused(link("\"name\": \"9a\", \"type\": \"point\""), 3, {"\"9a\"", "expected"});
  for (const char* taken : {"t", "probe", "force"})
    refused(link("\"name\": \"" + std::string(taken) + "\", \"type\": \"point\""), 3, {taken, "taken", "expected"});
  refused(link("\"name\": \"a\", \"type\": \"isosurface\", \"field\": \"bal\""), 3,
          {"unknown field \"bal\"", "known: swirl, ball", "did you mean \"ball\"?"});
  refused(with("\"chain\": [{\"name\": \"a\", \"type\": \"point\"},\n{\"name\": \"a\", \"type\": \"point\"}]"), 3,
          {"duplicate link name \"a\"", "expected"});
  std::string many;
  for (int i = 0; i < 9; ++i) many += std::string(i == 0 ? "" : ",") + "\n{\"name\": \"l" + std::to_string(i) + "\", \"type\": \"point\"}";
  refused(with("\"chain\": [" + many + "]"), 11, {"has 9 links", "at most 8 were expected"});
  refused(with("\"chain\": {}"), 2, {"array of links was expected"});
  refused(with("\"chain\": [3]"), 2, {"object"});
}

TEST(SceneFile, ReadsCoupling) {
  for (const char* key : {"stiffness", "damping", "max_force", "ramp_s"}) {
    refused(with("\"coupling\": {\n\"" + std::string(key) + "\": -1}"), 3, {key, "is -1", ">= 0 was expected"});
    refused(with("\"coupling\": {\n\"" + std::string(key) + "\": 1e999}"), 3, {"finite number was expected"});
    refused(with("\"coupling\": {\n\"" + std::string(key) + "\": \"soft\"}"), 3, {key, "finite number >= 0 was expected"});
    parsed(with("\"coupling\": {\"" + std::string(key) + "\": 0}"));
  }
}

TEST(SceneFile, ReadsWorkspaces) {
  refused(with("\"workspace\": {\"metres_per_unit\": 0}"), 2, {"metres_per_unit", "> 0 was expected"});
  refused(with("\"workspace\": {\"rotation\": [[1, 0, 0], [0, 2, 0], [0, 0, 1]]}"), 2, {"no rotation", "expected"});
  refused(with("\"workspace\": {\"rotation\": [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}"), 2, {"no rotation", "expected"});
  refused(with("\"workspace\": {\"rotation\": [1, 0, 0]}"), 2, {"three finite numbers"});
  refused(with("\"workspace\": {\"rotation\": {\"axis\": [0, 0, 0], \"angle_deg\": 3}}"), 2, {"\"axis\" is zero", "expected"});
  const Workspace workspace = parsed(with("\"workspace\": {\"rotation\": [0, -1, 0, 1, 0, 0, 0, 0, 1]}")).workspace;
  EXPECT_EQ(workspace.rotation * Vec3(1, 0, 0), Vec3(0, 1, 0));
  EXPECT_FALSE(workspace.is_explicit);
}

TEST(SceneFile, ChecksTransferFunctions) {
  const auto volume = [](const std::string& body) { return with("\"volumes\": [{\"field\": \"ball\",\n" + body + "}]"); };
  refused(volume("\"color\": [[0, 0, 0, 0],\n[0, 1, 1, 1]]"), 4, {"\"color\"", "strictly rising values were expected"});
  refused(volume("\"color\": [[0, 0, 0, 1.5]]"), 3, {"1.5", "from 0 to 1 were expected"});
  refused(volume("\"color\": [[0, 0, 0]]"), 3, {"rows of 4 finite numbers were expected"});
  refused(volume("\"color\": []"), 3, {"is empty", "expected"});
  refused(volume("\"opacity\": [[0, 0], [1, 1.1]]"), 3, {"\"opacity\" holds 1.1", "0 <= a <= 1 was expected"});
  refused(volume("\"opacity\": [[0, -0.1]]"), 3, {"0 <= a <= 1 was expected"});
  const auto opaque = only<Volume>(parsed(volume("\"opacity\": [[0, 0], [1, 1]]")));
  EXPECT_EQ(opaque.transfer.opacities.back().alpha, TransferFunction::OpacityPoint::kMaxAlpha);
  refused(volume("\"opacity\": [[1, 0], [0, 0]]"), 3, {"strictly rising values were expected"});
  refused(volume("\"opacity\": [[1, 0]], \"opacity_unit\": 0"), 3, {"\"opacity_unit\" is 0", "> 0 was expected"});
  refused(volume("\"opacity_unit\": 1"), 3, {"expected"});
  refused(volume("\"extinction\": [[0, -1]]"), 3, {"sigma >= 0 was expected"});
  refused(volume("\"extinction\": [[0, 1]], \"opacity\": [[0, 0.5]]"), 3, {"both", "one of them was expected"});
  refused(volume("\"shade\": 1"), 3, {"true or false was expected"});
  refused(with("\"volumes\": [{\"field\": \"bal\"}]"), 2, {"unknown field \"bal\"", "known: swirl, ball"});
  refused(with("\"volumes\": [{}]"), 2, {"\"field\" is missing"});
  refused(with("\"volumes\": {}"), 2, {"array of objects was expected"});
}

TEST(SceneFile, ChecksIsosurfacesAndStreamlines) {
  refused(with("\"isosurfaces\": [{\"field\": \"ball\"}]"), 2, {"\"level\" is missing", "expected"});
  refused(with("\"isosurfaces\": [{\"field\": \"ball\", \"level\": 1e999}]"), 2, {"finite number was expected"});
  refused(with("\"isosurfaces\": [{\"field\": \"ball\", \"level\": 1, \"opacity\": 1.5}]"), 2, {"from 0 to 1 was expected"});
  refused(with("\"isosurfaces\": [{\"field\": \"ball\", \"level\": 1, \"color\": [0, 2, 0]}]"), 2, {"from 0 to 1 were expected"});
  const auto lines = [](const std::string& body) { return with("\"streamlines\": [{\"field\": \"swirl\",\n" + body + "}]"); };
  refused(lines("\"seeds\": [[1, 0, 0],\n[1, 2]]"), 4, {"array of 2", "three finite numbers [x, y, z] was expected"});
  refused(lines("\"seeds\": [[1, 0, 0],\n[1, NaN, 2]]"), 4, {"expected"});
  refused(lines("\"seeds\": [[1, 0, null]]"), 3, {"null", "three finite numbers"});
  refused(lines("\"seeds\": []"), 3, {"empty", "at least one seed"});
  refused(lines("\"radius\": 1"), 2, {"\"seeds\" is missing", "at least one seed"});
  refused(lines("\"seeds\": [[1, 0, 0]], \"radius\": 0"), 3, {"\"radius\" is 0", "> 0 was expected"});
  refused(lines("\"seeds\": [[1, 0, 0]], \"length\": -1"), 3, {"\"length\" is -1", "> 0 was expected"});
  refused(lines("\"seeds\": [[1, 0, 0]], \"min_speed\": -1"), 3, {"\"min_speed\" is -1", ">= 0 was expected"});
  refused(lines("\"seeds\": [[1, 0, 0]], \"kind\": \"lines\""), 3, {"vector, line"});
}

TEST(SceneFile, ReadsCamerasAndBackgrounds) {
  const auto camera = [](const std::string& body) { return with("\"camera\": {\"position\": [0, 0, 5],\n" + body + "}"); };
  refused(with("\"camera\": {\"fovy_deg\": 30}"), 2, {"\"position\" is missing"});
  refused(camera("\"target\": [0, 0, 5]"), 3, {"\"target\"", "two different points were expected"});
  refused(camera("\"target\": [0, 0, 0], \"up\": [0, 0, 2]"), 3, {"parallel", "expected"});
  refused(camera("\"target\": [0, 0, 0], \"up\": [0, 0, 0]"), 3, {"\"up\" is zero", "expected"});
  for (const char* fovy : {"0", "-30", "180", "200", "1e-10", "179.9999999", "1e30"})
    refused(camera("\"target\": [0, 0, 0], \"fovy_deg\": " + std::string(fovy)), 3, {"fovy_deg", "expected"});
  refused(camera("\"target\": [0, 0, 0], \"projection\": \"ortho\""), 3, {"perspective, orthographic"});
  refused(camera("\"target\": [0, 0, 0], \"projection\": \"orthographic\""), 2, {"\"height\" is missing"});
  refused(camera("\"target\": [0, 0, 0], \"height\": 2"), 3, {"orthographic", "expected"});
  EXPECT_GT(norm(cross(parsed(camera("\"target\": [0, 0, 0]")).camera.up, Vec3(0, 0, 1))), 0.5);
  refused(with("\"background\": [0, 0, 2]"), 2, {"transparent", "expected"});
  refused(with("\"background\": \"black\""), 2, {"transparent", "expected"});
  EXPECT_TRUE(parse_scene("{\"background\": \"transparent\"}", "f")->background.transparent);
  refused(with("\"quality\": \"best\""), 2, {"draft, balanced, reference, time=MS, error=E or step=VOXELS"});
  refused(with("\"quality\": \"time=-3\""), 2, {"expected"});
  refused(with("\"cursor\": {\"probe\": [1, 2]}"), 2, {"three finite numbers"});
  refused(with("\"cursor\": {\"size\": 0}"), 2, {"> 0 was expected"});
}

TEST(SceneFile, CamerasThatSeeNothingAreRefused) {
  const auto camera = [](const std::string& keys) { return with("\"camera\": {" + keys + "}"); };
  refused(camera("\"position\": [1e30, 0, 0], \"target\": [0, 0, 0]"), 2, {"too far away", "1e+15"});
  refused(camera("\"position\": [1, 0, 0], \"target\": [0, -1e20, 0]"), 2, {"too far away"});
  refused(camera("\"position\": [6, 0, 0], \"target\": [6.0000000000001, 0, 0]"), 2, {"two different points"});
  refused(camera("\"position\": [6, 0, 0], \"target\": [0, 0, NaN]"), 2, {"not valid JSON"});
  refused(camera("\"position\": [6, 0, 0], \"target\": [0, 0, 1e999]"), 2, {"finite number"});
  for (const char* height : {"0", "-1", "1e-20", "1e20"})
    refused(camera(R"("position": [6, 0, 0], "target": [0, 0, 0], "projection": "orthographic", "height": )" + std::string(height)), 2,
            {"height"});
}

TEST(SceneFile, NumbersOutOfRangeAreRefused) {
  refused(with("\"coupling\": {\"stiffness\": 1e308}"), 2, {"1e+308 is too large", "1e-30 to 1e30"});
  refused(with("\"stereo\": {\"mode\": \"side-by-side\", \"separation\": 1e308}"), 2, {"too large"});
  refused(with("\"isosurfaces\": [{\"field\": \"ball\",\n \"level\": -1e31}]"), 3, {"-1e+31 is too large"});
  refused(with("\"workspace\": {\"metres_per_unit\": 1e-320}"), 2, {"is too small"});
  parsed(with("\"isosurfaces\": [{\"field\": \"ball\", \"level\": 1e29}, {\"field\": \"ball\", \"level\": 0}]"));
}

}  // namespace catena::scene::scene_file_test
