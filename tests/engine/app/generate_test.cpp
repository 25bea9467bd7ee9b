// SPDX-License-Identifier: MIT
/// The commands `generate`, `info` and `import`.
#include "engine/base/json.h"
#include "tests/engine/app/program_in_folder.h"

namespace catena::generate_test {

using Generate = test::ProgramInFolder;
using Info = test::ProgramInFolder;

TEST_F(Generate, InfoDescribesTheWrittenGrid) {
  succeed("generate linear -o {a.vdb} --resolution 5 --box -1 3");
  test::expect_parts(succeed("info {a.vdb}").out,
                     {"linear (float)", "5 5 5 voxels from index 0 0 0", "voxel        1 1 1", "origin       -1 -1 -1",
                      "world box    -1 -1 -1 .. 3 3 3", "active       125 voxels", "not finite   0", "bytes"});
}

TEST_F(Generate, TheLeftVentricleHasItsGridsAndAMask) {
  succeed("generate left-ventricle -o {lv.vdb} --resolution 24");
  test::expect_parts(run("info {lv.vdb}").out, {"density (float)", "transmural (float)", "fibre (vec3s)", "valid (bool"});
}

TEST_F(Generate, EveryDocumentedNameWorks) {
  for (const std::string name : {"circle", "saddle", "node", "rankine", "lamb-oseen", "hill", "abc", "helix", "uniform", "sphere", "plane",
                                 "torus", "constant", "linear", "gaussian", "marschner-lobb", "tanh", "left-ventricle", "vortices"}) {
    succeed("generate " + name + " --resolution 9 -o {" + name + ".vdb}");
    EXPECT_TRUE(exists(name + ".vdb")) << name;
  }
}

TEST_F(Generate, VoxelsTooSmallForVdbAreRefused) {
  expect_refused("generate sphere -o {a.vdb} --resolution 5 --box -2e-9 2e-9", {"unit of length"});
  succeed("generate sphere -o {a.vdb} --resolution 5 --box -4e-5 4e-5");
}

TEST_F(Generate, OutputsAreWrittenThroughSymbolicLinks) {
  write("real.csv", "old");
  std::filesystem::create_symlink(folder_ / "real.csv", folder_ / "link.csv");
  write("s.json", "{}");
  write("p.csv", "t,x,y,z\n0,0,0,0\n");
  succeed("replay {s.json} --probe {p.csv} -o {link.csv}");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.csv"));
  EXPECT_NE(read("real.csv"), "old");
}

TEST(Import, ANiftiFileOfADebianPackageBecomesAVdb) {
  const std::string brain = "/usr/share/mricron/templates/ch2bet.nii.gz";
  if (!test::exists(brain)) GTEST_SKIP() << "package mricron-data is not installed";
  const test::TemporaryFolder folder;
  test::run_ok({"import", brain, "-o", folder / "brain.vdb"});
  test::expect_parts(test::run_catena({"info", folder / "brain.vdb"}).out, {"voxel        1 1 1", "origin       -90 -125 -71"});
}

TEST_F(Info, DescribesAScene) {
  write("s.json", R"({"fields": {"s": {"analytic": "sphere"}}, "chain": [{"name": "a", "type": "isosurface", "field": "s", "level": 1}]})");
  test::expect_parts(succeed("info {s.json}").out, {"field s: scalar sphere", "link a: isosurface"});
}

TEST_F(Info, PrintsTheSchemaOfScenes) {
  const auto info = succeed("info --schema");
  const auto schema = json::parse(info.out, "schema");
  ASSERT_TRUE(schema) << schema.error().message;
  const json::Node& parts = *schema->find("properties");
  for (const char* part : {"fields", "chain", "device", "volumes", "camera", "title"}) EXPECT_NE(parts.find(part), nullptr) << part;
  test::expect_parts(info.out, {"\"isosurface\""});
}

TEST_F(Info, ChecksTheDevice) {
  write("s.json", "{\n\"device\": {\"type\": \"mouse\", \"rate\": 99}}");
  expect_refused("info {s.json}", {"s.json:2: \"rate\""});
}

TEST_F(Info, PrintsTheKeysOfAPart) {
  test::expect_parts(succeed("info --keys slices").out, {"| `contours` | object |"});
  expect_refused("info --keys slice", {"did you mean \"slices\"?"});
}

}  // namespace catena::generate_test
