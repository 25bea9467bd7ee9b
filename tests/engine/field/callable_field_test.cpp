// SPDX-License-Identifier: MIT
/// Fields of a calling program: functions, and grids that it fills layer by layer.
#include "engine/field/callable_field.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/field/grid/grid_from_slices.h"
#include "tests/support/results.h"

namespace catena::field::callable_field_test {

const Bounds kBox{Vec3(-1.0, -2.0, -3.0), Vec3(1.0, 2.0, 3.0)};

TEST(CallableFieldDeathTest, AnEmptyOrUnboundedBoxIsABug) {
  const VectorFunction f = [](const Vec3& p) { return p; };
  EXPECT_DEATH(make_callable_field("f", Bounds{}, f), "is_box");
  EXPECT_DEATH(make_callable_field("f", Bounds{Vec3(0.0), Vec3(std::numeric_limits<double>::infinity())}, f), "is_box");
}

TEST(CallableField, IsSampledExactlyWithinItsBox) {
  const ScalarFieldPtr f = make_callable_field(
      "f", kBox,
      [](const Vec3& p, Vec3& gradient) {
        gradient = {2 * p.x, 1, 0};
        return p.x * p.x + p.y;
      },
      -2, 3);
  Cursor cursor;
  const ScalarSample s = f->sample({0.5, 1.5, 2.5}, cursor);
  EXPECT_TRUE(s.inside);
  EXPECT_EQ(s.value, 1.75);
  EXPECT_EQ(s.gradient, Vec3(1, 1, 0));
  EXPECT_EQ(f->world_bounds().hi, kBox.hi);
  EXPECT_EQ(f->min_value(), -2);
  // A little outside the box, the function is evaluated, but the position is outside.
  EXPECT_FALSE(f->sample({1.5, 0, 0}, cursor).inside);
  EXPECT_EQ(f->sample({1.5, 0, 0}, cursor).value, 2.25);
  EXPECT_EQ(f->status_outside({1.5, 0, 0}, cursor), SampleStatus::outside_box);
  EXPECT_EQ(f->status_outside({0.5, 0, 0}, cursor), SampleStatus::ok);
}

TEST(CallableField, NonFiniteValuesAreOutside) {
  const VectorFieldPtr f = make_callable_field("f", kBox, VectorFunction([](const Vec3& p) { return Vec3(1 / p.x, 0, 0); }));
  Cursor cursor;
  EXPECT_TRUE(f->sample({0.5, 0, 0}, cursor).inside);
  EXPECT_FALSE(f->sample({0, 0, 0}, cursor).inside);
  EXPECT_EQ(f->status_outside({0, 0, 0}, cursor), SampleStatus::not_finite);
  EXPECT_FALSE(f->sample(Vec3(std::numeric_limits<double>::quiet_NaN()), cursor).inside);
}

TEST(GridFromSlices, RequestsEachLayerOnceInOrder) {
  SliceSource layers;
  layers.size = {3, 4, 20};
  int next = 0;
  layers.read = [&](int z, std::span<float> out) {
    EXPECT_EQ(z, next);
    next += static_cast<int>(out.size() / 12);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(12 * z) + static_cast<float>(i);
  };
  const auto grid = test::value_of(make_grid_from_slices("g", Mapping::from_linear(Mat3(2.0), Vec3(10.0)), layers));
  EXPECT_EQ(next, 20);
  Cursor cursor;
  EXPECT_EQ(grid.scalar->sample(Vec3(10.0) + 2.0 * Vec3(2, 3, 19), cursor).value, 2 + 3 * 3 + 12 * 19);
}

TEST(GridFromSlices, RefusesInvalidGrids) {
  SliceSource layers;
  layers.read = [](int, std::span<float> out) { std::fill(out.begin(), out.end(), std::numeric_limits<float>::quiet_NaN()); };
  layers.size = {1, 4, 4};
  EXPECT_EQ(make_grid_from_slices("g", {}, layers).error().message,
            "g: has 1 x 4 x 4 voxels; from 2 to 65536 along each axis were expected");
  layers.size = {4, 4, 4};
  EXPECT_TRUE(test::fails(make_grid_from_slices("g", {}, layers), "no finite value"));
  EXPECT_TRUE(test::fails(make_grid_from_slices("g", Mapping::from_linear(Mat3(0.0), Vec3(0.0)), layers), "inverted"));
  layers.size = {65536, 65536, 65536};
  EXPECT_FALSE(make_grid_from_slices("g", {}, layers));  // before any layer is read
}

}  // namespace catena::field::callable_field_test
