// SPDX-License-Identifier: MIT
/// Written OME-Zarr: every voxel of every number type, levels against means computed here, labels, bricks of the fill value, orders of
/// axes, groups of bricks, stores that are completed after an interruption.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

#include "engine/io/stores/store.h"
#include "engine/io/stores/store_voxels.h"
#include "engine/io/zarr/write_zarr.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::field::write_zarr_test {

using test::fails;
using test::value_of;

/// Voxels in memory.
template <class T>
struct Volume {
  Index3 n;
  std::vector<T> values;
  T& at(int x, int y, int z) { return values[(static_cast<std::size_t>(z) * n.y + y) * n.x + x]; }
};

template <class T>
Volume<T> make_volume(const Index3& n) {
  Volume<T> volume{n, std::vector<T>(static_cast<std::size_t>(n.x) * n.y * n.z)};
  std::uint64_t state = 1;
  for (T& value : volume.values) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    const std::uint64_t bits = state >> (64 - 8 * sizeof(T));
    std::memcpy(&value, &bits, sizeof value);
    if constexpr (!std::is_integral_v<T>)
      if (std::fabs(value) < T(1e-30) || std::fabs(value) > T(1e30)) value = static_cast<T>(state >> 60);
  }
  return volume;
}

/// The source of a volume; `reads` counts its voxels that are read, and reading fails beyond `most`.
template <class T>
VoxelSource source_of(Volume<T>& volume, const char* type, std::atomic<int>* reads = nullptr, int most = 1 << 30) {
  VoxelSource source{"v", *find_number_type(type), volume.n, Mapping::from_linear(Mat3(0.5), Vec3(1, 2, 3))};
  source.identity = "test";
  source.read = [&volume, reads, most](const Index3& lo, const Index3& size, std::span<std::byte> values) -> Outcome {
    if (reads != nullptr && ++*reads > most) return Error{"interrupted", true};
    T* out = reinterpret_cast<T*>(values.data());
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) *out++ = volume.at(lo.x + x, lo.y + y, lo.z + z);
    return Done{};
  };
  return source;
}

/// The voxel at half the resolution, computed without the code under test.
template <class T>
T expected_mean(Volume<T>& fine, int x, int y, int z) {
  std::conditional_t<std::is_integral_v<T>, __int128, long double> sum = 0;
  int count = 0;
  for (int k = 2 * z; k < std::min(fine.n.z, 2 * z + 2); ++k)
    for (int j = 2 * y; j < std::min(fine.n.y, 2 * y + 2); ++j)
      for (int i = 2 * x; i < std::min(fine.n.x, 2 * x + 2); ++i)
        if (std::isfinite(static_cast<long double>(fine.at(i, j, k)))) sum += fine.at(i, j, k), ++count;
  if constexpr (!std::is_integral_v<T>) return static_cast<T>(sum / count);
  // rounded to the nearest, halves up
  __int128 mean = static_cast<__int128>(sum) / count - 1;
  while (2 * count * (mean + 1) <= 2 * static_cast<__int128>(sum) + count) ++mean;
  return static_cast<T>(mean);
}

template <class T>
bool is_same(T a, T b) {
  if constexpr (std::is_integral_v<T>)
    return a == b;
  else  // one rounding of the sum
    return std::isnan(a) ? std::isnan(b) : std::fabs(a - b) <= std::fabs(b) * std::numeric_limits<T>::epsilon() * 4;
}

std::map<std::string, std::string> files_of(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[entry.path().string().substr(folder.size())] = test::read_file(entry.path().string());
  return files;
}

class WriteZarr : public testing::Test {
 protected:
  template <class T>
  Volume<T> read_level(const std::shared_ptr<Store>& store, int level) {
    const Index3 n = store->description().grids[0].levels[static_cast<std::size_t>(level)].size;
    Volume<T> volume{n, std::vector<T>(static_cast<std::size_t>(n.x) * n.y * n.z)};
    const Outcome got = store->read(0, level, 0, {{0, 0, 0}, n}, std::as_writable_bytes(std::span(volume.values)));
    EXPECT_TRUE(got) << test::message_of(got);
    return volume;
  }

  /// Writes a volume and compares all levels.
  template <class T>
  void check(const char* type, const Index3& n, int level_count, bool is_label_map = false) {
    SCOPED_TRACE(type);
    Volume<T> volume = make_volume<T>(n);
    if constexpr (!std::is_integral_v<T>)
      for (int i = 0; i < 9; ++i) volume.at(i % 3, i / 3, 0) = i % 2 != 0 ? std::numeric_limits<T>::quiet_NaN() : T(INFINITY);
    const std::string path = folder_ / (std::string(type) + (is_label_map ? "l" : "") + ".zarr");
    VoxelSource source = source_of(volume, type);
    source.units.is_label_map = is_label_map;
    const Outcome written = write_zarr(path, source);
    ASSERT_TRUE(written) << test::message_of(written);
    const auto store = value_of(Store::open(path));
    const StoreGrid& grid = store->description().grids.at(0);
    EXPECT_EQ(grid.type, type);
    EXPECT_EQ(grid.is_label_map, is_label_map);
    ASSERT_EQ(grid.levels.size(), static_cast<std::size_t>(level_count));
    Volume<T> fine = read_level<T>(store, 0);
    EXPECT_EQ(std::memcmp(fine.values.data(), volume.values.data(), fine.values.size() * sizeof(T)), 0);
    for (int level = 1; level < level_count; ++level) {
      Volume<T> coarse = read_level<T>(store, level);
      EXPECT_EQ(coarse.n, (Index3{(fine.n.x + 1) / 2, (fine.n.y + 1) / 2, (fine.n.z + 1) / 2}));
      int wrong = 0;
      for (int z = 0; z < coarse.n.z; ++z)
        for (int y = 0; y < coarse.n.y; ++y)
          for (int x = 0; x < coarse.n.x; ++x)
            wrong += !is_same(coarse.at(x, y, z), is_label_map ? fine.at(2 * x, 2 * y, 2 * z) : expected_mean(fine, x, y, z));
      EXPECT_EQ(wrong, 0) << level;
      // centers at the mean of the voxels that are covered
      const Mapping& mapping = grid.levels[static_cast<std::size_t>(level)].mapping;
      const double shift = 0.5 * ((1 << level) - 1) / 2;
      EXPECT_EQ(mapping.origin, Vec3(1 + shift, 2 + shift, 3 + shift));
      EXPECT_EQ(mapping.world_from_index_linear[2][2], 0.5 * (1 << level));
      fine = std::move(coarse);
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(WriteZarr, EveryNumberTypeAndItsLevels) {
  const Index3 odd{131, 70, 67};
  check<std::uint8_t>("uint8", odd, 3);
  check<std::int8_t>("int8", odd, 3);
  check<std::uint16_t>("uint16", odd, 3);
  check<std::int16_t>("int16", odd, 3);
  check<std::uint32_t>("uint32", odd, 3);
  check<std::int32_t>("int32", odd, 3);
  check<std::int64_t>("int64", {66, 65, 3}, 2);
  check<std::uint64_t>("uint64", {66, 65, 3}, 2);
  check<float>("float32", odd, 3);
  check<double>("float64", odd, 3);
  check<std::uint16_t>("uint16", {64, 64, 64}, 1, true);
  check<std::int32_t>("int32", odd, 3, true);
}

TEST_F(WriteZarr, BricksOfTheFillValueAreNotStored) {
  Volume<float> volume = make_volume<float>({200, 130, 100});
  for (int z = 0; z < 64; ++z)
    for (int y = 0; y < 128; ++y)
      for (int x = 64; x < 192; ++x) volume.at(x, y, z) = NAN;
  VoxelSource source = source_of(volume, "float32");
  source.fill_value = NAN;
  ASSERT_TRUE(write_zarr(folder_ / "a.zarr", source));
  EXPECT_TRUE(test::exists(folder_ / "a.zarr/0/0/0/0"));
  EXPECT_FALSE(test::exists(folder_ / "a.zarr/0/0/0/1"));
  EXPECT_FALSE(test::exists(folder_ / "a.zarr/0/0/1/2"));
  EXPECT_TRUE(test::exists(folder_ / "a.zarr/1/0/0/1"));
  const auto store = value_of(Store::open(folder_ / "a.zarr"));
  EXPECT_TRUE(std::isnan(read_level<float>(store, 0).at(64, 0, 0)));
  // bricks that are known to be empty are not read
  std::atomic<int> reads = 0;
  source = source_of(volume, "float32", &reads);
  source.fill_value = NAN;
  source.is_empty = [](const Index3& brick) { return brick.z == 0 && brick.y < 2 && (brick.x == 1 || brick.x == 2); };
  ASSERT_TRUE(write_zarr(folder_ / "b.zarr", source));
  EXPECT_EQ(reads, 4 * 3 * 2 - 4);
  EXPECT_EQ(files_of(folder_ / "a.zarr"), files_of(folder_ / "b.zarr"));
}

TEST_F(WriteZarr, AnInterruptedStoreIsCompletedWithoutReadingAgain) {
  Volume<std::int16_t> volume = make_volume<std::int16_t>({300, 140, 150});
  for (int z = 0; z < 64; ++z)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 128; ++x) volume.at(x, y, z) = 0;
  ASSERT_TRUE(write_zarr(folder_ / "whole.zarr", source_of(volume, "int16")));
  constexpr int kBricks = 5 * 3 * 3;
  std::atomic<int> reads = 0;
  const auto write = [&](int most, const std::string& identity = "test") {
    reads = 0;
    VoxelSource source = source_of(volume, "int16", &reads, most);
    source.identity = identity;
    return write_zarr(folder_ / "a.zarr", source);
  };
  int done = 0;
  for (const int most : {0, 1, 7, 20}) {
    EXPECT_TRUE(fails(write(most), "interrupted; the same command continues"));
    done += most;
    EXPECT_FALSE(test::exists(folder_ / "a.zarr"));
  }
  EXPECT_TRUE(fails(write(1, "another"), "an unfinished store of another input"));
  EXPECT_EQ(reads, 0);
  std::filesystem::resize_file(folder_ / "a.zarr.part/log", std::filesystem::file_size(folder_ / "a.zarr.part/log") - 3);
  const Outcome completed = write(kBricks);
  ASSERT_TRUE(completed) << test::message_of(completed);
  EXPECT_LE(reads, kBricks - done + 1);  // the last record was cut
  EXPECT_EQ(files_of(folder_ / "a.zarr"), files_of(folder_ / "whole.zarr"));
  EXPECT_FALSE(test::exists(folder_ / "a.zarr.part"));
  EXPECT_TRUE(fails(write(kBricks), "a store is never overwritten"));
}

TEST_F(WriteZarr, GroupsOfBricksGiveTheSameStore) {
  Volume<std::uint8_t> volume = make_volume<std::uint8_t>({200, 150, 140});
  ASSERT_TRUE(write_zarr(folder_ / "whole.zarr", source_of(volume, "uint8")));
  std::atomic<int> reads = 0;
  for (const int most : {3, 1000}) {
    VoxelSource source = source_of(volume, "uint8", &reads, most);
    source.bricks_at_once = {4, 2, 1};
    EXPECT_EQ(bool(write_zarr(folder_ / "a.zarr", source)), most == 1000);
  }
  EXPECT_LE(reads, 2 * 3 + 2);
  EXPECT_EQ(files_of(folder_ / "a.zarr"), files_of(folder_ / "whole.zarr"));
}

TEST_F(WriteZarr, GroupsCoverChunksWithinTheMemory) {
  const auto group = [](const Index3& size, const Index3& chunk, double bytes) { return bricks_that_share_chunks(size, chunk, 2, bytes); };
  const Index3 one{1, 1, 1}, size{1024, 1024, 1024};
  EXPECT_EQ(group(size, {64, 64, 64}, 1e8), one);
  EXPECT_EQ(group(size, {32, 16, 1}, 1e8), one);
  EXPECT_EQ(group(size, {1024, 1024, 1}, 2e8), (Index3{16, 16, 1}));
  EXPECT_EQ(group(size, {1024, 1024, 1}, 1e8), (Index3{16, 8, 1}));
  EXPECT_EQ(group(size, {256, 256, 256}, 1e8), (Index3{4, 4, 4}));
  EXPECT_EQ(group({40, 50, 60}, {40, 50, 60}, 1e8), one);
  const Index3 unaligned = group(size, {100, 100, 100}, 1e8);
  EXPECT_GE(unaligned.x * unaligned.y * unaligned.z, 64);
}

TEST_F(WriteZarr, PermutedAndMirroredAxesAreReordered) {
  Volume<std::uint16_t> volume = make_volume<std::uint16_t>({90, 70, 30});
  VoxelSource source = source_of(volume, "uint16");
  Mat3 linear(0.0);
  linear[0][2] = -2;  // the first axis against z, the second along x, the third against y
  linear[1][0] = 0.5;
  linear[2][1] = -1;
  source.mapping = Mapping::from_linear(linear, Vec3(5, 6, 7));
  ASSERT_TRUE(write_zarr(folder_ / "a.zarr", source));
  const auto store = value_of(Store::open(folder_ / "a.zarr"));
  Volume<std::uint16_t> written = read_level<std::uint16_t>(store, 0);
  const Mapping& mapping = store->description().grids[0].levels[0].mapping;
  int wrong = 0;
  for (int z = 0; z < 30; ++z)
    for (int y = 0; y < 70; ++y)
      for (int x = 0; x < 90; ++x) {
        const Vec3 at = mapping.index_from_world(source.mapping.world_from_index(Vec3(x, y, z))) + Vec3(0.5);
        wrong += written.at(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)) != volume.at(x, y, z);
      }
  EXPECT_EQ(wrong, 0);
  linear[0][0] = 0.2;
  source.mapping = Mapping::from_linear(linear, Vec3(0.0));
  EXPECT_TRUE(fails(write_zarr(folder_ / "b.zarr", source), "b.zarr: the axes are rotated or sheared"));
  EXPECT_FALSE(test::exists(folder_ / "b.zarr.part"));
}

}  // namespace catena::field::write_zarr_test
