// SPDX-License-Identifier: MIT
#include "render/residency/packed_volume.h"

#include <algorithm>
#include <cmath>

#include "render/residency/brick_map.h"
#include "render/vk/commands.h"
#include "tests/render/support/device_fixture.h"

namespace catena::test::packed_volume_test {

using namespace catena::render;

class PackedVolumeRoundTrip : public DeviceFixture {};

TEST_F(PackedVolumeRoundTrip, RangesIncludeEveryVoxelOfTheirBrick) {
  const field::Index3 n{13, 9, 6};
  std::vector<float> values;
  for (int i = 0; i < n.x * n.y * n.z; ++i) values.push_back(float(std::fmod(i * 0.37, 1.0)));
  const auto grid = field::make_scalar_grid("density", {}, n, values);
  const auto packed = make_packed_volume(*device_, *grid, {0, 1});
  ASSERT_TRUE(packed);
  EXPECT_EQ(packed->bricks, (std::array<std::int32_t, 3>{3, 2, 2}));
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        const double code = (values[(z * n.y + y) * n.x + x] - packed->codes.lo) / packed->codes.per_code;
        const int b = (std::min(z / 4, 1) * 2 + std::min(y / 4, 1)) * 3 + std::min(x / 4, 2);
        EXPECT_GE(code, packed->ranges[b].min - 0.51);
        EXPECT_LE(code, packed->ranges[b].max + 0.51);
      }
}

TEST_F(PackedVolumeRoundTrip, UnpackableGridsAreErrors) {
  std::vector<float> values(64, 1.0f);
  EXPECT_TRUE(can_pack_dense(*device_, *field::make_scalar_grid("d", {}, {4, 4, 4}, values)));
  EXPECT_FALSE(can_pack_dense(*device_, *field::make_scalar_grid("d", {}, {8, 8, 1}, values)));
  const std::int32_t too_long = std::int32_t(device_->info().limits.maxImageDimension3D) + 1;
  EXPECT_FALSE(
      can_pack_dense(*device_, *field::make_scalar_grid("d", {}, {too_long, 2, 2}, std::vector<float>(std::size_t(4) * too_long, 1.0f))));
}

TEST(EmptySpaceDistances, MatchBruteForce) {
  const std::array<std::int32_t, 3> n{9, 7, 8};
  std::vector<std::uint16_t> kind;
  for (int i = 0; i < 9 * 7 * 8; ++i) kind.push_back(std::uint16_t(i % 9 < 3 ? 1 : i % 97 == 5 ? 0 : 2));
  const auto found = homogeneous_distances(n, kind);
  for (int i = 0; i < int(kind.size()); ++i) {
    const int x = i % 9, y = i / 9 % 7, z = i / 63;
    int expected = kind[i] ? 255 : 0;
    for (int j = 0; j < int(kind.size()); ++j)
      if (kind[j] != kind[i]) expected = std::min(expected, std::max({std::abs(j % 9 - x), std::abs(j / 9 % 7 - y), std::abs(j / 63 - z)}));
    EXPECT_EQ(found[i], expected) << x << " " << y << " " << z;
  }
}

}  // namespace catena::test::packed_volume_test
