// SPDX-License-Identifier: MIT
#include "render/residency/brick_slots.h"

#include <set>

#include "tests/render/support/device_fixture.h"

namespace catena::test::brick_slots_test {

using namespace catena::render;

class BrickSlotAllocation : public DeviceFixture {};

TEST_F(BrickSlotAllocation, EveryBrickHasItsOwnSlotWithinTheImage) {
  for (const std::uint64_t count : {1u, 2u, 7u, 8u, 9u, 1000u, 4099u}) {
    const auto slots = assign_brick_slots(*device_, count, 9);
    ASSERT_TRUE(slots);
    const auto [x, y, z] = slots->slots_per_axis;
    // at most one layer, row or column is partially filled
    EXPECT_LT(std::uint64_t(x) * y * (z - 1), count);
    std::set<std::uint32_t> words;
    for (std::uint64_t slot = 0; slot < count; ++slot) {
      const std::uint32_t word = slots->pack_slot(slot);
      EXPECT_TRUE((word & 255) < x && (word >> 8 & 255) < y && word >> 16 < z) << slot;
      words.insert(word);
    }
    EXPECT_EQ(words.size(), count);
  }
}

TEST_F(BrickSlotAllocation, TooManyBricksAreAnError) {
  const std::uint64_t max_slots = std::min(255u, device_->info().limits.maxImageDimension3D / 9);
  EXPECT_TRUE(assign_brick_slots(*device_, max_slots * max_slots * max_slots, 9));
  const auto slots = assign_brick_slots(*device_, max_slots * max_slots * max_slots + 1, 9);
  ASSERT_FALSE(slots);
  EXPECT_EQ(slots.error().message, std::to_string(max_slots * max_slots * max_slots + 1) + " bricks, at most " +
                                       std::to_string(max_slots * max_slots * max_slots) + " fit");
}

}  // namespace catena::test::brick_slots_test
