// SPDX-License-Identifier: MIT
#include "engine/field/cell.h"

#include <gtest/gtest.h>

#include "tests/engine/field/field_helpers.h"

namespace catena::field::cell_test {

using test::Random;

ScalarCell random_cell(Random& random) {
  ScalarCell c;
  for (double& v : c.corner) v = static_cast<float>(random.uniform(-4, 4));
  return c;
}

TEST(ScalarCell, EqualsTheCornerValuesAtTheCorners) {
  Random random(1);
  const ScalarCell c = random_cell(random);
  for (int n = 0; n < 8; ++n) EXPECT_NEAR(c.value(Vec3(n & 1, n >> 1 & 1, n >> 2)), c.corner[n], 1e-15);
}

TEST(ScalarCell, GradientIsTheDerivative) {
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const ScalarCell c = random_cell(random);
    const Vec3 f = random.in_box(Vec3(0.0), Vec3(1.0));
    const Vec3 g = c.gradient(f);
    for (int a = 0; a < 3; ++a) {
      // Along one axis the polynomial is linear, so a wide difference is exact.
      Vec3 lo = f, hi = f;
      lo[a] = 0, hi[a] = 1;
      EXPECT_NEAR(g[a], c.value(hi) - c.value(lo), 1e-13);
    }
  }
}

TEST(ScalarCell, MixedSecondDerivativesAreDifferencesOfTheGradient) {
  Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const ScalarCell c = random_cell(random);
    const Vec3 f = random.in_box(Vec3(0.0), Vec3(1.0));
    const Vec3 m = c.mixed_second_derivatives(f);
    const auto difference = [&](int along, int of) {
      Vec3 lo = f, hi = f;
      lo[along] = 0, hi[along] = 1;
      return c.gradient(hi)[of] - c.gradient(lo)[of];
    };
    EXPECT_NEAR(m.x, difference(1, 2), 1e-13);
    EXPECT_NEAR(m.y, difference(0, 2), 1e-13);
    EXPECT_NEAR(m.z, difference(0, 1), 1e-13);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(difference(a, a), 0, 1e-13);
  }
}

TEST(VectorCell, InterpolatesEachComponent) {
  Random random(4);
  VectorCell v;
  std::array<ScalarCell, 3> parts;
  for (int n = 0; n < 8; ++n) {
    v.corner[n] = random.in_box(Vec3(-1.0), Vec3(1.0));
    for (int a = 0; a < 3; ++a) parts[a].corner[n] = v.corner[n][a];
  }
  const Vec3 f(0.2, 0.7, 0.4), value = v.value(f);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(value[a], parts[a].value(f), 1e-15);
}

}  // namespace catena::field::cell_test
