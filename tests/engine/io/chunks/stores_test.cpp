// SPDX-License-Identifier: MIT
/// Stores of chunks: every voxel, levels within the memory limit, crops, bricks and their ranges, errors, readers that die.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>

#include "engine/base/memory_limit.h"
#include "engine/io/client.h"
#include "engine/io/levels/level_cache.h"
#include "engine/io/stores/load_store.h"
#include "engine/io/stores/store.h"
#include "engine/io/stores/store_bricks.h"
#include "engine/io/volume/units.h"
#include "tests/engine/io/chunks/store_files.h"
#include "tests/support/results.h"

namespace catena::field::stores_test {

using catena::stores_test::Volume;
using catena::stores_test::ZarrOptions;
using test::fails;
using test::has;
using test::value_of;

class Stores : public testing::Test {
 protected:
  ~Stores() override {
    set_memory_limit(std::nullopt);
    set_max_whole_level(kNoMaxWholeLevel);
    set_level_cache({}, {});
    reader_settings() = {};
  }

  /// Counts the voxels of a store that differ from the volume, except in a box.
  static int count_wrong(const std::string& path, const Volume& v, const StoreBox& except = {}, int fill = 7) {
    const auto store = value_of(Store::open(path));
    std::vector<std::uint16_t> values(static_cast<std::size_t>(v.x) * static_cast<std::size_t>(v.y) * static_cast<std::size_t>(v.z));
    const Outcome got = store->read(0, 0, 0, {{0, 0, 0}, {v.x, v.y, v.z}}, std::as_writable_bytes(std::span(values)));
    EXPECT_TRUE(got) << test::message_of(got);
    int wrong = 0;
    std::size_t at = 0;
    const auto in = [](int n, int lo, int size) { return n >= lo && n < lo + size; };
    for (int k = 0; k < v.z; ++k)
      for (int j = 0; j < v.y; ++j)
        for (int i = 0; i < v.x; ++i) {
          const bool is_missing =
              in(i, except.lo.x, except.size.x) && in(j, except.lo.y, except.size.y) && in(k, except.lo.z, except.size.z);
          wrong += values[at++] != (is_missing ? fill : Volume::value(i, j, k));
        }
    return wrong;
  }

  /// Writes the volume as .npy: order F (a[z][y][x] with z fastest) or C, swapped or not.
  static void write_npy(const std::string& path, const Volume& v, bool fortran, bool swapped) {
    std::string head = fmt::format("{{'descr': '{}u2', 'fortran_order': {}, 'shape': ({}, {}, {}), }}", swapped ? '>' : '<',
                                   fortran ? "True" : "False", v.z, v.y, v.x);
    head.resize(118, ' ');
    std::ofstream out(path, std::ios::binary);
    out << std::string("\x93NUMPY\x01\x00\x76\x00", 10) << head;
    for (int a = 0; a < (fortran ? v.x : v.z); ++a)
      for (int j = 0; j < v.y; ++j)
        for (int c = 0; c < (fortran ? v.z : v.x); ++c) {
          const std::uint16_t value = fortran ? Volume::value(a, j, c) : Volume::value(c, j, a);
          const char bytes[] = {static_cast<char>(value & 0xff), static_cast<char>(value >> 8)};
          out << bytes[swapped ? 1 : 0] << bytes[swapped ? 0 : 1];
        }
  }

  static Result<AnyField> load_grid(const std::string& path, int level = 0, std::optional<Box> crop = {}, const std::string& grid = {}) {
    LoadRequest request;
    request.path = path;
    request.level = level;
    request.crop = crop;
    request.grid = grid;
    return load(request);
  }

  test::TemporaryFolder folder_;
};

TEST_F(Stores, EveryVoxelOfZarr) {
  int number = 0;
  for (const char* codec : {"none", "zlib", "gzip", "blosc", "zstd", "lz4"})
    for (const bool fortran : {false, true})
      for (const char* type : {"<u2", ">u2"}) {
        const std::string path = folder_ / fmt::format("{}.zarr", number++);
        catena::stores_test::write_zarr(path, {},
                                        {codec, type, number % 2 != 0 ? "." : "/", fortran, 32, number % 2 != 0 ? "0.1.1" : "0/1/1"});
        EXPECT_EQ(count_wrong(path, {}, {{32, 32, 0}, {32, 32, 32}}), 0) << codec << fortran << type;
      }
}

TEST_F(Stores, EveryVoxelOfArrays) {
  const Volume v;
  for (const bool fortran : {false, true})
    for (const bool swapped : {false, true}) {
      write_npy(folder_ / "a.npy", v, fortran, swapped);
      EXPECT_EQ(count_wrong(folder_ / "a.npy", v), 0) << fortran << swapped;
    }
  // the same voxels from a box in the middle, from the index of another order, and from numbers without a header
  LoadRequest request;
  request.path = folder_ / "a.npy";
  request.axes_xyz = true;
  std::vector<std::uint16_t> box(6);
  EXPECT_TRUE(value_of(find_store(request))->read(0, 0, 0, {{5, 6, 7}, {1, 2, 3}}, std::as_writable_bytes(std::span(box))));
  EXPECT_EQ(box[3], Volume::value(8, 7, 5));
  std::ofstream(folder_ / "a.raw", std::ios::binary) << test::read_file(folder_ / "a.npy").substr(128);
  request = {};
  request.path = folder_ / "a.raw";
  request.raw = RawLayout{{v.z, v.y, v.x}, Vec3(2.0), Vec3(1.0), "uint16"};
  const auto raw = value_of(find_store(request));
  EXPECT_TRUE(raw->read(0, 0, 0, {{7, 6, 5}, {1, 1, 1}}, std::as_writable_bytes(std::span(box).first(1))));
  EXPECT_EQ(box[0] >> 8 | (box[0] & 0xff) << 8, Volume::value(5, 6, 7));
  EXPECT_EQ(raw->description().grids[0].levels[0].mapping.world_from_index(Vec3(1, 0, 0)), Vec3(3, 1, 1));
}

TEST_F(Stores, LargeArraysAreReadInBricks) {
  const Volume v;
  write_npy(folder_ / "a.npy", v, false, false);
  EXPECT_EQ(value_of(load_grid(folder_ / "a.npy")).paged, nullptr);
  set_level_cache(folder_ / "cache", {});
  set_max_whole_level(100'000);
  const AnyField field = value_of(load_grid(folder_ / "a.npy"));
  const auto crop = load_grid(folder_ / "a.npy", 1, Box{Vec3(30, 20, 10), Vec3(34, 24, 14)});
  EXPECT_TRUE(field.paged && has(field.notes.front(), "level 1 of 2, 35 x 25 x 20 of 70 x 50 x 40 voxels: volumes"));
  EXPECT_TRUE(crop) << test::message_of(crop);
  std::filesystem::resize_file(folder_ / "a.npy", 1000);
  EXPECT_TRUE(fails(load_grid(folder_ / "a.npy"), "expected 280000"));
}

TEST_F(Stores, EveryVoxelOfTiffAndHdf5) {
  for (const bool tiled : {false, true})
    for (const char* mode : {"w8", "wb", "wl"}) {
      catena::stores_test::write_tiff(folder_ / "a.tif", {}, tiled, mode);
      EXPECT_EQ(count_wrong(folder_ / "a.tif", {}), 0) << tiled << mode;
    }
  std::filesystem::create_directory(folder_ / "stack");
  for (int k = 0; k < 12; ++k) catena::stores_test::write_tiff(folder_ / fmt::format("stack/s{}.tif", k + 1), {70, 50, 1}, true, "w", k);
  EXPECT_EQ(count_wrong(folder_ / "stack", {70, 50, 12}), 0);
  for (const bool chunked : {false, true}) {
    catena::stores_test::write_hdf5(folder_ / "a.h5", {}, "/group/a", chunked);
    EXPECT_EQ(count_wrong(folder_ / "a.h5", {}), 0) << chunked;
    EXPECT_EQ(value_of(describe_grids(folder_ / "a.h5")).front().name, "group/a");
  }
}

TEST_F(Stores, TheFinestLevelWithinTheMemoryLimitIsLoaded) {
  const std::string path = folder_ / "p.zarr";
  catena::stores_test::write_ome_zarr(path, 3);
  const GridInfo info = value_of(describe_grids(path)).front();
  EXPECT_EQ(info.name, "DAPI");
  EXPECT_EQ(info.levels.size(), 3u);
  EXPECT_EQ(info.color, 0x00ff00);
  EXPECT_EQ(info.window, (std::vector<double>{5, 900}));
  EXPECT_EQ(read_units(path, "").length, "µm");
  {
    const AnyField full = value_of(load_grid(path));
    EXPECT_TRUE(full.notes.empty());
    EXPECT_EQ(full.get()->index_box().hi.x, 127);
    const AnyField coarse = value_of(load_grid(path, 1));
    EXPECT_EQ(coarse.get()->index_box().hi.x, 63);
    EXPECT_TRUE(has(coarse.notes.front(), "level 1 of 3, 64 x 64 x 64 of 128 x 128 x 128 voxels"));
    // the third level is the last in the store: it is reduced once more
    EXPECT_EQ(value_of(load_grid(path, 3)).get()->index_box().hi.x, 15);
  }
  set_max_whole_level(128 * 128 * 128 - 1);
  {
    const AnyField in_bricks = value_of(load_grid(path));
    EXPECT_TRUE(in_bricks.paged && has(in_bricks.notes.front(), "level 1 of 3, 64 x 64 x 64 of 128 x 128 x 128 voxels: volumes"));
    EXPECT_FALSE(value_of(load_grid(path, 1)).paged);
  }
  set_max_whole_level(kNoMaxWholeLevel);
  set_memory_limit(5'000'000);
  {
    const AnyField less = value_of(load_grid(path));
    ASSERT_FALSE(less.notes.empty());
    EXPECT_TRUE(has(less.notes.front(), "level 1 of 3, 64 x 64 x 64 of 128 x 128 x 128 voxels: the memory limit"));
  }
  // within the same limit a small box has full resolution
  const AnyField part = value_of(load_grid(path, 0, Box{Vec3(10), Vec3(20)}));
  Cursor cursor;
  EXPECT_EQ(part.scalar->sample({12, 11.5, 15}, cursor).value, Volume::value(24, 23, 30));
  EXPECT_EQ(part.scalar->min_value(), Volume::value(20, 20, 20));
  EXPECT_TRUE(fails(load_grid(path, 0, Box{Vec3(100), Vec3(110)}), "contains no voxels"));
  set_memory_limit(300'000);
  EXPECT_TRUE(fails(load_grid(path), "the store has no coarser level"));
}

TEST_F(Stores, BricksHaveRanges) {
  const std::string path = folder_ / "a.zarr";
  catena::stores_test::write_zarr(path, {130, 70, 65}, {"blosc", "<u2", ".", false, 64, "0.0.0"});
  const StoreBricks bricks(value_of(Store::open(path)), 0, 0);
  const BrickLevel& level = bricks.levels().front();
  EXPECT_EQ(brick_counts(level), (Index3{3, 2, 2}));
  EXPECT_EQ(brick_size(level, {2, 1, 1}), (Index3{2, 6, 1}));
  std::vector<std::uint16_t> values(12);
  EXPECT_FALSE(bricks.range(0, {2, 1, 1}).is_known);
  ASSERT_TRUE(bricks.read(0, {2, 1, 1}, std::as_writable_bytes(std::span(values))));
  EXPECT_EQ(values.front(), Volume::value(128, 64, 64));
  EXPECT_EQ(values.back(), Volume::value(129, 69, 64));
  EXPECT_TRUE(bricks.range(0, {2, 1, 1}).is_known);
  EXPECT_EQ(bricks.range(0, {2, 1, 1}).max, *std::ranges::max_element(values));
  ASSERT_TRUE(bricks.find_empty_bricks(0));
  EXPECT_FALSE(bricks.range(0, {0, 0, 0}).has_data);
  EXPECT_EQ(bricks.range(0, {0, 0, 0}).min, 7);
  EXPECT_TRUE(bricks.range(0, {1, 0, 0}).has_data);
}

TEST_F(Stores, WhatIsWrongIsASentence) {
  const std::string path = folder_ / "a.zarr";
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = catena::stores_test::zarray({}, {});
    text.replace(text.find(from), from.size(), to);
    test::write_file(path + "/.zarray", text);
    return load_grid(path);
  };
  catena::stores_test::write_zarr(path, {}, {});
  EXPECT_TRUE(fails(with("\"blosc\"", "\"lzma\""), "the compressor \"lzma\" is not supported"));
  EXPECT_TRUE(fails(with("[40, 50, 70]", "[40, 50]"), "differ in length"));
  EXPECT_TRUE(fails(with("\"<u2\"", "\"<f2\""), "dtype is \"<f2\""));
  EXPECT_TRUE(fails(with("\"<u2\"", "\"<u4\""), "has 65536 bytes when decompressed, expected 131072"));
  EXPECT_TRUE(fails(with("[32, 32, 32]", "[9000, 9000, 9000]"), "a chunk has"));
  EXPECT_TRUE(fails(with("\"zarr_format\": 2", "\"zarr_format\": 3"), "expected 2"));
  // 1e9 chunks and more: nothing depends on their number
  EXPECT_TRUE(fails(with("[40, 50, 70]", "[16000000, 16000000, 16000000]"), "a smaller grid"));
  EXPECT_TRUE(fails(with("[40, 50, 70]", "[100000, 1000, 1000]"), "MB of memory"));
  test::write_file(path + "/.zarray", catena::stores_test::zarray({}, {}));
  test::write_file(path + "/0.0.0", "x");
  EXPECT_TRUE(fails(load_grid(path), "the chunk 0.0.0 is not a blosc buffer"));
  std::filesystem::create_directory(folder_ / "v3.zarr");
  test::write_file(folder_ / "v3.zarr/zarr.json", "{}");
  EXPECT_TRUE(fails(load_grid(folder_ / "v3.zarr"), "version 3"));
  std::filesystem::create_directory(folder_ / "plate.zarr");
  test::write_file(folder_ / "plate.zarr/.zattrs", R"({"plate": {}})");
  EXPECT_TRUE(fails(load_grid(folder_ / "plate.zarr"), "this is a plate of wells"));
  // pages of a TIFF file that are a loop: the last directory points to the first
  catena::stores_test::write_tiff(folder_ / "a.tif", {20, 20, 1}, false, "wl");
  std::string tiff = test::read_file(folder_ / "a.tif");
  std::uint32_t first = 0;
  std::uint16_t entries = 0;
  std::memcpy(&first, tiff.data() + 4, 4);
  std::memcpy(&entries, tiff.data() + first, 2);
  std::memcpy(tiff.data() + first + 2 + 12 * entries, &first, 4);
  test::write_file(folder_ / "a.tif", tiff);
  EXPECT_TRUE(fails(load_grid(folder_ / "a.tif"), "its pages are a loop"));
  test::write_file(folder_ / "a.h5", "x");
  EXPECT_TRUE(fails(load_grid(folder_ / "a.h5"), "is not an HDF5 file"));
}

/// Kills the readers of this process; returns their number.
int kill_readers() {
  int killed = 0;
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    std::ifstream in(process.path() / "stat");
    std::string pid, name, state;
    int parent = 0;
    if (!(in >> pid >> name >> state >> parent) || parent != ::getpid() || name != "(catena-read-chu)") continue;
    killed += ::kill(std::stoi(pid), SIGKILL) == 0;
  }
  return killed;
}

TEST_F(Stores, AReaderThatDiesIsReplaced) {
  const std::string path = folder_ / "a.zarr";
  catena::stores_test::write_zarr(path, {}, {});
  const auto store = value_of(Store::open(path));
  std::vector<std::uint16_t> values(1000);
  const auto read = [&] { return store->read(0, 0, 0, {{0, 0, 0}, {10, 10, 10}}, std::as_writable_bytes(std::span(values))); };
  ASSERT_TRUE(read());
  EXPECT_GE(kill_readers(), 1);
  values.assign(values.size(), 0);
  const Outcome again = read();
  ASSERT_TRUE(again) << test::message_of(again);
  EXPECT_EQ(values.back(), Volume::value(9, 9, 9));
  // one that cannot be started again
  kill_readers();
  reader_settings().program = "/nowhere/catena-read-chunks";
  EXPECT_TRUE(fails(read(), "cannot be read"));
  reader_settings().program.clear();
  EXPECT_TRUE(read());
  // the store is another one
  kill_readers();
  catena::stores_test::write_zarr(path, {60, 50, 40}, {});
  EXPECT_TRUE(fails(read(), "the store has changed"));
}

TEST_F(Stores, AReaderThatHangsOrCrashesIsASentence) {
  const std::string path = folder_ / "a.zarr", program = folder_ / "reader";
  catena::stores_test::write_zarr(path, {}, {});
  const auto with = [&](const char* script) {
    test::write_file(program, std::string("#!/bin/sh\n") + script + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    reader_settings().program = program;
    reader_settings().wall_s = 0.5;
    return Store::open(path);
  };
  EXPECT_TRUE(fails(with("exec sleep 20"), "did not answer in time"));
  EXPECT_TRUE(fails(with("kill -SEGV $$"), "crashed"));
  EXPECT_TRUE(fails(with("exit 1"), "could not be started"));
}

}  // namespace catena::field::stores_test
