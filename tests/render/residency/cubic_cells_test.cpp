// SPDX-License-Identifier: MIT
// Cells in which a cubic field may have a value: by dense sampling none is missing, and few are superfluous.
#include "render/residency/cubic_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/field/cubic.h"

namespace catena::test::cubic_cells_test {

using namespace catena::render;

struct Count {
  int holding = 0, named = 0;
};

Count count(const std::vector<float>& samples, float value) {
  const auto rows = find_cubic_cells(samples, value, 0);
  Count found;
  for (int z = 0; z < kBrickSize; ++z)
    for (int y = 0; y < kBrickSize; ++y)
      for (int x = 0; x < kBrickSize; ++x) {
        field::CubicSamples<1> cell;
        for (int n = 0; n < 64; ++n)
          cell[std::size_t(n)] = samples[std::size_t(((z + (n >> 4)) * kCubicSamples + y + (n >> 2 & 3)) * kCubicSamples + x + (n & 3))];
        bool above = false, below = false;
        constexpr int kSteps = 8;
        for (int n = 0; n < (kSteps + 1) * (kSteps + 1) * (kSteps + 1); ++n) {
          const Vec3 place(n % (kSteps + 1), n / (kSteps + 1) % (kSteps + 1), n / (kSteps + 1) / (kSteps + 1));
          const double v = field::cubic_within<1>(cell, place / double(kSteps)).value[0];
          above = above || v >= value;
          below = below || v < value;
        }
        const bool named = (rows[std::size_t(y + kBrickSize * z)] >> x & 1) != 0;
        EXPECT_TRUE(named || !(above && below)) << x << " " << y << " " << z;
        found.holding += above && below;
        found.named += named;
      }
  return found;
}

std::vector<float> made_of(const std::function<double(const Vec3&)>& f) {
  std::vector<float> samples;
  for (int n = 0; n < kCubicSamples * kCubicSamples * kCubicSamples; ++n)
    samples.push_back(float(f(Vec3(n % kCubicSamples, n / kCubicSamples % kCubicSamples, n / kCubicSamples / kCubicSamples))));
  return samples;
}

TEST(CubicCells, IncludeCellsWhoseOvershootReachesTheValue) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const float value : {0.5f, 0.9f, 1.05f, -0.05f}) {
    const Count found = count(made_of([&](const Vec3&) { return uniform(random); }), value);
    EXPECT_GT(found.holding, 5) << value;
  }
}

TEST(CubicCells, OfASmoothSurfaceFewExtraCellsAreIncluded) {
  const Count found = count(made_of([](const Vec3& p) { return norm(p - Vec3(4.3, 5.1, 4.7)); }), 3.6f);
  EXPECT_GT(found.holding, 200);
  EXPECT_LT(found.named, 1.15 * found.holding);
}

TEST(CubicCells, OfAConstantOnlyItsValueIsIncluded) {
  const auto same = made_of([](const Vec3&) { return 0.1f; });
  EXPECT_EQ(count(same, 0.1f).named, kBrickSize * kBrickSize * kBrickSize);
  EXPECT_EQ(count(same, 0.11f).named, 0);
}

}  // namespace catena::test::cubic_cells_test
