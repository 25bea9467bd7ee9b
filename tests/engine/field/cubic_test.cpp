// SPDX-License-Identifier: MIT
// Cubic interpolation against an independent sampler: dense arrays in long double, ghost samples by Lagrange's formula along rows, and
// weights of the cubic Hermite form. Also its properties: smoothness, exactness for quadratic polynomials, and the domain.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>

#include "engine/field/analytic/analytic.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::cubic_test {

using namespace test;
using Real = long double;

/// The reference: a block with holes, with cubic interpolation.
class Reference {
 public:
  Reference(const Block& block, std::vector<std::uint8_t> valid) : block_(block), valid_(std::move(valid)) {
    for (std::size_t n = 0; n < block.values.size(); ++n) {
      if (!there(n)) continue;
      lowest_ = std::min<Real>(lowest_, block.values[n]);
      highest_ = std::max<Real>(highest_, block.values[n]);
    }
  }

  bool cell_is_whole(const Index3& b) const {
    for (int c = 0; c < 8; ++c)
      if (!present(b.x + (c & 1), b.y + (c >> 1 & 1), b.z + (c >> 2))) return false;
    return true;
  }

  Real at(const Vec3& p) const {
    int base[3];
    Real weight[3][4];
    const int n[3] = {block_.size.x, block_.size.y, block_.size.z};
    for (int a = 0; a < 3; ++a) {
      base[a] = std::clamp(static_cast<int>(std::floor(p[a])), 0, std::max(0, n[a] - 2));
      hermite(Real(p[a]) - base[a], weight[a]);
    }
    Real sum = 0;
    for (int k = 0; k < 4; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
          sum += weight[0][i] * weight[1][j] * weight[2][k] *
                 sample(layer(base[0], i, n[0]), layer(base[1], j, n[1]), layer(base[2], k, n[2]));
    return sum;
  }

 private:
  static int layer(int base, int i, int n) { return n == 1 ? 0 : base - 1 + i; }
  /// Weights from values and slopes (c_1 - c_-1) / 2 at both ends.
  static void hermite(Real t, Real (&w)[4]) {
    const Real h00 = (1 + 2 * t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t), h01 = t * t * (3 - 2 * t), h11 = t * t * (t - 1);
    w[0] = -h10 / 2;
    w[1] = h00 - h11 / 2;
    w[2] = h01 + h10 / 2;
    w[3] = h11 / 2;
  }
  bool there(std::size_t n) const { return (valid_.empty() || valid_[n] != 0) && std::isfinite(block_.values[n]); }
  bool present(int x, int y, int z) const {
    if (x < 0 || y < 0 || z < 0 || x >= block_.size.x || y >= block_.size.y || z >= block_.size.z) return false;
    return there((static_cast<std::size_t>(z) * block_.size.y + y) * block_.size.x + x);
  }
  Real sample(int x, int y, int z) const {
    if (present(x, y, z)) return block_.at(x, y, z);
    for (int axes = 1; axes <= 3; ++axes) {
      std::array<Real, 4> sum{};
      std::array<int, 4> rows{};
      for (int n = 0; n < 27; ++n) {
        const int d[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        if ((d[0] != 0) + (d[1] != 0) + (d[2] != 0) != axes) continue;
        int length = 0;
        while (length < 3 && present(x + (length + 1) * d[0], y + (length + 1) * d[1], z + (length + 1) * d[2])) ++length;
        if (length == 0) continue;
        // The Lagrange polynomial through the points 1..length, at 0.
        for (int i = 1; i <= length; ++i) {
          Real weight = 1;
          for (int j = 1; j <= length; ++j)
            if (j != i) weight *= Real(-j) / (i - j);
          sum[static_cast<std::size_t>(length)] += weight * block_.at(x + i * d[0], y + i * d[1], z + i * d[2]);
        }
        ++rows[static_cast<std::size_t>(length)];
      }
      for (std::size_t length = 3; length >= 1; --length)
        if (rows[length] > 0)
          return static_cast<float>(std::clamp(sum[length] / rows[length], 2 * lowest_ - highest_, 2 * highest_ - lowest_));
    }
    ADD_FAILURE() << "a cell asked for a sample that nothing is beside";
    return 0;
  }

  const Block& block_;
  std::vector<std::uint8_t> valid_;
  Real lowest_ = std::numeric_limits<Real>::max(), highest_ = std::numeric_limits<Real>::lowest();
};

std::shared_ptr<const ScalarGrid> smooth(const std::shared_ptr<const ScalarGrid>& grid) { return value_of(grid->as_cubic()); }

/// Vectors whose components are shifted copies of one block.
std::vector<float> vectors_of(const Block& block) {
  std::vector<float> xyz(3 * block.values.size());
  for (std::size_t n = 0; n < block.values.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) xyz[3 * n + c] = block.values[(n + 7 * c) % block.values.size()];
  return xyz;
}

TEST(CubicGrid, AgreesWithTheReferenceWithHolesAndAnyMapping) {
  Block block = random_block({19, 11, 26}, 5);
  Random random(6);
  std::vector<std::uint8_t> valid(block.values.size(), 1);
  for (auto& v : valid) v = random.uniform(0, 1) < 0.96;
  block.values[1234] = std::nanf("");
  for (const bool masked : {false, true}) {
    const std::vector<std::uint8_t> mask = masked ? valid : std::vector<std::uint8_t>{};
    const Reference reference(block, mask);
    for (const Mapping& mapping : mappings()) {
      const auto linear = make_scalar_grid("g", mapping, block.size, block.values, mask);
      const auto grid = smooth(linear);
      Cursor cursor, of_linear;
      int inside = 0;
      for (int trial = 0; trial < 3000; ++trial) {
        const Vec3 index = random.in_box(Vec3(-0.5), Vec3(18.5, 10.5, 25.5)), world = mapping.world_from_index(index);
        const ScalarSample s = grid->sample(world, cursor);
        ASSERT_EQ(s.inside, linear->sample(world, of_linear).inside) << "the domain is that of linear";
        ASSERT_EQ(grid->status_outside(world, cursor), linear->status_outside(world, of_linear));
        if (!s.inside) continue;
        ++inside;
        ASSERT_NEAR(s.value, static_cast<double>(reference.at(mapping.index_from_world(world))), 1e-11);
      }
      EXPECT_GT(inside, masked ? 1000 : 2000);
    }
  }
}

TEST(CubicGrid, VectorsAreInterpolatedPerComponent) {
  const Block block = random_block({9, 13, 8}, 8);
  const std::vector<float> xyz = vectors_of(block);
  const auto grid = *make_vector_grid("v", {}, block.size, xyz)->as_cubic();
  Cursor cursor, other;
  Random random(3);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> one(block.values.size());
    for (std::size_t n = 0; n < one.size(); ++n) one[n] = xyz[3 * n + c];
    const auto scalar = smooth(make_scalar_grid("s", {}, block.size, one));
    for (int trial = 0; trial < 500; ++trial) {
      const Vec3 p = random.in_box(Vec3(-0.2), Vec3(8.2, 12.2, 7.2));
      ASSERT_NEAR(grid->sample(p, cursor).value[static_cast<int>(c)], scalar->sample(p, other).value, 1e-12);
    }
  }
}

TEST(CubicGrid, ValueAndGradientAreContinuousAndConsistent) {
  const auto grid = smooth(random_grid({17, 17, 17}, 9));
  Cursor cursor;
  Random random(10);
  for (int trial = 0; trial < 500; ++trial) {
    Vec3 p = random.in_box(Vec3(0.1), Vec3(15.9));
    const int axis = trial % 3;
    p[axis] = std::max(1.0, std::floor(p[axis]));  // on a face
    Vec3 below = p, above = p;
    below[axis] -= 1e-9, above[axis] += 1e-9;
    const ScalarSample a = grid->sample(below, cursor), b = grid->sample(above, cursor);
    ASSERT_NEAR(a.value, b.value, 1e-7);
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(a.gradient[k], b.gradient[k], 1e-6);
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = along(k, 1e-5);
      const double slope = (grid->sample(p + step, cursor).value - grid->sample(p - step, cursor).value) / 2e-5;
      ASSERT_NEAR(grid->sample(p, cursor).gradient[k], slope, 1e-3) << "the second derivative jumps there";
    }
  }
}

TEST(CubicGrid, ReproducesQuadraticsUpToTheBorderAndAcrossHoles) {
  const auto f = [](double x, double y, double z) { return 3 + x * (2 - 0.25 * x) + y * (z + 0.125 * y) - 0.5 * z * x; };
  const Block block{{12, 12, 12}, values_of({12, 12, 12}, f)};
  std::vector<std::uint8_t> valid(block.values.size(), 1);
  for (int n : {5 + 12 * (5 + 12 * 5), 6 + 12 * (5 + 12 * 5), 5 + 12 * (6 + 12 * 6), 4 + 12 * (4 + 12 * 7)})  // far from the border
    valid[static_cast<std::size_t>(n)] = 0;
  const auto grid = smooth(make_scalar_grid("g", {}, block.size, block.values, valid));
  Cursor cursor;
  Random random(11);
  int inside = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Vec3 p = random.in_box(Vec3(0.0), Vec3(11.0));
    const ScalarSample s = grid->sample(p, cursor);
    if (!s.inside) continue;
    ++inside;
    ASSERT_NEAR(s.value, f(p.x, p.y, p.z), 1e-11) << p.x << " " << p.y << " " << p.z;
  }
  EXPECT_GT(inside, 3500);
}

TEST(CubicGrid, InterpolatesTheSamplesAndConstantsAreFlat) {
  Block block = random_block({10, 10, 10}, 12);
  const auto grid = smooth(make_scalar_grid("g", {}, block.size, block.values));
  Cursor cursor;
  for (int z = 0; z < 10; ++z)
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 10; ++x) ASSERT_NEAR(grid->sample(Vec3(x, y, z), cursor).value, block.at(x, y, z), 1e-14);
  const std::vector<float> same(1000, 0.1f);
  const auto flat = smooth(make_scalar_grid("g", {}, {10, 10, 10}, same));
  Random random(13);
  for (int trial = 0; trial < 200; ++trial) {
    const ScalarSample s = flat->sample(random.in_box(Vec3(0.0), Vec3(9.0)), cursor);
    ASSERT_EQ(s.value, double{0.1f});
    ASSERT_EQ(s.gradient, Vec3(0.0));
  }
}

TEST(CubicGrid, HandlesSingleLayersAndRows) {
  for (const Index3& size : {Index3{7, 9, 1}, Index3{1, 1, 9}, Index3{1, 1, 1}, Index3{2, 2, 2}}) {
    const Block block = random_block(size, 14);
    const auto linear = make_scalar_grid("g", {}, size, block.values);
    const auto grid = smooth(linear);
    const Reference reference(block, {});
    Cursor cursor, of_linear;
    Random random(15);
    const std::array<int, 3> extent{size.x, size.y, size.z};
    for (int trial = 0; trial < 300; ++trial) {
      const Vec3 p = random.in_box(Vec3(0.0), Vec3(size.x - 1, size.y - 1, size.z - 1));
      const ScalarSample s = grid->sample(p, cursor);
      ASSERT_TRUE(s.inside);
      ASSERT_NEAR(s.value, static_cast<double>(reference.at(p)), 1e-12);
      for (int a = 0; a < 3; ++a) ASSERT_TRUE(extent[static_cast<std::size_t>(a)] > 1 || s.gradient[a] == 0);
    }
  }
}

TEST(CubicGrid, ExtrapolatesLinearlyOutsideTheBox) {
  const auto grid = smooth(random_grid({6, 6, 6}, 16));
  Cursor cursor;
  const ScalarSample at = grid->sample(Vec3(5, 2.5, 3.25), cursor), far = grid->sample(Vec3(9, 2.5, 3.25), cursor);
  EXPECT_FALSE(far.inside);
  EXPECT_NEAR(far.value, at.value + 4 * at.gradient.x, 1e-9);
  EXPECT_FALSE(grid->sample(Vec3(std::nan(""), 0, 0), cursor).inside);
  EXPECT_TRUE(std::isfinite(grid->sample(Vec3(1e300, -1e300, 0), cursor).value));
}

TEST(CubicGrid, TheCursorDoesNotChangeValues) {
  const auto grid = smooth(random_grid({40, 33, 29}, 17));
  Random random(18);
  Cursor walked;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 p = random.in_box(Vec3(-1.0), Vec3(40, 33, 29));
    Cursor fresh;
    const ScalarSample a = grid->sample(p, walked), b = grid->sample(p, fresh);
    ASSERT_EQ(std::memcmp(&a.value, &b.value, sizeof a.value), 0);
    ASSERT_EQ(a.gradient, b.gradient);
  }
}

TEST(CubicGrid, ReadBlocksContainGhostSamples) {
  const Block block = random_block({9, 9, 9}, 19);
  const auto grid = smooth(make_scalar_grid("g", {}, block.size, block.values));
  std::vector<float> padded(11 * 11 * 11);
  grid->read_block({-1, -1, -1}, {11, 11, 11}, padded);
  const auto at = [&](int x, int y, int z) { return padded[static_cast<std::size_t>(((z + 1) * 11 + y + 1) * 11 + x + 1)]; };
  EXPECT_EQ(at(3, 4, 5), static_cast<float>(block.at(3, 4, 5)));
  const auto row = [&](int n) { return 3.0 * (block.at(0, 4, n) - block.at(1, 4, n)) + block.at(2, 4, n); };
  EXPECT_EQ(at(-1, 4, 5), static_cast<float>(std::clamp(row(5), 2.0 * grid->min_value() - grid->max_value(),
                                                        2.0 * grid->max_value() - grid->min_value())));
}

/// The interpolation error of a smooth function on 80 nodes is a twentieth of that of linear cells.
TEST(CubicGrid, HasATwentiethOfTheLinearErrorForASmoothFunction) {
  const auto f = [](const Vec3& p) { return std::sin(p.x) * std::cos(2 * p.y) + std::sin(3 * p.z); };
  constexpr int n = 80;
  constexpr double h = 6.283185307179586 / (n - 1);
  const auto values = values_of({n, n, n}, [&](int x, int y, int z) { return f(h * Vec3(x, y, z)); });
  const auto linear = make_scalar_grid("g", Mapping::from_linear(Mat3(h), Vec3(0.0)), {n, n, n}, values);
  const auto cubic = smooth(linear);
  Random random(21);
  Cursor a, b;
  double of_linear = 0, of_cubic = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const Vec3 p = random.in_box(Vec3(0.0), Vec3((n - 1) * h));
    of_linear += std::pow(linear->sample(p, a).value - f(p), 2);
    of_cubic += std::pow(cubic->sample(p, b).value - f(p), 2);
  }
  EXPECT_LT(20 * std::sqrt(of_cubic), std::sqrt(of_linear)) << std::sqrt(of_cubic / 5000) << " " << std::sqrt(of_linear / 5000);
}

}  // namespace catena::field::cubic_test
