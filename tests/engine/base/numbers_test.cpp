// SPDX-License-Identifier: MIT
#include "engine/base/numbers.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace numbers_test {

using catena::parse_double;
using catena::to_text;

TEST(Numbers, EveryDoubleReadsBackExactly) {
  std::uint64_t bits = 0x9e3779b97f4a7c15ull;
  for (int k = 0; k < 20000; ++k) {
    bits ^= bits << 13;
    bits ^= bits >> 7;
    bits ^= bits << 17;
    const double value = std::bit_cast<double>(bits);
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(*parse_double(to_text(value))), bits) << to_text(value);
  }
  for (const double value : {0.0, -0.0, 0.1, 5e-324, std::numeric_limits<double>::max()})
    EXPECT_EQ(std::bit_cast<std::uint64_t>(*parse_double(to_text(value))), std::bit_cast<std::uint64_t>(value));
}

TEST(Numbers, OnlyCompleteTextsAreNumbers) {
  for (const char* good : {"1", " 1 ", "+1", "1e3", "-.5", "1.", "\t2\r"}) EXPECT_TRUE(parse_double(good)) << good;
  for (const char* bad : {"", " ", "1x", "x1", "1 2", "0x10", "1,5", "--1", "+-1", "+"}) EXPECT_FALSE(parse_double(bad)) << bad;
}

TEST(Numbers, UnderflowIsZeroAndOverflowIsRefused) {
  EXPECT_EQ(parse_double("1e-400"), 0.0);
  EXPECT_FALSE(parse_double("1e999"));
}

}  // namespace numbers_test
