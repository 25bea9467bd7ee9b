// SPDX-License-Identifier: MIT
#include "engine/base/memory_limit.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/results.h"

namespace catena::memory_limit_test {

class MemoryLimit : public testing::Test {
 protected:
  ~MemoryLimit() override { set_memory_limit(std::nullopt); }
};

TEST_F(MemoryLimit, WithoutALimitFreeMemoryApplies) {
  const std::uint64_t allowed = available_memory();
  EXPECT_GT(allowed, 0u);
  EXPECT_TRUE(check_memory_available("it", 1));
  EXPECT_FALSE(check_memory_available("it", 1e18));
  EXPECT_FALSE(check_memory_available("it", std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(check_memory_available("it", std::numeric_limits<double>::quiet_NaN()));
}

TEST_F(MemoryLimit, ReservationsReduceTheAvailableMemory) {
  set_memory_limit(1000000);
  EXPECT_EQ(available_memory(), 1000000u);
  {
    MemoryReservation held(400000);
    EXPECT_EQ(available_memory(), 600000u);
    MemoryReservation moved(std::move(held));
    EXPECT_EQ(available_memory(), 600000u);
    moved = MemoryReservation(1000001);
    EXPECT_EQ(available_memory(), 0u);
  }
  EXPECT_EQ(available_memory(), 1000000u);
}

TEST_F(MemoryLimit, TheErrorMessageHasNeededAndAllowedMemory) {
  set_memory_limit(2000000);
  EXPECT_EQ(test::message_of(check_memory_available("a.raw: the grid of 3 x 4 x 5 voxels", 2000001)),
            "a.raw: the grid of 3 x 4 x 5 voxels needs 3 MB of memory, expected at most 2 MB (--memory MB allows more)");
  EXPECT_TRUE(check_memory_available("it", 2000000));
}

TEST_F(MemoryLimit, SmallTextsAreNeverRefused) {
  set_memory_limit(1000000);
  MemoryReservation held(1000000);
  EXPECT_FALSE(check_memory_available("it", 1000));
  EXPECT_TRUE(check_text_memory_available("it", 1000000));
  EXPECT_FALSE(check_text_memory_available("it", 1000001));
}

}  // namespace catena::memory_limit_test
