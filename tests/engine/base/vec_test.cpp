// SPDX-License-Identifier: MIT
#include "engine/base/vec.h"

#include <gtest/gtest.h>

#include <limits>

namespace catena {
namespace vec_test {

TEST(Vec, NormAndDirectionAreAccurateOverTheRangeOfDoubles) {
  for (const double scale : {1e-323, 1e-300, 1e-150, 1.0, 1e150, 1e307}) {
    const Vec3 v = scale * Vec3(3, -4, 12);
    if (scale > 1e-320) {
      EXPECT_NEAR(norm(v) / scale, 13, 1e-14 * 13);
    }
    EXPECT_NEAR(norm(direction(v)), 1, 1e-15);
    EXPECT_EQ(direction(-v), -direction(v));
  }
  EXPECT_EQ(norm(Vec3(0.0)), 0);
  EXPECT_EQ(direction(Vec3(0.0)), Vec3(0.0));
}

TEST(Vec, NonFiniteVectorsHaveANonFiniteNormAndNoDirection) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const double some[] = {0, -1, 1e200, inf, -inf, nan};
  for (const double x : some)
    for (const double y : some)
      for (const double z : some) {
        const Vec3 v(x, y, z);
        EXPECT_EQ(std::isfinite(norm(v)), is_finite(v)) << x << " " << y << " " << z;
        EXPECT_TRUE(is_finite(direction(v))) << x << " " << y << " " << z;
        if (!is_finite(v)) {
          EXPECT_EQ(direction(v), Vec3(0.0)) << x << " " << y << " " << z;
        }
      }
}

}  // namespace vec_test
}  // namespace catena
