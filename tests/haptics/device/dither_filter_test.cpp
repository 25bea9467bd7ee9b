// SPDX-License-Identifier: MIT
#include "haptics/device/dither_filter.h"

#include <gtest/gtest.h>

#include <random>

namespace catena::dither_filter_test {
using haptics::DitherFilter;

constexpr double kStep = 5.5e-5;

Vec3 encoded(const Vec3& x) { return {std::round(x.x / kStep) * kStep, std::round(x.y / kStep) * kStep, std::round(x.z / kStep) * kStep}; }

TEST(DitherFilter, RemovesTheDitherOfARestingHand) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.15 * kStep);
  std::uniform_real_distribution<double> anywhere(-0.1, 0.1);
  for (const double rate : {250.0, 1000.0, 4000.0})
    for (int hand = 0; hand < 50; ++hand) {
      DitherFilter pose(kStep, rate);
      const Vec3 at(anywhere(random), anywhere(random), anywhere(random));
      double read = 0, used = 0;
      Vec3 last_read(0.0), last_used(0.0);
      for (int i = 0; i < 2 * static_cast<int>(rate); ++i) {
        const Vec3 x = encoded(at + Vec3(noise(random), noise(random), noise(random))), y = pose.filter(x);
        ASSERT_LE(max_abs(y - x), kStep * (1 + 1e-6));
        if (i > rate / 10) {
          read += dot(x - last_read, x - last_read);
          used += dot(y - last_used, y - last_used);
        }
        last_read = x;
        last_used = y;
      }
      EXPECT_LE(1000 * std::sqrt(used / rate), 0.02) << "newtons at 1000 N/m, rms, where " << 1000 * std::sqrt(read / rate) << " were read";
    }
}

TEST(DitherFilter, PassesAMovingHandInTheSameTick) {
  for (const double speed : {0.005, 0.05, 0.5}) {
    DitherFilter pose(kStep, 1000);
    for (int i = 0; i < 1000; ++i) pose.filter(encoded(Vec3(0.0)));
    int late = 0;
    for (int i = 1; i < 2000; ++i) {
      const Vec3 x = encoded(Vec3(1e-3 * speed * i, -3e-4 * speed * i, 0));
      late += pose.filter(x) != x ? 1 : 0;
    }
    EXPECT_LE(late, 2 * kStep / (1e-3 * speed) + 1) << "but for the first two steps of the encoder";
  }
}

TEST(DitherFilter, WithoutAnEncoderStepThePositionIsUnchanged) {
  DitherFilter pose(0, 1000);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(pose.filter(Vec3(1e-9 * i)), Vec3(1e-9 * i));
}

}  // namespace catena::dither_filter_test
