// SPDX-License-Identifier: MIT
/// Levels of stores that have none: equal to those of `import`, killed programs, changed data, what cannot be written, damaged caches.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>

#include "engine/base/memory_limit.h"
#include "engine/io/levels/level_cache.h"
#include "engine/io/stores/store_bricks.h"
#include "engine/io/zarr/write_zarr.h"
#include "tests/support/results.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

extern char** environ;

namespace catena::field::level_cache_test {

namespace fs = std::filesystem;
using test::has;
using test::value_of;

/// A store of one level, 200 x 150 x 140 voxels, and its scene. The levels of the import are in whole.zarr/1 and the following.
class LevelCache : public testing::Test {
 protected:
  void SetUp() override {
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    std::string numbers(std::size_t{2} * 200 * 150 * 140, '\0');
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<char>(i * i >> 9);
    test::write_file(folder_ / "in.raw", numbers);
    test::expect_run({"import", folder_ / "in.raw", "--shape", "200", "150", "140", "--type", "uint16", "-o", folder_ / "whole.zarr"});
    fs::copy(folder_ / "whole.zarr/0", folder_ / "in.zarr", fs::copy_options::recursive);
    test::write_file(folder_ / "scene.json", R"({"fields": {"f": {"file": "in.zarr"}}})");
    fs::remove_all(folder_ / "cache");
  }
  void TearDown() override { unsetenv("XDG_CACHE_HOME"); }

  std::vector<std::string> words() const { return {"info", folder_ / "scene.json", "--memory", "10"}; }
  /// Returns the folder of the cache; empty: none.
  std::string entry() const {
    std::error_code code;
    for (const auto& at : fs::directory_iterator(folder_ / "cache/catena/levels", code)) return at.path().string();
    return {};
  }
  void expect_levels_of_import() const {
    for (const char* level : {"0", "1"}) {
      const std::string other = folder_ / "whole.zarr/" + std::to_string(std::atoi(level) + 1);
      EXPECT_EQ(test::run_program("/usr/bin/diff", {"-r", entry() + "/levels.zarr/" + level, other}).exit_code, 0) << level;
    }
    EXPECT_FALSE(test::exists(entry() + "/levels.zarr.part"));
  }

  test::TemporaryFolder folder_;
};

TEST_F(LevelCache, LevelsAreThoseOfAnImportAndTheIndexKnowsEveryRange) {
  test::expect_run(words());
  expect_levels_of_import();
  EXPECT_TRUE(has(test::expect_run({"info", folder_ / "in.zarr"}).out, "2 coarser levels are in the cache: " + entry()));
  set_level_cache(folder_ / "cache/catena/levels", {});
  const auto store = value_of(Store::open(folder_ / "in.zarr"));
  const StoreBricks bricks(std::make_shared<const StoredLevels>(store, 0, 0, find_cached_levels(*store, 0, 0)));
  ASSERT_EQ(bricks.levels().size(), 3u);
  const StoreBricks own(value_of(Store::open(folder_ / "whole.zarr")), 0, 0);
  for (int level = 0; level < 3; ++level) {
    EXPECT_TRUE(bricks.find_empty_bricks(level));
    const BrickLevel& at = bricks.levels()[static_cast<std::size_t>(level)];
    EXPECT_EQ(at.size, own.levels()[static_cast<std::size_t>(level)].size);
    const Index3 counts = brick_counts(at);
    for (std::uint64_t number = 0; number < static_cast<std::uint64_t>(counts.x) * counts.y * counts.z; ++number) {
      const Index3 brick = brick_at(counts, number), size = brick_size(at, brick);
      const BrickRange known = bricks.range(level, brick);
      std::vector<std::byte> values(std::size_t{2} * size.x * size.y * size.z), expected(values.size());
      ASSERT_TRUE(bricks.read(level, brick, values));
      ASSERT_TRUE(own.read(level, brick, expected));
      EXPECT_EQ(values, expected);
      const BrickRange range = own.range(level, brick);
      EXPECT_TRUE(known.is_known && known.min == range.min && known.max == range.max) << level << " " << number;
    }
  }
  set_level_cache({}, {});
}

TEST_F(LevelCache, EntriesThatWereUsedLongestAgoAreRemoved) {
  test::expect_run(words());
  set_level_cache(folder_ / "cache/catena/levels", {});
  EXPECT_EQ(trim_level_cache(0), 0);  // it has just been used
  const auto set_age = [&](int hours) {
    fs::last_write_time(entry() + "/source", fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  set_age(2);
  EXPECT_EQ(trim_level_cache(folder_bytes(entry())), 0);
  test::expect_run(words());  // uses it
  EXPECT_EQ(trim_level_cache(0), 0);
  set_age(2);
  fs::create_directories(folder_ / "cache/catena/levels/of another program");
  EXPECT_EQ(trim_level_cache(0), 1);
  EXPECT_EQ(entry(), folder_ / "cache/catena/levels/of another program");
  set_level_cache({}, {});
}

TEST_F(LevelCache, AKilledProgramIsContinuedAndChangedDataAreRead) {
  int kills = 0;
  for (std::uintmax_t records = 1; records < 9; records += 2) {
    std::vector<std::string> all = words();
    all.insert(all.begin(), test::program_path());
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    ASSERT_EQ(posix_spawn(&child, all.front().c_str(), nullptr, nullptr, arguments.data(), environ), 0);
    int status = 0;
    std::error_code code;
    while (waitpid(child, &status, WNOHANG) == 0) {
      const std::string log = entry() + "/levels.zarr.part/log";
      if (fs::exists(log, code) && fs::file_size(log, code) >= 48 * records) kill(child, SIGKILL);
      std::this_thread::yield();
    }
    kills += WIFSIGNALED(status);
  }
  EXPECT_GE(kills, 2);
  test::expect_run(words());
  expect_levels_of_import();
  const std::string before = test::read_file(entry() + "/index");
  fs::remove(folder_ / "in.zarr/0/0/0");
  test::expect_run(words());
  EXPECT_NE(test::read_file(entry() + "/index"), before);
  EXPECT_NE(test::run_program("/usr/bin/diff", {"-r", entry() + "/levels.zarr/0", folder_ / "whole.zarr/1"}).exit_code, 0);
}

TEST_F(LevelCache, WithoutAFolderTheErrorNamesTheCause) {
  const auto refused = [&](int code, const std::string& part) {
    const auto result = test::run_catena(words());
    EXPECT_EQ(result.exit_code, code);
    EXPECT_TRUE(has(result.err, "\"crop\" in a scene loads a part")) << result.err;
    EXPECT_TRUE(has(result.err, part)) << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1);
  };
  test::write_file(folder_ / "cache", "a file");
  refused(1, "Not a directory");
  const std::string home = std::getenv("HOME") != nullptr ? std::getenv("HOME") : "";
  unsetenv("XDG_CACHE_HOME");
  unsetenv("HOME");
  refused(2, "HOME or XDG_CACHE_HOME was expected");
  if (!home.empty()) setenv("HOME", home.c_str(), 1);
}

TEST_F(LevelCache, DamagedFilesAreMadeAgain) {
  const std::string expected = test::expect_run(words()).out;
  int number = 0;
  for (const char* name : {"index", "levels.zarr/.zattrs", "levels.zarr/0/.zarray", "levels.zarr/0/0/0/0", "levels.zarr/0/1/1/1"}) {
    const std::string path = entry() + "/" + name;
    std::string text = test::read_file(path);
    if (++number % 2 == 0)
      text.resize(text.size() / 2);
    else
      text[text.size() / 2] = static_cast<char>(text[text.size() / 2] ^ 8);
    test::write_file(path, text);
    EXPECT_EQ(test::expect_run(words()).out, expected) << name;
    expect_levels_of_import();
  }
}

TEST(CachedIndex, AnImportedStoreHasOneUntilAFileChanges) {
  const test::TemporaryFolder folder;
  set_level_cache(folder / "cache", {});
  VoxelSource source{"v", *find_number_type("uint8"), {576, 576, 512}, Mapping::from_linear(Mat3(0.5), Vec3(1, 2, 3))};
  source.fill_value = 3;
  source.is_empty = [](const Index3& brick) { return !(brick == Index3{2, 1, 4}); };
  source.read = [](const Index3&, const Index3&, std::span<std::byte> values) -> Outcome {
    std::ranges::fill(values, std::byte{5});
    values[100] = std::byte{9};
    return Done{};
  };
  const std::string path = folder / "a.zarr";
  BrickIndex all;
  ASSERT_TRUE(write_zarr(path, source, {}, [&](BrickIndex index) -> Outcome {
    all = std::move(index);
    return Done{};
  }));
  cache_index(path, all);
  const auto written = value_of(Store::open(path));
  const auto found = find_cached_levels(*written, 0, 0);
  ASSERT_NE(found, nullptr);
  EXPECT_TRUE(found->levels().empty());
  const StoreBricks bricks(std::make_shared<const StoredLevels>(written, 0, 0, found));
  EXPECT_EQ(bricks.range(0, {2, 1, 4}).max, 9);
  EXPECT_EQ(bricks.range(1, {1, 0, 2}).min, 3);
  EXPECT_FALSE(bricks.range(0, {0, 1, 4}).has_data);
  EXPECT_EQ(bricks.range(0, {0, 1, 4}).max, 3);
  EXPECT_LT(found->index().bytes(), 1000u);
  test::write_file(path + "/0/4/1/2", test::read_file(path + "/0/4/1/2"));  // with another time
  EXPECT_EQ(find_cached_levels(*written, 0, 0), nullptr);
  set_level_cache({}, {});
}

TEST(BrickIndexes, RangesAreWidenedAndBricksWithoutDataAreFree) {
  const Index3 counts{128, 128, 128};
  LevelIndex index(counts, [](std::uint64_t number) { return number % 512 == 3; });
  index.set(515, {true, true, 1e9 + 1, 16777217}, 7);
  BrickIndex all{2, 5, {index}};
  EXPECT_EQ(all.range(2, {2, 0, 0}).min, 5);
  EXPECT_FALSE(all.range(2, {2, 0, 0}).has_data);
  EXPECT_FALSE(all.range(2, {3, 0, 0}).is_known);
  EXPECT_FALSE(all.range(1, {2, 0, 0}).is_known);
  const BrickRange wide = all.range(2, brick_at(counts, 515));
  EXPECT_LE(wide.min, 1e9 + 1);
  EXPECT_GE(wide.max, 16777217);
  EXPECT_EQ(index.checksum(515), 7u);
  EXPECT_LT(all.bytes(), std::uint64_t{500'000});
  std::vector<std::byte> values(24, std::byte{1});
  const std::uint32_t sum = brick_checksum(1, values, {3, 2, 2}, {4, 3, 2});
  values[3] = std::byte{9};  // outside of the voxels
  EXPECT_EQ(brick_checksum(1, values, {3, 2, 2}, {4, 3, 2}), sum);
  values[17] = std::byte{0};
  EXPECT_EQ(brick_checksum(1, values, {3, 2, 2}, {4, 3, 2}) == sum, false);
}

}  // namespace catena::field::level_cache_test
