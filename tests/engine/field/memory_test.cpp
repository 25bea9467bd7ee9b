// SPDX-License-Identifier: MIT
/// Sizes in headers, layouts and scenes are accepted only within the memory limit.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/base/memory_limit.h"
#include "engine/field/analytic/analytic.h"
#include "engine/field/derived/box_downsample.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/support/nifti_file.h"

namespace catena::field::memory_test {

class Memory : public test::FilesTest {
 protected:
  Memory() { set_memory_limit(20'000'000); }
  ~Memory() override { set_memory_limit(std::nullopt); }

  template <class R>
  void expect_refused(const R& result, const std::string& what) {
    test::expect_error(result, {what, "expected at most 20 MB (--memory MB allows more)"});
  }
};

/// A sparse file of 512 GB without a block on the disk.
TEST_F(Memory, ASparseRawFileIsRefused) {
  LoadRequest request = test::request_for(file("sparse.raw", ""));
  std::filesystem::resize_file(request.path, std::uint64_t{4} << 36);
  request.raw = RawLayout{{4096, 4096, 4096}, Vec3(1.0), Vec3(0.0), "float32"};
  test::expect_error(load(request), {"4096 x 4096 x 4096 voxels needs", "(--memory MB allows more)"});  // no levels in the cache
  EXPECT_FALSE(import_as_vdb(request, folder_ / "o.vdb", ""));
  EXPECT_FALSE(test::exists(folder_ / "o.vdb"));
}

TEST_F(Memory, ANiftiHeaderWithAHugeSizeIsRefused) {
  const std::string bytes = catena::test::NiftiFile({400, 400, 400}, 2, 8).bytes();
  // 64 MB of zeros: compressed, this would be a decompression bomb.
  std::filesystem::resize_file(file("a.nii", bytes), 352 + 64'000'000);
  expect_refused(load(test::request_for(folder_ / "a.nii")), "the grid of 400 x 400 x 400 voxels needs");
}

TEST_F(Memory, AFieldOnTooManyNodesIsRefused) {
  const auto sphere = test::value_of(make_analytic("sphere"));
  expect_refused(try_sample_on_grid(sphere, 1024, -2, 2), "1024 nodes per axis");
  EXPECT_TRUE(try_sample_on_grid(sphere, 32, -2, 2));
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

}  // namespace catena::field::memory_test
