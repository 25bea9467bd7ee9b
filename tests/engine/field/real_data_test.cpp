// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <numbers>

#include "tests/engine/field/field_helpers.h"

namespace catena::field::real_data_test {

#define CATENA_NEED(variable, name)                     \
  const std::string variable = test::shared_data(name); \
  if (variable.empty()) GTEST_SKIP() << name << " of the shared data is not here"

void expect_range(const std::string& path, const std::string& grid, double lo, double hi, double tolerance) {
  const auto field = test::read(path, grid).scalar;
  EXPECT_NEAR(field->min_value(), lo, tolerance) << path;
  EXPECT_NEAR(field->max_value(), hi, tolerance) << path;
  EXPECT_EQ(field->grid()->stats().nan_count, 0u);
}

TEST(RealData, TheCombustorHasItsKnownProperties) {
  CATENA_NEED(path, "combustor_cfd.vdb");
  expect_range(path, "density", 0.198, 0.707, 5e-4);
  const auto velocity = test::read(path, "velocity").vector;
  EXPECT_NEAR(velocity->grid()->stats().max, 1519, 1);
  EXPECT_TRUE(velocity->grid()->has_mask());
  EXPECT_NEAR(velocity->mapping().min_voxel_edge(), 0.18, 1e-3);
  Cursor cursor;
  EXPECT_TRUE(velocity->sample(Vec3(1.6, -0.57, 27.09), cursor).inside);
}

TEST(RealData, CarotidCraniumAndWeatherHaveTheirKnownProperties) {
  CATENA_NEED(carotid, "carotid_flow.vdb");
  CATENA_NEED(cranium, "cranium_ct.vdb");
  CATENA_NEED(weather, "weather_uvt.vdb");
  expect_range(carotid, "density", 0, 580, 1);
  expect_range(cranium, {}, -1024, 2986, 1);
  expect_range(weather, "temperature", 190.9, 310.6, 0.2);
  EXPECT_NEAR(test::read(weather, "wind").vector->grid()->stats().max, 80.7, 0.1);
  EXPECT_NEAR(test::read(carotid, "velocity").vector->grid()->stats().max, 22.7, 0.1);
}

TEST(RealData, TheSyntheticHelixEqualsTheFormula) {
  CATENA_NEED(path, "synth_helix.vdb");
  const auto field = test::read(path, "velocity").vector;
  Cursor cursor;
  const Box& box = field->index_box();
  for (int n = 1; n < 8; ++n) {
    const Vec3 p = field->mapping().world_from_index(box.lo + (box.hi - box.lo) * (n / 8.0));
    EXPECT_NEAR(norm(field->sample(p, cursor).value - Vec3(-2 * p.y, 2 * p.x, 0.5)), 0, 1e-5);
  }
}

TEST(RealData, TheBrainEqualsItsPackage) {
  CATENA_NEED(path, "colin27_brain_mr.vdb");
  const std::string package = "/usr/share/mricron/templates/ch2bet.nii.gz";
  if (!test::exists(package)) GTEST_SKIP() << "package mricron-data is not installed";
  const auto vdb = test::read(path).scalar, nii = test::read(package).scalar;
  EXPECT_EQ(nii->max_value(), 133);
  // Compares voxel by voxel, at the world positions of both.
  Cursor a, b;
  const Box& box = nii->index_box();
  double worst = 0;
  int compared = 0;
  for (double z = box.lo.z; z <= box.hi.z; z += 3)
    for (double y = box.lo.y; y <= box.hi.y; y += 2)
      for (double x = box.lo.x; x <= box.hi.x; x += 2) {
        const Vec3 p = nii->mapping().world_from_index(Vec3(x, y, z));
        const ScalarSample s = vdb->sample(p, a);
        if (!s.inside) continue;
        worst = std::max(worst, std::fabs(s.value - nii->sample(p, b).value));
        ++compared;
      }
  EXPECT_GT(compared, 100000);
  EXPECT_LE(worst, 1e-3);
}

TEST(RealData, FibresHaveTheirHelixAngle) {
  CATENA_NEED(path, "ideal_lv_fibres.vdb");
  const auto fibre = test::read(path, "fibre").vector;
  const auto depth = test::read(path, "transmural").scalar;
  const auto info = test::value_of(describe_grids(path));
  EXPECT_EQ(info.size(), 4u);
  Cursor cf, cd;
  const VectorGrid& grid = *fibre->grid();
  const Vec3 centre = fibre->mapping().world_from_index((fibre->index_box().lo + fibre->index_box().hi) * 0.5);
  int compared = 0;
  double error = 0;
  for (int x = 0; x < 96; x += 3)
    for (int y = 0; y < 96; y += 3) {
      const Vec3 p = fibre->mapping().world_from_index(Vec3(x, y, 0.5 * (fibre->index_box().lo.z + fibre->index_box().hi.z)));
      const VectorCell cell = grid.cell(grid.cell_base(fibre->mapping().index_from_world(p)), cf);
      if (!cell.valid) continue;
      const Vec3 around = direction(Vec3(-(p.y - centre.y), p.x - centre.x, 0));
      const LineSample f = fibre->sample_line(p, cf);
      const ScalarSample t = depth->sample(p, cd);
      const Vec3 along = direction(cross(t.gradient, around));
      const double angle = std::atan(dot(f.axis, along) / dot(f.axis, around)) * 180 / std::numbers::pi;
      error += std::fabs(std::fabs(angle) - std::fabs(60 - 120 * t.value));
      ++compared;
    }
  ASSERT_GT(compared, 20);
  EXPECT_LT(error / compared, 10);
}

}  // namespace catena::field::real_data_test
