// SPDX-License-Identifier: MIT
/// The measure of pictures, on pictures whose error is known.
#include "render/image/image_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::test {
namespace measure_test {

using namespace catena::render;

Image8 empty(std::uint32_t width, std::uint32_t height) {
  return {width, height, std::vector<std::uint8_t>(4 * std::size_t(width) * height)};
}

void put(Image8& picture, std::uint32_t x, std::uint32_t y, std::array<std::uint8_t, 4> rgba) {
  std::copy(rgba.begin(), rgba.end(), picture.rgba.begin() + std::ptrdiff_t(4 * (std::size_t(y) * picture.width + x)));
}

/// A filled rectangle.
void fill(Image8& picture, std::uint32_t x0, std::uint32_t y0, std::uint32_t x1, std::uint32_t y1, std::array<std::uint8_t, 4> rgba) {
  for (std::uint32_t y = y0; y < y1; ++y)
    for (std::uint32_t x = x0; x < x1; ++x) put(picture, x, y, rgba);
}

TEST(MeasureError, IsOverWhatEitherPictureCovers) {
  Image8 truth = empty(40, 30), picture = truth;
  fill(truth, 0, 0, 10, 10, {100, 100, 100, 255});
  fill(picture, 0, 0, 10, 10, {103, 100, 96, 255});
  fill(picture, 20, 0, 30, 10, {12, 0, 0, 255});  // only there
  const ImageError error = measure_error(picture, truth);
  EXPECT_DOUBLE_EQ(error.covered_share, 200.0 / 1200);
  EXPECT_NEAR(error.rmse, std::sqrt((9 + 16 + 144) / 6.0), 1e-12);
  EXPECT_DOUBLE_EQ(error.p999, 12);
  EXPECT_DOUBLE_EQ(measure_error(truth, picture).rmse, error.rmse);
  EXPECT_EQ(measure_error(truth, truth).rmse, 0);
}

TEST(MeasureError, IsThatOverTheBackground) {
  // half transparent white over black is 128, over white 255
  Image8 truth = empty(8, 8), picture = truth;
  fill(truth, 0, 0, 8, 8, {255, 255, 255, 128});
  fill(picture, 0, 0, 8, 8, {255, 255, 255, 64});
  EXPECT_DOUBLE_EQ(measure_error(picture, truth).rmse, 64);
  EXPECT_DOUBLE_EQ(measure_error(picture, truth, {1, 1, 1}).rmse, 0);
}

TEST(MeasureError, OnePixelInAThousandIsBeyondThe999thOfThem) {
  Image8 truth = empty(100, 100), picture;
  fill(truth, 0, 0, 100, 100, {50, 50, 50, 255});
  picture = truth;
  for (std::uint32_t i = 0; i < 10; ++i) put(picture, i, 50, {50, 50, 150, 255});
  EXPECT_EQ(measure_error(picture, truth).p999, 100);
  put(picture, 0, 50, {50, 50, 50, 255});
  EXPECT_EQ(measure_error(picture, truth).p999, 0);
}

TEST(MeasureError, ThinPartsAreLinesAndNotWhatIsWide) {
  Image8 truth = empty(80, 60);
  fill(truth, 0, 0, 80, 60, {20, 20, 20, 255});
  fill(truth, 5, 5, 45, 7, {120, 120, 120, 255});     // a line, 2 pixels wide
  fill(truth, 5, 20, 6, 50, {60, 60, 60, 255});       // another
  fill(truth, 30, 20, 60, 50, {200, 200, 200, 255});  // wide
  fill(truth, 70, 5, 72, 9, {90, 90, 90, 255});       // of 8 pixels: too small to count
  ImageError same = measure_error(truth, truth);
  EXPECT_EQ(same.thin_feature_count, 2);
  EXPECT_EQ(same.min_thin_retained, 1);
  Image8 picture = truth;
  fill(picture, 5, 20, 6, 50, {40, 40, 40, 255});  // half of its brightness over what is about it
  fill(picture, 5, 5, 45, 7, {150, 150, 150, 255});
  const ImageError error = measure_error(picture, truth);
  EXPECT_NEAR(error.min_thin_retained, 0.5, 1e-6);
  EXPECT_NEAR(error.thin_retained, (80 * 100 + 30 * 20) / (80 * 100 + 30 * 40.0), 1e-6);
}

TEST(MeasureFlicker, IsTheChangeOfTheErrorAndNotTheError) {
  Image8 truth = empty(20, 20);
  fill(truth, 0, 0, 20, 20, {100, 100, 100, 255});
  Image8 brighter = truth, darker = truth;
  fill(brighter, 0, 0, 20, 20, {105, 105, 105, 255});
  fill(darker, 0, 0, 20, 20, {98, 98, 98, 255});
  EXPECT_EQ(measure_flicker({brighter, brighter, brighter}, {truth, truth, truth}), 0);
  EXPECT_DOUBLE_EQ(measure_flicker({brighter, darker, brighter}, {truth, truth, truth}), 7);
  // what moves truly does not count
  EXPECT_EQ(measure_flicker({brighter, truth}, {brighter, truth}), 0);
}

}  // namespace measure_test
}  // namespace catena::test
