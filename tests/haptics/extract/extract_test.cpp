#include "haptics/extract/extract.h"

#include <gtest/gtest.h>

#include "engine/field/load.h"
#include "tests/support/support.h"

namespace catena::haptics {
namespace {

scene::Scene scene_of(const std::string& text, const std::string& path = "scene.json") {
  auto scene = scene::parse_scene(text, path);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? std::move(*scene) : scene::Scene{};
}

/// A point link on line 2 with `more` of its keys on line 3.
std::string point_with(const std::string& more) {
  return "{\"chain\": [\n{\"name\": \"a\", \"type\": \"point\", \"position\": [0, 0, 0],\n" + more + "}]}";
}

void expect_error(const std::string& text, int line, std::initializer_list<const char*> parts) {
  scene::Scene scene = scene_of(text);
  const auto program = extract_program(scene);
  ASSERT_FALSE(program) << text;
  const std::string& message = program.error().message;
  EXPECT_TRUE(message.starts_with("scene.json:" + std::to_string(line) + ": ")) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
}

TEST(ExtractProgram, AnEmptyChainIsAProgram) {
  scene::Scene scene = scene_of("{\"fields\": {}, \"chain\": []}");
  const auto program = extract_program(scene);
  ASSERT_TRUE(program);
  EXPECT_TRUE((*program)->links.empty());
  EXPECT_EQ((*program)->metres_per_unit, 1);
}

TEST(ExtractProgram, CopiesCouplingSwitchesAndOrder) {
  scene::Scene scene = scene_of(R"({"coupling": {"stiffness": 300, "damping": 2, "max_force": 5, "ramp_s": 0.5},
    "workspace": {"metres_per_unit": 0.01, "origin": [1, 2, 3]},
    "chain": [{"name": "b", "type": "point", "position": [0, 0, 1], "on": {"button": 2}},
              {"name": "a", "type": "point", "position": [0, 0, 0], "stiffness": 0, "on": {"force_above": 1.5}},
              {"name": "c", "type": "point", "position": [0, 0, 0], "stiffness": 70}]})");
  const auto result = extract_program(scene);
  ASSERT_TRUE(result) << result.error().message;
  const Program& program = **result;
  EXPECT_EQ(program.coupling.stiffness_n_per_m, 300);
  EXPECT_EQ(program.coupling.damping_ns_per_m, 2);
  EXPECT_EQ(program.coupling.max_force_n, 5);
  EXPECT_EQ(program.coupling.ramp_s, 0.5);
  EXPECT_EQ(program.metres_per_unit, 0.01);
  EXPECT_EQ(program.workspace_origin, Vec3(1, 2, 3));
  ASSERT_EQ(program.links.size(), 3u);
  EXPECT_EQ(program.links[0].name, "b");
  EXPECT_EQ(program.links[0].on.button, 2);
  EXPECT_EQ(program.links[0].stiffness_n_per_m.least(), 300);
  EXPECT_EQ(program.links[1].stiffness_n_per_m.least(), 0);
  EXPECT_EQ(program.links[1].on.force_above_n, 1.5);
  EXPECT_EQ(program.links[2].stiffness_n_per_m.least(), 70);
  EXPECT_NE(program.links[0].constraint, nullptr);
}

TEST(ExtractProgram, EpochsRise) {
  scene::Scene scene = scene_of("{}");
  const auto first = extract_program(scene), second = extract_program(scene);
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
  const auto program = extract_program(scene);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(field::load_counters().grids, before.grids + 1);
}

TEST(ExtractProgram, ASelectedLinkHoldsTheDrawnCurve) {
  scene::Scene scene = scene_of(R"({"fields": {"swirl": {"analytic": "circle"}},
    "chain": [{"name": "s", "type": "streamline", "field": "swirl", "seed": [1, 0, 0]}]})");
  if (extract_program(scene)) {
    EXPECT_EQ(scene.curves.size(), 1u);
    const auto any = scene::use_field(scene, "swirl", {});
    ASSERT_TRUE(any);
    ASSERT_TRUE(scene::use_curve(scene, {any->vector.get(), false, 0}, {1, 0, 0}, {}));
    EXPECT_EQ(scene.curves.size(), 1u);
  } else {
    ADD_FAILURE() << extract_program(scene).error().message;
  }
}

TEST(ExtractProgram, AMeshLinkHoldsTheDrawnMesh) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quad.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n");
  scene::Scene scene = scene_of(R"({"meshes": [{"name": "floor", "file": "quad.obj", "scale": 2}],
    "chain": [{"name": "a", "type": "mesh", "mesh": "floor", "free": "above"}]})",
                                folder / "s.json");
  const auto program = extract_program(scene);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ((*program)->links[0].constraint->domain_length(), 4);
  const auto again = extract_program(scene);
  ASSERT_TRUE(again);
  EXPECT_EQ((*program)->links[0].recipe, (*again)->links[0].recipe);
  expect_error("{\"chain\": [\n{\"name\": \"a\", \"type\": \"mesh\",\n\"mesh\": \"skull\"}]}", 3,
               {"unknown mesh \"skull\"", "it has none"});
}

TEST(ExtractProgram, CommonKeysAreChecked) {
  expect_error(point_with("\"stiffness\": -1"), 3, {"\"stiffness\" is -1", ">= 0 was expected"});
  expect_error(point_with("\"stiffness\": \"x\""), 3, {"\"stiffness\"", "finite number"});
  expect_error(point_with("\"on\": {}"), 3, {"neither", "expected"});
  expect_error(point_with("\"on\": true"), 3, {"\"on\"", "object", "expected"});
  expect_error(point_with("\"on\": {\"button\": 1, \"force_above\": 1}"), 3, {"both", "expected"});
  for (const char* bad : {"0", "33", "1.5", "\"a\""})
    expect_error(point_with("\"on\": {\"button\": " + std::string(bad) + "}"), 3, {"from 1 to 32"});
  for (const char* bad : {"0", "-1", "null"})
    expect_error(point_with("\"on\": {\"force_above\": " + std::string(bad) + "}"), 3, {"> 0 was expected"});
  expect_error(point_with("\"on\": {\"buton\": 1}"), 3, {"unknown key \"buton\"", "did you mean \"button\"?"});
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

}  // namespace
}  // namespace catena::haptics
