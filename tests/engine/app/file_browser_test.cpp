// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/file_browser.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/support.h"

namespace catena::app::file_browser_test {

class FileBrowser : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "Scenes");
    std::filesystem::create_directories(folder_ / "data");
    std::filesystem::create_directories(folder_ / ".hidden");
    for (const char* name : {"b.json", "A.VDB", "brain.nii.gz", "brain2.nii", "notes.txt", ".secret.json", "mesh.stl"})
      test::write_file(folder_ / name, "12345");
  }
  test::TemporaryFolder folder_;
};

TEST_F(FileBrowser, FoldersComeFirstThenSupportedFiles) {
  const auto entries = list_folder(folder_.path());
  ASSERT_TRUE(entries);
  std::vector<std::string> names;
  for (const FileEntry& e : *entries) names.push_back(e.name + (e.is_folder ? "/" : ""));
  EXPECT_EQ(names, (std::vector<std::string>{"data/", "Scenes/", "A.VDB", "b.json", "brain.nii.gz", "brain2.nii", "mesh.stl"}));
  EXPECT_EQ((*entries)[2].bytes, 5u);
  EXPECT_EQ(list_folder(folder_.path(), true)->size(), 3u);
  const auto none = list_folder(folder_ / "nowhere");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("nowhere"), std::string::npos);
}

TEST_F(FileBrowser, ADroppedFolderResolvesToItsFileOrSeries) {
  const std::string data = folder_ / "data";
  EXPECT_EQ(resolve_dropped_folder(data), data) << "who reads it says what is wrong";
  test::write_file(data + "/notes.txt", "");
  test::write_file(data + "/flow_8.vti", "");
  EXPECT_EQ(resolve_dropped_folder(data), data + "/flow_8.vti");
  test::write_file(data + "/flow_08.vti", "");
  test::write_file(data + "/flow_10.vti", "");
  test::write_file(data + "/view.json", "");
  EXPECT_EQ(resolve_dropped_folder(data), data + "/flow_*.vti");
  test::write_file(data + "/other_10.vti", "");
  EXPECT_EQ(resolve_dropped_folder(data), data) << "two rows";
  std::filesystem::remove(data + "/other_10.vti");
  test::write_file(data + "/I001.dcm", "");
  EXPECT_EQ(resolve_dropped_folder(data), data);
}

TEST_F(FileBrowser, TypedPathsAreCompletedToTheCommonPrefix) {
  EXPECT_EQ(complete_path(folder_.path(), "bra"), "brain");
  EXPECT_EQ(complete_path(folder_.path(), "brain."), "brain.nii.gz");
  EXPECT_EQ(complete_path(folder_.path(), "Sc"), "Scenes/");
  EXPECT_EQ(complete_path(folder_.path(), "x"), "x");
  EXPECT_EQ(complete_path("/", folder_ / "me"), folder_ / "mesh.stl");
  EXPECT_EQ(resolve_typed_path("/a/b", "../c.json"), "/a/c.json");
  EXPECT_EQ(resolve_typed_path("/a/b", "/c.json"), "/c.json");
  ASSERT_NE(std::getenv("HOME"), nullptr);
  EXPECT_EQ(resolve_typed_path("/a", "~/c.json"), std::filesystem::path(std::getenv("HOME")) / "c.json");
}

TEST_F(FileBrowser, ImagesGetTheNextUnusedNumber) {
  EXPECT_EQ(unused_file_name(folder_.path(), "b", ".png"), folder_ / "b-001.png");
  test::write_file(folder_ / "b-001.png", "");
  test::write_file(folder_ / "b-003.png", "");
  EXPECT_EQ(unused_file_name(folder_.path(), "b", ".png"), folder_ / "b-002.png");
  EXPECT_EQ(path_stem("x/brain.nii.gz"), "brain");
  EXPECT_EQ(path_stem("x/A.VDB"), "A");
  EXPECT_EQ(path_stem("flow.v2.json"), "flow.v2");
  EXPECT_EQ(path_stem(""), "catena");
}

}  // namespace catena::app::file_browser_test
