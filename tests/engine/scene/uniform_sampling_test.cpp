// SPDX-License-Identifier: MIT
// Uniform sampling: distances of neighboring samples, and distances of surface points from samples, by measurement.
#include "engine/scene/uniform_sampling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/field/grid/grid.h"
#include "tests/support/mesh_shapes.h"

namespace catena::scene::uniform_sampling_test {

constexpr std::size_t kMaxCount = 20000;

struct Spread {
  double minimum = HUGE_VAL, maximum = 0;  // distances to the nearest neighbor
};

double nearest(const std::vector<Vec3>& places, const Vec3& p, const Vec3* but = nullptr) {
  double minimum = HUGE_VAL;
  for (const Vec3& other : places)
    if (&other != but) minimum = std::min(minimum, norm(other - p));
  return minimum;
}

Spread spread_of(const std::vector<Vec3>& places) {
  Spread spread;
  for (const Vec3& p : places) {
    const double d = nearest(places, p, &p);
    spread.minimum = std::min(spread.minimum, d);
    spread.maximum = std::max(spread.maximum, d);
  }
  return spread;
}

const Domain kCube{{}, {Vec3(-2.0), Vec3(2.0)}};

TEST(UniformSampling, APlaneHasATriangularLattice) {
  const UniformSamples flat = sample_plane(kCube, {0.3, 0.1, 0.5}, {0, 0, 2}, 0.25, kMaxCount);
  EXPECT_EQ(flat.positions.size(), flat.expected_count);
  // A sample takes the area 0.25^2 sqrt(3/4) of the square's area of 16.
  EXPECT_NEAR(flat.expected_count, 16 / (0.0625 * std::sqrt(0.75)), 20);
  EXPECT_EQ(nearest(flat.positions, {0, 0, 0.5}), 0) << "below the domain's centre";
  EXPECT_NEAR(nearest(flat.positions, {0.25, 0, 0.5}), 0, 1e-12) << "and along x";
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(1, 2, -3), Vec3(1, 0, 1), Vec3(-1e-5, 1, 0)}) {
    const UniformSamples even = sample_plane(kCube, {0.1, 0, 0.2}, normal, 0.25, kMaxCount);
    ASSERT_GT(even.positions.size(), 200u);
    const Spread spread = spread_of(even.positions);
    EXPECT_NEAR(spread.minimum, 0.25, 1e-9);
    EXPECT_NEAR(spread.maximum, 0.25, 1e-9);
    for (const Vec3& p : even.positions) {
      EXPECT_LT(max_abs(p), 2 + 1e-6);
      EXPECT_NEAR(dot(p - Vec3(0.1, 0, 0.2), direction(normal)), 0, 1e-12);
    }
  }
  EXPECT_TRUE(sample_plane(kCube, {0, 0, 3}, {0, 0, 1}, 0.25, kMaxCount).positions.empty()) << "beside the domain";
  EXPECT_GT(sample_plane(kCube, {0, 0, 2}, {0, 0, 1}, 0.25, kMaxCount).positions.size(), 200u) << "on its face";
}

TEST(UniformSampling, ABoxHasACenteredCubicLattice) {
  // Edges of 4, 2 and 1 voxels of size 0.5 x 1 x 2, rotated about z.
  const double c = std::cos(0.4), s = std::sin(0.4);
  const field::Mapping mapping = field::Mapping::from_linear(Mat3(Vec3(0.5 * c, 0.5 * s, 0), Vec3(-s, c, 0), Vec3(0, 0, 2)), {1, 2, 3});
  const UniformSamples even = sample_box({mapping, {Vec3(0.0), Vec3(4, 2, 1)}}, 0.6, kMaxCount);
  EXPECT_EQ(even.positions.size(), 4u * 4 * 4);
  const Spread spread = spread_of(even.positions);
  EXPECT_NEAR(spread.minimum, 0.6, 1e-12);
  EXPECT_NEAR(spread.maximum, 0.6, 1e-12);
  Vec3 mean(0.0);
  for (const Vec3& p : even.positions) mean += p / 64.0;
  EXPECT_LT(norm(mean - mapping.world_from_index({2, 1, 0.5})), 1e-12);
  EXPECT_EQ(sample_box(kCube, 100, kMaxCount).positions, std::vector<Vec3>{Vec3(0.0)}) << "one, where no two have room";
}

/// The grid of |x| on n^3 nodes of the cube.
std::shared_ptr<const field::ScalarGrid> ball(int n, const std::vector<std::uint8_t>& valid = {}) {
  const field::Mapping mapping = field::Mapping::from_linear(Mat3(4.0 / (n - 1)), Vec3(-2.0));
  std::vector<float> values;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) values.push_back(float(norm(mapping.world_from_index(Vec3(x, y, z)))));
  return field::make_scalar_grid("ball", mapping, {n, n, n}, values, valid);
}

/// Expects that no two samples are nearer than the spacing, and that no point of the sphere is much further from a sample.
void expect_even_on_sphere(const std::vector<Vec3>& places, double radius, double spacing, double thickness) {
  const Spread spread = spread_of(places);
  EXPECT_GE(spread.minimum, spacing);
  EXPECT_LE(spread.maximum, 1.55 * spacing);
  const double count = 4 * M_PI * radius * radius / (spacing * spacing);
  EXPECT_GT(static_cast<double>(places.size()), 0.6 * count);
  EXPECT_LT(static_cast<double>(places.size()), 0.75 * count);
  for (const Vec3& p : places) ASSERT_NEAR(norm(p), radius, thickness);
  double widest = 0;
  for (int i = 0; i < 5000; ++i) {
    const double z = 1 - (2 * i + 1) / 5000.0, r = std::sqrt(1 - z * z), turn = 2.399963229728653 * i;
    widest = std::max(widest, nearest(places, radius * Vec3(r * std::cos(turn), r * std::sin(turn), z)));
  }
  EXPECT_LE(widest, 1.1 * spacing);
  // The samples are balanced about the center.
  Vec3 mean(0.0);
  for (const Vec3& p : places) mean += p / double(places.size());
  EXPECT_LT(norm(mean), 0.05 * radius);
}

TEST(UniformSampling, AnIsosurfaceIsCoveredEvenlyAtAnyResolution) {
  const double spacing = 0.2;
  for (const int n : {9, 33, 65, 150}) {
    SCOPED_TRACE(n);
    const double voxel = 4.0 / (n - 1);
    const UniformSamples even = sample_isosurface(*ball(n), 1.2, spacing, kMaxCount);
    expect_even_on_sphere(even.positions, 1.2, spacing, 0.25 * voxel * voxel + 1e-6);
  }
}

TEST(UniformSampling, AMeshIsCoveredEvenlyAtAnyResolution) {
  // Meshes of 320 and 128000 triangles: larger and smaller than the spacing.
  for (const auto& [n, thickness] : {std::pair{4, 0.03}, {80, 1e-3}}) {
    SCOPED_TRACE(n);
    expect_even_on_sphere(sample_mesh(*test::make_mesh_from(test::sphere_soup(n)), 0.15, kMaxCount).positions, 1, 0.15, thickness);
  }
  const UniformSamples box = sample_mesh(*test::make_mesh_from(test::box_soup()), 0.05, kMaxCount);
  EXPECT_GE(spread_of(box.positions).minimum, 0.05);
  EXPECT_LE(spread_of(box.positions).maximum, 0.08);
  EXPECT_NEAR(static_cast<double>(box.positions.size()) * 0.0025, 0.65 * 6, 0.4);
}

TEST(UniformSampling, SamplesAreRepeatableAndStableUnderSmallChangesOfTheLevel) {
  const auto grid = ball(33);
  const UniformSamples a = sample_isosurface(*grid, 1.2, 0.2, kMaxCount), b = sample_isosurface(*grid, 1.2, 0.2, kMaxCount);
  EXPECT_EQ(a.positions, b.positions);
  const UniformSamples moved = sample_isosurface(*grid, 1.203, 0.2, kMaxCount);
  int stay = 0;
  for (const Vec3& p : moved.positions) stay += nearest(a.positions, p) < 0.02;
  EXPECT_GT(stay, 0.6 * double(moved.positions.size()));
}

TEST(UniformSampling, InvalidVoxelsHaveNoSamples) {
  std::vector<std::uint8_t> valid;
  for (int i = 0; i < 33 * 33 * 33; ++i) valid.push_back(i % 33 >= 16);
  const UniformSamples even = sample_isosurface(*ball(33, valid), 1.2, 0.2, kMaxCount);
  EXPECT_GT(even.positions.size(), 100u);
  for (const Vec3& p : even.positions) EXPECT_GE(p.x, 0);
}

TEST(UniformSampling, TooManySamplesAreCountedButNotMade) {
  const mesh::MeshPtr sphere = test::make_mesh_from(test::sphere_soup(3));
  const auto grid = ball(33);
  for (const double spacing : {1e-3, 1e-12, 1e-30}) {
    for (const UniformSamples& even : {sample_plane(kCube, Vec3(0.0), {1, 1, 0}, spacing, 500), sample_box(kCube, spacing, 500),
                                       sample_isosurface(*grid, 1.2, spacing, 500), sample_mesh(*sphere, spacing, 500)}) {
      EXPECT_TRUE(even.positions.empty());
      EXPECT_GT(even.expected_count, 1 / spacing / spacing) << spacing;
    }
  }
  // The expected count without making the samples.
  const double spacing = 0.02;
  EXPECT_NEAR(sample_isosurface(*grid, 1.2, spacing, 500).expected_count * spacing * spacing, 0.65 * 4 * M_PI * 1.44, 3);
  // Slightly too many samples are made and counted.
  const UniformSamples fit = sample_isosurface(*grid, 1.2, 0.2, kMaxCount);
  const UniformSamples more = sample_isosurface(*grid, 1.2, 0.2, fit.positions.size() - 1);
  EXPECT_TRUE(more.positions.empty());
  EXPECT_EQ(more.expected_count, static_cast<double>(fit.positions.size()));
}

}  // namespace catena::scene::uniform_sampling_test
