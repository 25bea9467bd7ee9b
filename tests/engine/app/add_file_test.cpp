// SPDX-License-Identifier: MIT
#include "engine/scene/merge.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "tests/support/results.h"

namespace catena::app::add_file_test {

using test::value_of;

auto merged(const std::string& text, const std::string& path, const std::string& added, const std::string& added_path) {
  return value_of(scene::merge_scene(text, path, added, added_path));
}

TEST(AddFile, AddsAFieldAndItsVolumeUnderAnUnusedName) {
  const auto added =
      merged(R"({"fields": {"density": {"analytic": "sphere"}}, "volumes": [{"field": "density"}]})", "/a/s.json",
             R"({"fields": {"density": {"file": "x.vdb", "grid": "density"}}, "volumes": [{"field": "density", "shade": true}]})",
             "/a/data/x.vdb.json");
  ASSERT_EQ(added.edits.size(), 2u);
  EXPECT_EQ(added.edits[0].pointer, "/fields/density_2");
  EXPECT_EQ(*added.edits[0].value, R"({"file": "data/x.vdb", "grid": "density"})");
  EXPECT_EQ(added.edits[1].pointer, "/volumes/-");
  EXPECT_EQ(*added.edits[1].value, R"({"field": "density_2", "shade": true})");
  EXPECT_EQ(added.fields, (std::vector<std::pair<std::string, std::string>>{{"density", "density_2"}}));
}

TEST(AddFile, AProjectionBesideAnotherVolumeBecomesAPlainVolume) {
  const char* added = R"({"fields": {"n": {"file": "n.nrrd"}}, "volumes": [{"field": "n", "projection": "maximum", "shade": true}]})";
  EXPECT_EQ(*merged(R"({"volumes": [{"field": "d"}]})", "/a/s.json", added, "/a/n.json").edits[1].value,
            R"({"field": "n", "shade": true})");
  EXPECT_EQ(*merged("{}", "/a/s.json", added, "/a/n.json").edits[1].value, R"({"field": "n", "projection": "maximum", "shade": true})");
}

TEST(AddFile, FilesInAnotherFolderHaveAbsolutePaths) {
  const auto added = merged("{}", "/a/s.json", R"({"fields": {"v": {"file": "x.vdb"}}, "streamlines": [{"field": "v"}]})", "/b/x.vdb.json");
  EXPECT_EQ(*added.edits[0].value, R"({"file": "/b/x.vdb"})");
  EXPECT_EQ(added.edits[0].pointer, "/fields/v");
  EXPECT_EQ(added.edits[1].pointer, "/streamlines/-");
}

TEST(AddFile, SceneNamesWithoutAFolderAreRelativeToTheCurrentFolder) {
  const char* added = R"({"fields": {"v": {"file": "x.vdb"}}})";
  const auto beside = merged("{}", "s.json", added, "x.vdb.json");
  EXPECT_EQ(*beside.edits[0].value, R"({"file": "x.vdb"})");
  const auto below = merged("{}", "s.json", added, (std::filesystem::current_path() / "data/x.vdb.json").string());
  EXPECT_EQ(*below.edits[0].value, R"({"file": "data/x.vdb"})");
  merged("{}", "sub/s.json", added, "x.vdb.json");
}

TEST(AddFile, MeshesWithANameInUseAreRenamed) {
  const auto added = merged(R"({"meshes": [{"name": "mesh", "file": "a.stl"}]})", "/a/s.json",
                            R"({"meshes": [{"name": "mesh", "file": "b.stl"}]})", "/a/b.stl.json");
  EXPECT_EQ(*added.edits[0].value, R"({"name": "mesh_2", "file": "b.stl"})");
}

TEST(AddFile, ReferencesFollowNamesAndPlacesInLists) {
  const auto added = merged(
      R"({"fields": {"m": {"file": "a.nii"}}, "slices": [{"field": "m", "axis": "x", "at": 0}, {"field": "m", "axis": "y", "at": 0}],
          "lights": [{"type": "head"}]})",
      "/a/s.json",
      R"({"fields": {"m": {"file": "b.nii"}, "n": {"label": "*", "of": "m"}},
          "volumes": [{"field": "n", "color_by": {"field": "m"}}], "isosurfaces": [{"field": "n", "level": {"widget": "k"}}],
          "slices": [{"field": "m", "axis": "z", "at": 0}], "scalar_bars": [{"slice": 0}, {"field": "m"}], "lights": [{"type": "head"}]})",
      "/a/b.nii.json");
  std::map<std::string, std::string> edits;
  for (const auto& edit : added.edits) edits[edit.pointer] += *edit.value;
  EXPECT_EQ(edits["/fields/n"], R"({"label": "*", "of": "m_2"})");
  EXPECT_EQ(edits["/volumes/-"], R"({"field": "n", "color_by": {"field": "m_2"}})");
  EXPECT_EQ(edits["/slices/-"], R"({"field": "m_2", "axis": "z", "at": 0})");
  EXPECT_EQ(edits["/scalar_bars/-"], R"({"slice": 2}{"field": "m_2"})");
  EXPECT_EQ(edits.count("/lights/-"), 0u);
}

}  // namespace catena::app::add_file_test
