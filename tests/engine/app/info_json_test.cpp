// SPDX-License-Identifier: MIT
/// `catena info --json`: the output of `info` for programs.
#include "engine/base/json.h"
#include "tests/engine/app/program_in_folder.h"
#include "tests/engine/io/vtk/files.h"

namespace catena::info_json_test {

class InfoJson : public test::ProgramInFolder {
 protected:
  json::Node info(const std::string& name) {
    const test::ProgramResult done = succeed("info --json {" + name + "}");
    EXPECT_EQ(done.out.find('\n') + 1, done.out.size()) << "one line";
    auto node = json::parse(done.out, "out");
    EXPECT_TRUE(node) << (node ? "" : node.error().message) << done.out;
    return node ? *node : json::Node{};
  }
  static double number(const json::Node& node, const char* key) {
    const json::Node* found = node.find(key);
    EXPECT_TRUE(found != nullptr && found->kind == json::Kind::number) << key;
    return found == nullptr ? -1 : found->number;
  }
  static std::string word(const json::Node& node, const char* key) {
    const json::Node* found = node.find(key);
    EXPECT_TRUE(found != nullptr && found->kind == json::Kind::string) << key;
    return found == nullptr ? "" : found->string;
  }
};

TEST_F(InfoJson, ADataFileHasItsGrids) {
  succeed("generate linear -o {a.vdb} --resolution 5 --box -1 3");
  const json::Node info_of = info("a.vdb");
  EXPECT_EQ(word(info_of, "kind"), "data");
  const json::Node* grids = info_of.find("grids");
  ASSERT_TRUE(grids != nullptr && grids->items.size() == 1);
  const json::Node& grid = grids->items[0];
  EXPECT_EQ(word(grid, "name"), "linear");
  EXPECT_EQ(number(grid, "active_voxels"), 125);
  EXPECT_EQ(grid.find("size")->items[2].number, 5);
  EXPECT_EQ(grid.find("axes")->items[1].items[1].number, 1);
  EXPECT_EQ(grid.find("origin")->items[0].number, -1);
  EXPECT_EQ(grid.find("world_box")->items[1].items[2].number, 3);
  EXPECT_TRUE(grid.find("usable")->boolean);
}

TEST_F(InfoJson, AnUnstructuredGridHasItsNumbersOfPointsAndCells) {
  write("m.vtu", test::vtk_files::vtu_mixed([](const Vec3& p) { return p.x; }));
  const json::Node meshed = info("m.vtu");
  const json::Node& points = meshed.find("grids")->items.at(0);
  const json::Node& cells = meshed.find("grids")->items.at(1);
  EXPECT_EQ(number(cells, "active_cells"), 2) << "a hexahedron and a tetrahedron";
  EXPECT_EQ(points.find("active_voxels"), nullptr);
  const std::string active_points = fmt::format("active       {} points\n", number(points, "active_points"));
  test::expect_parts(run("info {m.vtu}").out, {active_points, "active       2 cells\n"});
}

TEST_F(InfoJson, AMeshAndASceneHaveTheirParts) {
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  write("s.json", R"({"fields": {"r": {"analytic": "sphere"}}, "meshes": [{"name": "t", "file": "t.obj"}],
    "isosurfaces": [{"field": "r", "level": 1}], "chain": [{"name": "skin", "type": "isosurface", "field": "r", "level": 1}],
    "widgets": [{"name": "cut", "type": "cutting_plane", "center": [1, 2, 3], "normal": [0, 0, 1]}]})");
  const json::Node mesh = info("t.obj");
  EXPECT_EQ(word(mesh, "kind"), "mesh");
  EXPECT_EQ(number(mesh, "triangles"), 4);
  EXPECT_EQ(number(mesh, "open_edges"), 0);
  const json::Node scene = info("s.json");
  EXPECT_EQ(word(scene, "kind"), "scene");
  EXPECT_EQ(word(scene.find("fields")->items.at(0), "source"), "sphere");
  EXPECT_EQ(scene.find("fields")->items.at(0).find("range")->items.at(1).kind, json::Kind::null) << "of a formula without an end";
  EXPECT_EQ(number(scene.find("meshes")->items.at(0), "vertices"), 4);
  EXPECT_EQ(word(scene.find("links")->items.at(0), "type"), "isosurface");
  EXPECT_EQ(scene.find("widgets")->items.at(0).find("at")->items.at(2).number, 3);
  EXPECT_EQ(number(*scene.find("drawn"), "isosurfaces"), 1);
  EXPECT_EQ(number(*scene.find("coupling"), "stiffness_n_per_m"), 500);
}

TEST_F(InfoJson, ARecordingHasItsTicks) {
  write("s.json", "{}");
  succeed("feel {s.json} --seconds 0.02 --realtime off --record {l.catlog}");
  const json::Node recording = info("l.catlog");
  EXPECT_EQ(word(recording, "kind"), "recording");
  EXPECT_GT(number(recording, "ticks"), 0);
  EXPECT_EQ(number(recording, "rate_hz"), 1000);
}

TEST_F(InfoJson, ErrorsEqualThoseOfInfo) { EXPECT_TRUE(expect_refused("info --json {none.vdb}", {"none.vdb"}).out.empty()); }

}  // namespace catena::info_json_test
