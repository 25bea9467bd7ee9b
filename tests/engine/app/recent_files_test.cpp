// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/file_browser.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/engine/app/environment_variable.h"
#include "tests/support/support.h"

namespace catena::app::recent_files_test {

using Names = std::vector<std::string>;

TEST(RecentFiles, TheNewestIsFirstAndThereAreNoDuplicates) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.json", "b.vdb", "c\"\xc3\xa9.json"}) test::write_file(folder / name, "");
  RecentFiles recent(folder / "state/catena/recent.json");
  EXPECT_TRUE(recent.existing_files().empty());
  recent.add(folder / "a.json");
  recent.add(folder / "b.vdb");
  recent.add(folder / "c\"\xc3\xa9.json");
  recent.add(folder / "./a.json");
  const Names expected{folder / "a.json", folder / "c\"\xc3\xa9.json", folder / "b.vdb"};
  EXPECT_EQ(recent.existing_files(), expected);
  EXPECT_EQ(RecentFiles(recent.path()).existing_files(), expected);
}

TEST(RecentFiles, RelativePathsAreStoredAsAbsolutePaths) {
  const test::TemporaryFolder folder;
  RecentFiles recent(folder / "recent.json");
  recent.add("no-such-file.json");
  EXPECT_NE(test::read_file(folder / "recent.json").find((std::filesystem::current_path() / "no-such-file.json").string()),
            std::string::npos);
}

TEST(RecentFiles, MissingFilesAreHiddenUntilTheyExist) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.json", "");
  RecentFiles recent(folder / "recent.json");
  recent.add(folder / "a.json");
  recent.add(folder / "gone.json");
  EXPECT_EQ(recent.existing_files(), Names{folder / "a.json"});
  test::write_file(folder / "gone.json", "");
  EXPECT_EQ(recent.existing_files().size(), 2u);
}

TEST(RecentFiles, ThereAreAtMostTen) {
  const test::TemporaryFolder folder;
  RecentFiles recent(folder / "recent.json");
  for (int i = 0; i < 15; ++i) {
    const std::string name = folder / (std::to_string(i) + ".json");
    test::write_file(name, "");
    recent.add(name);
  }
  ASSERT_EQ(recent.existing_files().size(), kMaxRecentFiles);
  EXPECT_EQ(recent.existing_files().front(), folder / "14.json");
  EXPECT_EQ(recent.existing_files().back(), folder / "5.json");
}

TEST(RecentFiles, TwoProgramsShareTheList) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.json", "b.json"}) test::write_file(folder / name, "");
  RecentFiles one(folder / "recent.json"), other(folder / "recent.json");
  one.add(folder / "a.json");
  other.add(folder / "b.json");
  EXPECT_EQ(RecentFiles(folder / "recent.json").existing_files(), (Names{folder / "b.json", folder / "a.json"}));
}

TEST(RecentFiles, GarbageIsAnEmptyList) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.json", "");
  for (const char* garbage : {"", "{", "[]", "{\"files\": 3}", "{\"files\": [1, null, {}]}", "\xff\xfe", "{\"files\": {\"a\": 1}}"}) {
    test::write_file(folder / "recent.json", garbage);
    EXPECT_TRUE(RecentFiles(folder / "recent.json").existing_files().empty()) << garbage;
  }
  RecentFiles recent(folder / "recent.json");
  recent.add(folder / "a.json");
  EXPECT_EQ(RecentFiles(folder / "recent.json").existing_files(), Names{folder / "a.json"});
  EXPECT_TRUE(RecentFiles(folder.path()).existing_files().empty());
}

TEST(RecentFiles, AnUnwritablePathIsNotAnError) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "a.json", "");
  for (const std::string& path :
       {std::string(), std::string("/proc/none/recent.json"), folder / "a.json/catena/recent.json", folder.path()}) {
    RecentFiles recent(path);
    recent.add(folder / "a.json");
    EXPECT_EQ(recent.existing_files(), Names{folder / "a.json"}) << path;
  }
  EXPECT_EQ(test::read_file(folder / "a.json"), "");
}

TEST(RecentFiles, TheListIsInTheUsersStateFolder) {
  {
    const test::EnvironmentVariable state("XDG_STATE_HOME", "/state"), home("HOME", "/home/me");
    EXPECT_EQ(RecentFiles().path(), "/state/catena/recent.json");
  }
  for (const std::optional<std::string>& none : {std::optional<std::string>(""), {"relative"}, {}}) {
    const test::EnvironmentVariable state("XDG_STATE_HOME", none), home("HOME", "/home/me");
    EXPECT_EQ(RecentFiles().path(), "/home/me/.local/state/catena/recent.json");
  }
  const test::EnvironmentVariable state("XDG_STATE_HOME", std::nullopt), home("HOME", std::nullopt);
  EXPECT_EQ(RecentFiles().path(), "");
}

}  // namespace catena::app::recent_files_test
