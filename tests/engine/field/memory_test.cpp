// SPDX-License-Identifier: MIT
/// Sizes in headers, layouts and scenes are accepted only within the memory limit.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "engine/base/memory_limit.h"
#include "engine/field/analytic/analytic.h"
#include "engine/field/derived/box_downsample.h"
#include "engine/io/volume/load_field.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/support/support.h"

namespace catena::field {
namespace memory_test {

using catena::test::TemporaryFolder;

class Memory : public testing::Test {
 protected:
  Memory() { set_memory_limit(20'000'000); }
  ~Memory() override { set_memory_limit(std::nullopt); }

  void expect_refused(const std::string& message, const std::string& what) {
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find("expected at most 20 MB (--memory MB allows more)"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  TemporaryFolder folder_;
};

/// A sparse file of 512 GB without a block on the disk.
TEST_F(Memory, ASparseRawFileIsRefused) {
  const std::string path = folder_ / "sparse.raw";
  catena::test::write_file(path, "");
  std::filesystem::resize_file(path, std::uint64_t{4} << 36);
  LoadRequest request;
  request.path = path;
  request.raw = RawLayout{{4096, 4096, 4096}, Vec3(1.0), Vec3(0.0), "float32"};
  const auto field = load(request);
  ASSERT_FALSE(field);
  expect_refused(field.error().message, "the grid of 4096 x 4096 x 4096 voxels needs");
  const auto imported = import_as_vdb(request, folder_ / "o.vdb", "");
  ASSERT_FALSE(imported);
  EXPECT_FALSE(catena::test::exists(folder_ / "o.vdb"));
}

TEST_F(Memory, ANiftiHeaderWithAHugeSizeIsRefused) {
  std::string file(352 + 4096, '\0');
  const auto put = [&]<class T>(std::size_t at, T v) { std::memcpy(file.data() + at, &v, sizeof v); };
  put(0, std::int32_t{348});
  for (const auto& [at, n] : {std::pair{40, 3}, {42, 400}, {44, 400}, {46, 400}, {48, 1}, {50, 1}, {52, 1}, {54, 1}, {70, 2}, {72, 8}})
    put(static_cast<std::size_t>(at), static_cast<std::int16_t>(n));
  for (std::size_t d = 0; d < 8; ++d) put(76 + 4 * d, 1.f);
  put(108, 352.f);
  std::memcpy(file.data() + 344, "n+1", 4);
  // 64 MB of zeros: compressed, this would be a decompression bomb.
  catena::test::write_file(folder_ / "a.nii", file);
  std::filesystem::resize_file(folder_ / "a.nii", 352 + 64'000'000);
  LoadRequest request;
  request.path = folder_ / "a.nii";
  const auto field = load(request);
  ASSERT_FALSE(field);
  expect_refused(field.error().message, "the grid of 400 x 400 x 400 voxels needs");
}

TEST_F(Memory, AFieldOnTooManyNodesIsRefused) {
  const auto sphere = make_analytic("sphere");
  ASSERT_TRUE(sphere);
  const auto sampled = try_sample_on_grid(*sphere, 1024, -2, 2);
  ASSERT_FALSE(sampled);
  expect_refused(sampled.error().message, "1024 nodes per axis");
  EXPECT_TRUE(try_sample_on_grid(*sphere, 32, -2, 2));
}

/// Loaded data count against the limit until they are released.
TEST_F(Memory, LoadedDataCountAgainstTheLimit) {
  const test::Block block = test::random_block({128, 128, 64}, 1);
  const std::uint64_t before = available_memory();
  {
    const auto grid = make_scalar_grid("g", {}, block.size, block.values);
    EXPECT_LE(available_memory() + grid->bytes(), before);
    EXPECT_GE(grid->bytes(), block.values.size() * sizeof(float));
  }
  EXPECT_EQ(available_memory(), before);
}

}  // namespace memory_test
}  // namespace catena::field
