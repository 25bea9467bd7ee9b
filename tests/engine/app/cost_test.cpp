// SPDX-License-Identifier: MIT
/// `catena info --cost`: the expected cost of a scene, and the measured cost with --measure. Times are left to benchmarks.
#include "engine/base/json.h"
#include "tests/engine/app/program_in_folder.h"

namespace catena::cost_test {

class InfoCost : public test::ProgramInFolder {
 protected:
  std::vector<json::Node> rows(const std::string& scene, const std::string& more = "") {
    write("s.json", scene);
    const test::ProgramResult done = succeed("info {s.json} --cost --json " + more);
    auto node = json::parse(done.out, "out");
    EXPECT_TRUE(node) << done.out;
    return node ? node->find("rows")->items : std::vector<json::Node>{};
  }
  static const json::Node* find(const std::vector<json::Node>& rows, const std::string& part, const std::string& name) {
    for (const json::Node& row : rows)
      if (row.find("part")->string == part && row.find("name")->string == name) return &row;
    return nullptr;
  }
  static double number(const json::Node* row, const char* key) {
    const json::Node* value = row != nullptr ? row->find(key) : nullptr;
    return value != nullptr && value->kind == json::Kind::number ? value->number : -1;
  }
};

const char* kScene = R"({
  "fields": {"ball": {"analytic": "sphere", "resolution": 40, "box": [-1, 1]}, "flow": {"analytic": "circle"},
             "unused": {"analytic": "torus", "resolution": 64}},
  "isosurfaces": [{"field": "ball", "level": 0.5}, {"field": "unused", "level": 0.2, "visible": false}],
  "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.5, 0, 0]},
            {"name": "skin", "type": "isosurface", "field": "ball", "level": 0.5}]})";

TEST_F(InfoCost, ExpectedBytesEqualMeasuredBytesAndEveryPartHasARow) {
  const auto found = rows(kScene, "--measure");
  const json::Node* ball = find(found, "load", "ball");
  ASSERT_NE(ball, nullptr);
  EXPECT_GE(number(ball, "expected_bytes"), 40 * 40 * 40 * 4);
  EXPECT_EQ(number(ball, "expected_bytes"), number(ball, "measured_bytes"));
  const json::Node* mirrors = find(found, "mirror", "all");
  EXPECT_GE(number(mirrors, "expected_bytes"), 40 * 40 * 40 * 4);
  EXPECT_EQ(number(mirrors, "expected_bytes"), number(mirrors, "measured_bytes"));
  for (const auto& [part, name] : {std::pair{"tick", "curve"}, {"tick", "skin"}, {"tick", "all"}, {"frame", "all"}})
    EXPECT_GT(number(find(found, part, name), "expected_ms"), 0) << part << " " << name;
  EXPECT_GT(number(find(found, "tick", "all"), "measured_ms"), 0);
  EXPECT_GT(number(find(found, "frame", "all"), "measured_ms"), 0);
}

TEST_F(InfoCost, CountsMeshesPointsAndTracedLines) {
  write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  write("p.csv", "x,y,z\n0,0,0\n1,0,0\n0,1,0\n");
  const auto found = rows(R"({
    "fields": {"flow": {"analytic": "circle"}}, "points": [{"name": "dots", "file": "p.csv"}], "meshes": [{"name": "tetra", "file": "m.obj"}],
    "streamlines": [{"field": "flow", "seeds": [[0.5, 0, 0], [0.7, 0, 0]]}]})",
                          "--measure");
  const json::Node* mesh = find(found, "load", "tetra");
  ASSERT_NE(mesh, nullptr);
  EXPECT_EQ(mesh->find("work")->string, "4 triangles");
  EXPECT_GT(number(mesh, "expected_bytes"), 4 * 3 * 4);
  EXPECT_EQ(number(mesh, "expected_bytes"), number(mesh, "measured_bytes"));
  EXPECT_GT(number(mesh, "expected_ms"), 0);
  const json::Node* tubes = find(found, "shape", "tubes");
  ASSERT_NE(tubes, nullptr);
  EXPECT_TRUE(tubes->find("work")->string.starts_with("2 of ")) << tubes->find("work")->string;
  EXPECT_GT(number(tubes, "expected_bytes"), 2 * 20 * 24) << "a circle is more than 20 places";
  ASSERT_NE(find(found, "shape", "points"), nullptr);
  EXPECT_EQ(find(found, "shape", "points")->find("work")->string, "1 of 3 spheres");
  EXPECT_EQ(find(found, "shape", "meshes")->find("work")->string, "1 of 4 triangles");
}

TEST_F(InfoCost, HiddenAndUnusedPartsHaveNoCost) {
  const auto found = rows(kScene);
  EXPECT_EQ(find(found, "load", "unused"), nullptr);
  EXPECT_EQ(find(found, "mirror", "torus"), nullptr);
  ASSERT_NE(find(found, "create", "widgets"), nullptr);
  EXPECT_EQ(find(found, "create", "widgets")->find("work")->string, "0");
  EXPECT_EQ(number(find(found, "tick", "all"), "measured_ms"), -1) << "it was not asked for";
}

TEST_F(InfoCost, BadInputIsOneLine) {
  for (const char* line : {"info --measure {s.json}", "info --cost {none.json}", "info --cost"})
    EXPECT_TRUE(expect_refused(line, {}).out.empty()) << line;
}

}  // namespace catena::cost_test
