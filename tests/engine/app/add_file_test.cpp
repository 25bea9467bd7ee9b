// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/item_templates.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace catena::app {
namespace add_file_test {

TEST(AddFile, AddsAFieldAndItsVolumeUnderAnUnusedName) {
  const auto added =
      make_merge_edits(R"({"fields": {"density": {"analytic": "sphere"}}, "volumes": [{"field": "density"}]})", "/a/s.json",
                       R"({"fields": {"density": {"file": "x.vdb", "grid": "density"}}, "volumes": [{"field": "density", "shade": true}]})",
                       "/a/data/x.vdb.json");
  ASSERT_TRUE(added) << added.error().message;
  ASSERT_EQ(added->edits.size(), 2u);
  EXPECT_EQ(added->edits[0].pointer, "/fields/density_2");
  EXPECT_EQ(*added->edits[0].value, R"({"file": "data/x.vdb", "grid": "density"})");
  EXPECT_EQ(added->edits[1].pointer, "/volumes/-");
  EXPECT_EQ(*added->edits[1].value, R"({"field": "density_2", "shade": true})");
  EXPECT_EQ(added->renames, (std::vector<std::pair<std::string, std::string>>{{"density", "density_2"}}));
}

TEST(AddFile, FilesInAnotherFolderHaveAbsolutePaths) {
  const auto added =
      make_merge_edits("{}", "/a/s.json", R"({"fields": {"v": {"file": "x.vdb"}}, "streamlines": [{"field": "v"}]})", "/b/x.vdb.json");
  ASSERT_TRUE(added);
  EXPECT_EQ(*added->edits[0].value, R"({"file": "/b/x.vdb"})");
  EXPECT_EQ(added->edits[0].pointer, "/fields/v");
  EXPECT_EQ(added->edits[1].pointer, "/streamlines/-");
}

TEST(AddFile, SceneNamesWithoutAFolderAreRelativeToTheCurrentFolder) {
  const char* added = R"({"fields": {"v": {"file": "x.vdb"}}})";
  const auto beside = make_merge_edits("{}", "s.json", added, "x.vdb.json");
  ASSERT_TRUE(beside);
  EXPECT_EQ(*beside->edits[0].value, R"({"file": "x.vdb"})");
  const auto below = make_merge_edits("{}", "s.json", added, (std::filesystem::current_path() / "data/x.vdb.json").string());
  ASSERT_TRUE(below);
  EXPECT_EQ(*below->edits[0].value, R"({"file": "data/x.vdb"})");
  EXPECT_TRUE(make_merge_edits("{}", "sub/s.json", added, "x.vdb.json"));
}

TEST(AddFile, MeshesWithANameInUseAreRenamed) {
  const auto added = make_merge_edits(R"({"meshes": [{"name": "mesh", "file": "a.stl"}]})", "/a/s.json",
                                      R"({"meshes": [{"name": "mesh", "file": "b.stl"}]})", "/a/b.stl.json");
  ASSERT_TRUE(added);
  EXPECT_EQ(*added->edits[0].value, R"({"name": "mesh_2", "file": "b.stl"})");
}

}  // namespace add_file_test
}  // namespace catena::app
