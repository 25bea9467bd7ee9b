// SPDX-License-Identifier: MIT
#include "render/residency/half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace catena::test {
namespace half_test {

using namespace catena::render;

TEST(Half, EveryHalfComesBack) {
  for (std::uint32_t h = 0; h < 0x10000; ++h) {
    const float f = float_from_half(std::uint16_t(h));
    if (!std::isfinite(f)) continue;
    ASSERT_EQ(half_from_float(f), h) << f;
  }
}

TEST(Half, RoundsToTheNearestAndTiesToEven) {
  EXPECT_EQ(half_from_float(1.0f + 0x1p-11f), half_from_float(1.0f));
  EXPECT_EQ(half_from_float(1.0f + 3 * 0x1p-11f), half_from_float(1.0f + 0x1p-9f));
  EXPECT_EQ(half_from_float(65504.0f), 0x7bff);
  EXPECT_EQ(half_from_float(1e6f), 0x7c00);
  EXPECT_EQ(half_from_float(-1e6f), 0xfc00);
  std::mt19937 random(3);
  for (int i = 0; i < 200000; ++i) {
    const float value = std::ldexp(std::uniform_real_distribution<float>(-1, 1)(random), int(random() % 42) - 26);
    if (std::fabs(value) > 65504) continue;
    const std::uint16_t h = half_from_float(value);
    const double error = std::fabs(double(float_from_half(h)) - value);
    for (const int step : {-1, 1}) {
      const float other = float_from_half(std::uint16_t(h + step));
      if (std::isfinite(other) && (h & 0x7fff) != 0) {
        ASSERT_LE(error, std::fabs(double(other) - value));
      }
    }
  }
}

}  // namespace half_test
}  // namespace catena::test
