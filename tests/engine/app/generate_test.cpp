// SPDX-License-Identifier: MIT
/// The commands `generate`, `info` and `import`.
#include <gtest/gtest.h>

#include "engine/base/json.h"

#include <filesystem>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace generate_test {

using namespace catena;

TEST(Generate, InfoDescribesTheWrittenGrid) {
  const test::TemporaryFolder folder;
  const auto made = test::run_catena({"generate", "linear", "-o", folder / "a.vdb", "--resolution", "5", "--box", "-1", "3"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto info = test::run_catena({"info", folder / "a.vdb"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  for (const char* part : {"linear (float)", "5 5 5 voxels from index 0 0 0", "voxel        1 1 1", "origin       -1 -1 -1",
                           "world box    -1 -1 -1 .. 3 3 3", "active       125 voxels", "not finite   0", "bytes"})
    EXPECT_NE(info.out.find(part), std::string::npos) << part << " in\n" << info.out;
}

TEST(Generate, TheLeftVentricleHasItsGridsAndAMask) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(test::run_catena({"generate", "left-ventricle", "-o", folder / "lv.vdb", "--resolution", "24"}).exit_code, 0);
  const auto info = test::run_catena({"info", folder / "lv.vdb"});
  for (const char* part : {"density (float)", "transmural (float)", "fibre (vec3s)", "valid (bool"})
    EXPECT_NE(info.out.find(part), std::string::npos) << part << " in\n" << info.out;
}

TEST(Generate, EveryDocumentedNameWorks) {
  const test::TemporaryFolder folder;
  for (const char* name : {"circle", "saddle", "node", "rankine", "lamb-oseen", "hill", "abc", "helix", "uniform", "sphere", "plane",
                           "torus", "constant", "linear", "gaussian", "marschner-lobb", "tanh", "left-ventricle", "vortices"}) {
    const std::string out = folder / (std::string(name) + ".vdb");
    const auto run = test::run_catena({"generate", name, "-o", out, "--resolution", "9"});
    EXPECT_EQ(run.exit_code, 0) << name << ": " << run.err;
    EXPECT_TRUE(test::exists(out)) << name;
  }
}

TEST(Generate, VoxelsTooSmallForVdbAreRefused) {
  const test::TemporaryFolder folder;
  const auto run = test::run_catena({"generate", "sphere", "-o", folder / "a.vdb", "--resolution", "5", "--box", "-2e-9", "2e-9"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("unit of length"), std::string::npos) << run.err;
  EXPECT_FALSE(test::exists(folder / "a.vdb"));
  EXPECT_EQ(test::run_catena({"generate", "sphere", "-o", folder / "a.vdb", "--resolution", "5", "--box", "-4e-5", "4e-5"}).exit_code, 0);
}

TEST(Generate, OutputsAreWrittenThroughSymbolicLinks) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "real.csv", "old");
  std::filesystem::create_symlink(folder / "real.csv", folder / "link.csv");
  test::write_file(folder / "s.json", "{}");
  test::write_file(folder / "p.csv", "t,x,y,z\n0,0,0,0\n");
  ASSERT_EQ(test::run_catena({"replay", folder / "s.json", "--probe", folder / "p.csv", "-o", folder / "link.csv"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.csv"));
  EXPECT_NE(test::read_file(folder / "real.csv"), "old");
}

TEST(Import, ANiftiFileOfADebianPackageBecomesAVdb) {
  const std::string brain = "/usr/share/mricron/templates/ch2bet.nii.gz";
  if (!test::exists(brain)) GTEST_SKIP() << "package mricron-data is not installed";
  const test::TemporaryFolder folder;
  const auto run = test::run_catena({"import", brain, "-o", folder / "brain.vdb"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto info = test::run_catena({"info", folder / "brain.vdb"});
  EXPECT_NE(info.out.find("voxel        1 1 1"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("origin       -90 -125 -71"), std::string::npos) << info.out;
}

TEST(Info, DescribesAScene) {
  const test::TemporaryFolder folder;
  test::write_file(
      folder / "s.json",
      R"({"fields": {"s": {"analytic": "sphere"}}, "chain": [{"name": "a", "type": "isosurface", "field": "s", "level": 1}]})");
  const auto info = test::run_catena({"info", folder / "s.json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("field s: scalar sphere"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("link a: isosurface"), std::string::npos) << info.out;
}

TEST(Info, PrintsTheSchemaOfScenes) {
  const auto info = test::run_catena({"info", "--schema"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const auto schema = json::parse(info.out, "schema");
  ASSERT_TRUE(schema) << schema.error().message;
  const json::Node& parts = *schema->find("properties");
  for (const char* part : {"fields", "chain", "device", "volumes", "camera", "title"}) EXPECT_NE(parts.find(part), nullptr) << part;
  EXPECT_NE(info.out.find("\"isosurface\""), std::string::npos);
}

TEST(Info, ChecksTheDevice) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", "{\n\"device\": {\"type\": \"mouse\", \"rate\": 99}}");
  const auto info = test::run_catena({"info", folder / "s.json"});
  EXPECT_EQ(info.exit_code, 2) << info.out;
  EXPECT_NE(info.err.find("s.json:2: \"rate\""), std::string::npos) << info.err;
}

TEST(Info, PrintsTheKeysOfAPart) {
  const auto info = test::run_catena({"info", "--keys", "slices"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("| `contours` | object |"), std::string::npos) << info.out;
  const auto none = test::run_catena({"info", "--keys", "slice"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("did you mean \"slices\"?"), std::string::npos) << none.err;
}

}  // namespace generate_test
