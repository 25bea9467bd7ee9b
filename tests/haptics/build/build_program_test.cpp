// SPDX-License-Identifier: MIT
#include "engine/io/volume/load_field.h"
#include "tests/haptics/build/build_fixture.h"

namespace catena::haptics::build_program_test {

using build_tests::expect_error;
using build_tests::expect_message;
using build_tests::program_of;
using build_tests::scene_of;

/// A scene with a point link on line 2 and its additional keys `more` on line 3.
std::string point_with(const std::string& more) {
  return "{\"chain\": [\n{\"name\": \"a\", \"type\": \"point\", \"position\": [0, 0, 0],\n" + more + "}]}";
}

TEST(ExtractProgram, AnEmptyChainGivesAProgram) {
  const auto program = program_of("{\"fields\": {}, \"chain\": []}");
  EXPECT_TRUE(program->links.empty());
  EXPECT_EQ(program->meters_per_unit, 1);
}

/// 12^3 voxels in a raw file: label 7 for x < 5, else 0.
std::string label_map(const test::TemporaryFolder& folder) {
  std::string bytes;
  for (int n = 0; n < 12 * 12 * 12; ++n) bytes += static_cast<char>(n % 12 < 5 ? 7 : 0);
  test::write_file(folder / "m.raw", bytes);
  return R"({"fields": {"m": {"file": "m.raw", "shape": [12, 12, 12], "type": "uint8", "labels": {"values": [7], "names": ["Cuneus"]}},
    "a": {"label": 7, "of": "m", "smooth": 0}}, "chain": [)";
}

TEST(ExtractProgram, ALabelLinkUsesTheDrawnGridAndTheLabelsName) {
  const test::TemporaryFolder folder;
  scene::Scene scene = scene_of(label_map(folder) + R"({"name": "l", "type": "isosurface", "field": "a", "level": 0.5, "free": "below"}]})",
                                folder / "s.json");
  const auto program = program_of(scene);
  EXPECT_EQ(program->links[0].feature_name, "Cuneus");
  const auto drawn = scene::resolve_rendered_field(scene, scene::find_field(scene, "a"), {});
  ASSERT_TRUE(drawn);
  EXPECT_EQ(drawn->get(), scene::loaded_field(scene, scene::find_field(scene, "a")).get());
  // the proxy of a probe within the label lies halfway between the voxel centres
  test::ChainDriver hand(*program);
  for (int k = 0; k < 50; ++k) hand.step(Vec3(k < 25 ? 8 - 0.2 * k : 3, 6.2, 5.7));
  EXPECT_NEAR(hand.link().proxy.x, 4.5, 1e-9);
}

TEST(ExtractProgram, ALabelMapAsALevelFieldIsRefused) {
  const test::TemporaryFolder folder;
  for (const char* link : {R"({"name": "l", "type": "isosurface", "field": "m", "level": 3})",
                           R"({"name": "l", "type": "drag", "surface": "m", "level": 3, "threshold": 1})"}) {
    scene::Scene scene = scene_of(label_map(folder) + link + "]}", folder / "s.json");
    const auto program = build_program(scene);
    ASSERT_FALSE(program);
    EXPECT_NE(program.error().message.find("a field {\"label\": NUMBER, \"of\": \"m\"} at level 0.5"), std::string::npos)
        << program.error().message;
    EXPECT_EQ(program.error().message.find('\n'), std::string::npos);
  }
}

TEST(ExtractProgram, ABaselineTakesReleaseFromTheConstraint) {
  const std::string link =
      R"({"chain": [{"name": "a", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "free": "above", "release": 0.25}],
    "coupling": {"method": ")";
  const char* words[] = {"chain", "pipe", "balance", "closest", "linear"};
  std::uint64_t recipes[5] = {};
  for (int i = 0; i < 5; ++i) {
    const auto program = program_of(link + words[i] + "\"}}");
    EXPECT_EQ(program->coupling.method, static_cast<CouplingMethod>(i));
    EXPECT_EQ(program->links[0].release, i == 0 ? 0 : 0.25);
    EXPECT_TRUE(program->links[0].one_sided);  // set for every method
    recipes[i] = program->links[0].spec_hash;
    for (int k = 0; k < i; ++k) EXPECT_NE(recipes[i], recipes[k]);
  }
}

TEST(ExtractProgram, TheLinearBaselineFollowsTheFieldAtTheProxy) {
  const auto program = program_of(R"({"fields": {"v": {"analytic": "saddle"}}, "coupling": {"method": "linear"},
    "chain": [{"name": "a", "type": "streamline", "field": "v", "seed": [1, 1, 0]}]})");
  const Constraint& streamline = *program->links[0].constraint;
  LinkState state;
  LinkScratch scratch;
  streamline.start({1, 1, 0}, state, scratch);
  state.proxy = {1, 0.5, 0};  // off the curve: the tangent is the field there, (x, -y)
  Primitive line;
  ASSERT_TRUE(streamline.primitive(state.proxy, state, scratch, line));
  EXPECT_LE(norm(line.axis - direction(Vec3(1, -0.5, 0))), 1e-15);
}

TEST(ExtractProgram, RefusesWhatABaselineDoesNotSupport) {
  const std::string map = "\"release\": {\"field\": \"s\", \"map\": [[0, 1]]}";
  expect_error(
      "{\"fields\": {\"s\": {\"analytic\": \"sphere\"}}, \"coupling\": {\"method\": \"pipe\"}, \"chain\": [\n"
      "{\"name\": \"a\", \"type\": \"point\", \"position\": [0, 0, 0],\n" +
          map + "}]}",
      3, {"release", "a number was expected"});
  expect_error(
      "{\"fields\": {\"v\": {\"analytic\": \"circle\"}}, \"coupling\": {\"method\": \"pipe\"}, \"chain\": [\n"
      "{\"name\": \"a\", \"type\": \"streamline\", \"field\": \"v\",\n\"release\": 0}]}",
      3, {"release"});
  expect_error(
      "{\"coupling\": {\"method\": \"pipe\"}, \"chain\": [\n"
      "{\"name\": \"a\", \"type\": \"point\", \"position\": [0, 0, 0],\n\"release\": 0}]}",
      3, {"release", "> 0"});
  const auto scene = scene::parse_scene("{\"coupling\":\n{\"method\": \"pipes\"}}", "scene.json");
  ASSERT_FALSE(scene);
  expect_message(scene.error(), 2, {});
}

TEST(ExtractProgram, CopiesCouplingSwitchesAndOrder) {
  const auto program = program_of(R"({"coupling": {"stiffness": 300, "damping": 2, "max_force": 5, "ramp_s": 0.5},
    "workspace": {"metres_per_unit": 0.01, "origin": [1, 2, 3]},
    "chain": [{"name": "b", "type": "point", "position": [0, 0, 1], "active_when": {"button": 2}},
              {"name": "a", "type": "point", "position": [0, 0, 0], "stiffness": 0, "active_when": {"force_above": 1.5}},
              {"name": "c", "type": "point", "position": [0, 0, 0], "stiffness": 70}]})");
  EXPECT_EQ(program->coupling.stiffness_n_per_m, 300);
  EXPECT_EQ(program->coupling.damping_ns_per_m, 2);
  EXPECT_EQ(program->coupling.max_force_n, 5);
  EXPECT_EQ(program->coupling.ramp_s, 0.5);
  EXPECT_EQ(program->meters_per_unit, 0.01);
  EXPECT_EQ(program->workspace_origin, Vec3(1, 2, 3));
  ASSERT_EQ(program->links.size(), 3u);
  EXPECT_EQ(program->links[0].name, "b");
  EXPECT_EQ(program->links[0].active_when.button, 2);
  EXPECT_EQ(program->links[0].stiffness_n_per_m.min(), 300);
  EXPECT_EQ(program->links[1].stiffness_n_per_m.min(), 0);
  EXPECT_EQ(program->links[1].active_when.force_above_n, 1.5);
  EXPECT_EQ(program->links[2].stiffness_n_per_m.min(), 70);
  EXPECT_NE(program->links[0].constraint, nullptr);
}

TEST(ExtractProgram, EpochsRise) {
  scene::Scene scene = scene_of("{}");
  const auto first = build_program(scene), second = build_program(scene);
  EXPECT_GT((*first)->epoch, 0u);
  EXPECT_GT((*second)->epoch, (*first)->epoch);
}

TEST(ExtractProgram, LoadsOnlyTheFieldsThatLinksName) {
  const test::TemporaryFolder folder;
  const auto ball = *field::make_analytic("sphere");
  const field::AnyField grid{field::sample_on_grid(*ball.scalar, 17, -2, 2), nullptr};
  ASSERT_TRUE(field::write_vdb(folder / "a.vdb", {{grid, "one"}, {grid, "two"}}));
  scene::Scene scene = scene_of(R"({"fields": {"one": {"file": "a.vdb", "grid": "one"}, "two": {"file": "a.vdb", "grid": "two"}},
    "volumes": [{"field": "two"}], "chain": [{"name": "s", "type": "isosurface", "field": "one", "level": 1}]})",
                                folder / "s.json");
  const auto before = field::load_counters();
  program_of(scene);
  EXPECT_EQ(field::load_counters().grids, before.grids + 1);
}

TEST(ExtractProgram, ASelectedLinkSharesTheDrawnCurve) {
  scene::Scene scene = scene_of(R"({"fields": {"swirl": {"analytic": "circle"}},
    "chain": [{"name": "s", "type": "streamline", "field": "swirl", "seed": [1, 0, 0]}]})");
  program_of(scene);
  EXPECT_EQ(scene.traced_curves.size(), 1u);
  const auto any = scene::resolve_field(scene, "swirl", {});
  ASSERT_TRUE(any);
  ASSERT_TRUE(scene::resolve_streamline(scene, {any->vector.get(), false, 0}, {1, 0, 0}, {}));
  EXPECT_EQ(scene.traced_curves.size(), 1u);
}

TEST(ExtractProgram, AMeshLinkSharesTheDrawnMesh) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quad.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n");
  scene::Scene scene = scene_of(R"({"meshes": [{"name": "floor", "file": "quad.obj", "scale": 2}],
    "chain": [{"name": "a", "type": "mesh", "mesh": "floor", "free": "above"}]})",
                                folder / "s.json");
  const auto program = program_of(scene);
  EXPECT_EQ(program->links[0].constraint->domain_length(), 4);
  EXPECT_EQ(program->links[0].spec_hash, program_of(scene)->links[0].spec_hash);
  expect_error("{\"chain\": [\n{\"name\": \"a\", \"type\": \"mesh\",\n\"mesh\": \"skull\"}]}", 3,
               {"unknown mesh \"skull\"", "it has none"});
}

TEST(ExtractProgram, CommonKeysAreChecked) {
  expect_error(point_with("\"stiffness\": -1"), 3, {"\"stiffness\" is -1", ">= 0 was expected"});
  expect_error(point_with("\"stiffness\": \"x\""), 3, {"\"stiffness\"", "finite number"});
  expect_error(point_with("\"active_when\": {}"), 3, {"neither", "expected"});
  expect_error(point_with("\"active_when\": true"), 3, {"\"active_when\"", "object", "expected"});
  expect_error(point_with("\"active_when\": {\"button\": 1, \"force_above\": 1}"), 3, {"both", "expected"});
  for (const char* bad : {"0", "33", "1.5", "\"a\""})
    expect_error(point_with("\"active_when\": {\"button\": " + std::string(bad) + "}"), 3, {"from 1 to 32"});
  for (const char* bad : {"0", "-1", "null"})
    expect_error(point_with("\"active_when\": {\"force_above\": " + std::string(bad) + "}"), 3, {"> 0 was expected"});
  expect_error(point_with("\"active_when\": {\"buton\": 1}"), 3, {"unknown key \"buton\"", "did you mean \"button\"?"});
}

TEST(ExtractProgram, ReadsSwitches) {
  const auto program = program_of(R"({"chain": [
    {"name": "a", "type": "point", "position": [0, 0, 0], "active_when": {"button": 3, "toggle": true}},
    {"name": "b", "type": "point", "position": [0, 0, 0], "active_when": {"force_above": 2, "force_below": 0.5}},
    {"name": "c", "type": "point", "position": [0, 0, 0], "active_when": {"force_above": 2}},
    {"name": "d", "type": "point", "position": [0, 0, 0]}]})");
  const std::vector<Link>& links = program->links;
  EXPECT_EQ(links[0].active_when.button, 3);
  EXPECT_TRUE(links[0].active_when.toggle);
  EXPECT_EQ(links[1].active_when.force_above_n, 2);
  EXPECT_EQ(links[1].active_when.force_below_n, 0.5);
  EXPECT_EQ(links[2].active_when.force_below_n, 2);
  EXPECT_EQ(links[3].active_when.button, 0);
  EXPECT_EQ(links[3].active_when.force_above_n, 0);
}

TEST(ExtractProgram, SwitchErrorsNameTheirLine) {
  const auto bad = [](const std::string& keys, int line, std::initializer_list<const char*> parts) {
    expect_error(point_with("\"active_when\": {" + keys + "}"), line, parts);
  };
  bad("\"force_above\": 1,\n\"force_below\": 2", 4, {"\"force_below\" is above", "expected"});
  bad("\"force_above\": 1,\n\"force_below\": -2", 4, {"\"force_below\" is -2", ">= 0"});
  bad("\"button\": 1,\n\"force_below\": 2", 4, {"\"force_below\" belongs to \"force_above\"", "was expected"});
  bad("\"force_above\": 1,\n\"toggle\": true", 4, {"\"toggle\" belongs to \"button\"", "was expected"});
  bad("\"button\": 1,\n\"toggle\": 1", 4, {"toggle"});
  bad("\"toggle\": true", 3, {"neither"});
}

TEST(ExtractProgram, ReadsIndications) {
  const auto program = program_of(R"({"chain": [
    {"name": "a", "type": "point", "position": [0, 0, 0], "release_cue": {"type": "detent", "distance": 0.2, "amplitude": 0.7, "duration": 0.03}},
    {"name": "b", "type": "point", "position": [0, 0, 0], "release_cue": {"type": "vibration", "onset": 0.5, "frequency": 80}},
    {"name": "c", "type": "point", "position": [0, 0, 0], "release_cue": {}},
    {"name": "d", "type": "point", "position": [0, 0, 0]}]})");
  const std::vector<Link>& links = program->links;
  EXPECT_EQ(links[0].release_cue.type, ReleaseCue::Type::detent);
  EXPECT_EQ(links[0].release_cue.distance, 0.2);
  EXPECT_EQ(links[0].release_cue.amplitude_n, 0.7);
  EXPECT_EQ(links[0].release_cue.duration_s, 0.03);
  EXPECT_EQ(links[1].release_cue.type, ReleaseCue::Type::vibration);
  EXPECT_EQ(links[1].release_cue.onset, 0.5);
  EXPECT_EQ(links[1].release_cue.frequency_hz, 80);
  EXPECT_EQ(links[2].release_cue.type, ReleaseCue::Type::none);
  EXPECT_EQ(links[3].release_cue.type, ReleaseCue::Type::none);
}

TEST(ExtractProgram, IndicationErrorsNameTheirLine) {
  const auto bad = [](const std::string& keys, std::initializer_list<const char*> parts) {
    expect_error(point_with("\"release_cue\": {\n" + keys + "}"), 4, parts);
  };
  bad("\"type\": \"bell\"", {"type", "detent", "vibration"});
  bad("\"distance\": 0", {"\"distance\" is 0", "> 0"});
  bad("\"onset\": -0.1", {"\"onset\" is -0.1"});
  bad("\"onset\": 1.5", {"\"onset\" is 1.5", "0 to 1"});
  bad("\"amplitude\": -1", {"\"amplitude\" is -1", ">= 0"});
  bad("\"frequency\": 0", {"\"frequency\" is 0", "> 0"});
  bad("\"duration\": 0", {"\"duration\" is 0", "> 0"});
  bad("\"kue\": 1", {"unknown key \"kue\"", "cue"});
  expect_error(point_with("\"release_cue\": true"), 3, {"release_cue", "object"});
}

/// A scene with two links on lines 2 and 3, and `modes` from line 4.
std::string with_modes(const std::string& modes) {
  return "{\"chain\": [\n{\"name\": \"a\", \"type\": \"point\", \"position\": [0, 0, 0]},\n"
         "{\"name\": \"b\", \"type\": \"point\", \"position\": [0, 0, 1]}], \"modes\": [\n" +
         modes + "]}";
}

TEST(ExtractProgram, ReadsModesInOrder) {
  const auto program = program_of(with_modes(R"({"name": "m", "links": ["b", "a"], "active_when": {"button": 1, "toggle": true}},
      {"name": "n", "links": [], "active_when": {"force_above": 3}})"));
  const std::vector<Mode>& modes = program->modes;
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_EQ(modes[0].name, "m");
  EXPECT_EQ(modes[0].links, (std::vector<int>{1, 0}));
  EXPECT_EQ(modes[0].active_when.button, 1);
  EXPECT_TRUE(modes[0].active_when.toggle);
  EXPECT_TRUE(modes[1].links.empty());
  EXPECT_EQ(modes[1].active_when.force_above_n, 3);
}

TEST(ExtractProgram, ModeErrorsNameTheirLine) {
  expect_error(with_modes("{\"name\": \"m\", \"links\": [\"a\",\n\"z\"], \"active_when\": {\"button\": 1}}"), 5,
               {"\"m\"", "\"z\"", "not a link", "one of a, b was expected"});
  expect_error(with_modes("{\"name\": \"m\", \"links\": [\"a\",\n\"a\"], \"active_when\": {\"button\": 1}}"), 5,
               {"\"a\" twice", "one mention of each link was expected"});
  expect_error(with_modes("{\"name\": \"m\", \"links\": [\"a\"],\n\"active_when\": {}}"), 5, {"neither"});
  expect_error(with_modes("{\"name\": \"m\", \"links\": [\"a\"],\n\"active_when\": {\"button\": 40}}"), 5, {"from 1 to 32"});
  std::string nine;
  for (int i = 0; i < 9; ++i)
    nine += std::string(i ? ",\n" : "") + "{\"name\": \"m" + std::to_string(i) + "\", \"links\": [], \"active_when\": {\"button\": 1}}";
  expect_error(with_modes(nine), 12, {"too many modes", "8"});
}

TEST(ExtractProgram, AModesKeysAreCheckedWhenTheSceneIsParsed) {
  const auto fails = [](const std::string& mode, std::initializer_list<const char*> parts) {
    const auto scene = scene::parse_scene(with_modes(mode), "scene.json");
    ASSERT_FALSE(scene) << mode;
    expect_message(scene.error(), 4, parts);
  };
  fails(R"({"name": "m", "active_when": {"button": 1}})", {"links"});
  fails(R"({"name": "m", "links": "a", "active_when": {"button": 1}})", {"links"});
  fails(R"({"name": "m", "links": [1], "active_when": {"button": 1}})", {"links"});
  fails(R"({"name": "m", "links": ["a"]})", {"\"active_when\""});
  fails(R"({"links": ["a"], "active_when": {"button": 1}})", {"name"});
  fails(R"({"name": "m", "links": [], "active_when": {"button": 1}, "off": 1})", {"unknown key \"off\""});
  fails(R"({"name": "m", "links": [], "active_when": {"button": 1}}, {"name": "m", "links": [], "active_when": {"button": 1}})",
        {"duplicate mode name"});
  fails("3", {"object"});
}

TEST(ExtractProgram, AStiffnessFollowsAField) {
  const auto program =
      program_of(R"({"fields": {"z": {"analytic": "plane"}}, "chain": [{"name": "a", "type": "point", "position": [0, 0, 0],
    "stiffness": {"field": "z", "map": [[0, 100], [1, 300]], "outside": 50}}]})");
  EXPECT_EQ(program->links[0].stiffness_n_per_m.min(), 50);
  EXPECT_EQ(program->links[0].stiffness_n_per_m.max(), 300);
  expect_error(point_with("\"stiffness\": {\"field\": \"z\",\n\"map\": [[0, 1]]}"), 3, {"z"});
  expect_error(
      "{\"fields\": {\"z\": {\"analytic\": \"plane\"}}, \"chain\": [{\"name\": \"a\", \"type\": \"point\", \"position\": [0, 0, 0],\n"
      "\"stiffness\": {\"field\": \"z\",\n\"map\": [[0, -1]]}}]}",
      3, {"\"stiffness\" is -1", ">= 0"});
}

TEST(ExtractProgram, TheSpecHashDependsOnTheLinksKeys) {
  const auto recipes = [](const std::string& more) { return program_of(point_with(more))->links[0].spec_hash; };
  EXPECT_EQ(recipes("\"release\": 1"), recipes("\"release\": 1"));
  EXPECT_NE(recipes("\"release\": 1"), recipes("\"release\": 2"));
  EXPECT_NE(recipes("\"release\": 1"), recipes("\"snap\": 1"));
  EXPECT_NE(recipes("\"release\": 1"), 0u);
}

TEST(ExtractProgram, ADisabledLinkIsOffAndKeepsItsSpecHash) {
  const auto a = program_of(point_with("\"stiffness\": 300")), b = program_of(point_with("\"stiffness\": 300, \"enabled\": false")),
             c = program_of(point_with("\"stiffness\": 300, \"enabled\": true"));
  EXPECT_FALSE(a->links[0].active_when.disabled);
  EXPECT_TRUE(b->links[0].active_when.disabled);
  EXPECT_FALSE(c->links[0].active_when.disabled);
  EXPECT_EQ(a->links[0].spec_hash, b->links[0].spec_hash) << "it keeps its state";
  EXPECT_EQ(a->links[0].spec_hash, c->links[0].spec_hash);
  expect_error(point_with("\"enabled\": 1"), 3, {"enabled", "true or false"});

  // all links of a preset
  const auto parts = program_of(R"({"fields": {"b": {"analytic": "sphere"}, "c": {"analytic": "circle"}}, "chain": [
    {"name": "s", "type": "anisotropic_friction", "surface": "b", "level": 1, "field": "c", "enabled": false}]})");
  ASSERT_EQ(parts->links.size(), 3u);
  for (const Link& link : parts->links) EXPECT_TRUE(link.active_when.disabled) << link.name;
}

TEST(ExtractProgram, LinkErrorsNameTheirLine) {
  expect_error("{\"chain\": [\n{\"name\": \"a\", \"type\": \"pont\"}]}", 2, {"\"pont\"", "point", "expected"});
  expect_error(point_with("\"levle\": 3"), 3, {"unknown key \"levle\""});
  expect_error(point_with("\"release\": -1"), 3, {"release", "expected"});
  expect_error(
      "{\"fields\": {\"ball\": {\"analytic\": \"sphere\"}}, \"chain\": [\n{\"name\": \"a\", \"type\": \"isosurface\", \"field\": "
      "\"ball\",\n\"level\": -5}]}",
      3, {"level", "expected"});
}

}  // namespace catena::haptics::build_program_test
