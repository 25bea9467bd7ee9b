// SPDX-License-Identifier: MIT
// The analytic field of vortices: divergence-free, dependent on the seed, planar in two dimensions, and bit-identical on every machine.
#include <gtest/gtest.h>

#include "engine/base/hash.h"
#include "engine/base/random.h"
#include "engine/field/analytic/analytic.h"

namespace vortices_test {

using namespace catena;
using namespace catena::field;

std::shared_ptr<const VectorField> vortices(int seed, int dimensions, const Vec3& center = Vec3(0.0)) {
  AnalyticParameters parameters;
  parameters.seed = seed;
  parameters.dimensions = dimensions;
  parameters.center = center;
  return make_analytic("vortices", parameters).value().vector;
}

Vec3 at(const VectorField& field, const Vec3& p) {
  Cursor cursor;
  return field.sample(p, cursor).value;
}

TEST(Vortices, AreDivergenceFree) {
  Random random(3);
  constexpr double h = 1e-4;
  for (const int dimensions : {2, 3})
    for (int seed = 0; seed < 20; ++seed) {
      const auto field = vortices(seed, dimensions);
      double largest = 0;
      for (int k = 0; k < 50; ++k) {
        const Vec3 p(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2));
        double divergence = 0;
        for (int axis = 0; axis < 3; ++axis) {
          Vec3 d(0.0);
          d[axis] = h;
          const Vec3 slope = (at(*field, p + d) - at(*field, p - d)) / (2 * h);
          divergence += slope[axis];
          largest = std::max(largest, norm(slope));
        }
        ASSERT_NEAR(divergence, 0, 1e-5);
      }
      EXPECT_GT(largest, 0.5) << "the slopes are not small";
    }
}

TEST(Vortices, TwoDimensionalVorticesArePlanar) {
  const auto field = vortices(4, 2);
  for (const double z : {-1.0, 0.0, 3.0}) {
    EXPECT_EQ(at(*field, Vec3(0.3, -0.7, z)), at(*field, Vec3(0.3, -0.7, 0)));
    EXPECT_EQ(at(*field, Vec3(0.3, -0.7, z)).z, 0);
  }
}

TEST(Vortices, DependOnTheSeedAndTheCenter) {
  const Vec3 p(0.25, 0.5, -0.125), center(1, -2, 0.5);
  EXPECT_NE(at(*vortices(1, 3), p), at(*vortices(2, 3), p));
  EXPECT_EQ(at(*vortices(1, 3, center), p + center), at(*vortices(1, 3), p));
  EXPECT_EQ(vortices(1, 3, center)->world_bounds().center(), center);
  AnalyticParameters parameters;
  parameters.dimensions = 4;
  EXPECT_FALSE(make_analytic("vortices", parameters));
}

TEST(Vortices, AreBitIdenticalOnEveryMachine) {
  Fnv1a hash;
  for (const int dimensions : {2, 3})
    for (int seed = 0; seed < 10; ++seed)
      for (int k = 0; k < 10; ++k) {
        const Vec3 v = at(*vortices(seed, dimensions), Vec3(0.3 * k - 1.5, 0.1 * k, 1 - 0.2 * k));
        hash.add(v.x), hash.add(v.y), hash.add(v.z);
      }
  EXPECT_EQ(hash.value, 0xbcc56d44ae66cd55u) << std::hex << hash.value;
}

}  // namespace vortices_test
