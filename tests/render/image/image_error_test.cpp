// SPDX-License-Identifier: MIT
/// The image error metrics, on images with a known error.
#include "render/image/image_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::test::image_error_test {

using namespace catena::render;

Image8 empty(std::uint32_t width, std::uint32_t height) {
  return {width, height, std::vector<std::uint8_t>(4 * std::size_t(width) * height)};
}

void put(Image8& rendered, std::uint32_t x, std::uint32_t y, std::array<std::uint8_t, 4> rgba) {
  std::copy(rgba.begin(), rgba.end(), rendered.rgba.begin() + std::ptrdiff_t(4 * (std::size_t(y) * rendered.width + x)));
}

/// Fills a rectangle.
void fill(Image8& rendered, std::uint32_t x0, std::uint32_t y0, std::uint32_t x1, std::uint32_t y1, std::array<std::uint8_t, 4> rgba) {
  for (std::uint32_t y = y0; y < y1; ++y)
    for (std::uint32_t x = x0; x < x1; ++x) put(rendered, x, y, rgba);
}

TEST(MeasureError, IsOverThePixelsThatEitherImageCovers) {
  Image8 truth = empty(40, 30), rendered = truth;
  fill(truth, 0, 0, 10, 10, {100, 100, 100, 255});
  fill(rendered, 0, 0, 10, 10, {103, 100, 96, 255});
  fill(rendered, 20, 0, 30, 10, {12, 0, 0, 255});  // only in this image
  const ImageError error = measure_error(rendered, truth);
  EXPECT_DOUBLE_EQ(error.covered_share, 200.0 / 1200);
  EXPECT_NEAR(error.rmse, std::sqrt((9 + 16 + 144) / 6.0), 1e-12);
  EXPECT_DOUBLE_EQ(error.p999, 12);
  EXPECT_DOUBLE_EQ(measure_error(truth, rendered).rmse, error.rmse);
  EXPECT_EQ(measure_error(truth, truth).rmse, 0);
}

TEST(MeasureError, BlendsOverTheBackground) {
  // half-transparent white over black is 128, over white 255
  Image8 truth = empty(8, 8), rendered = truth;
  fill(truth, 0, 0, 8, 8, {255, 255, 255, 128});
  fill(rendered, 0, 0, 8, 8, {255, 255, 255, 64});
  EXPECT_DOUBLE_EQ(measure_error(rendered, truth).rmse, 64);
  EXPECT_DOUBLE_EQ(measure_error(rendered, truth, {1, 1, 1}).rmse, 0);
}

TEST(MeasureError, ThePercentile999IgnoresOnePixelInAThousand) {
  Image8 truth = empty(100, 100), rendered;
  fill(truth, 0, 0, 100, 100, {50, 50, 50, 255});
  rendered = truth;
  for (std::uint32_t i = 0; i < 10; ++i) put(rendered, i, 50, {50, 50, 150, 255});
  EXPECT_EQ(measure_error(rendered, truth).p999, 100);
  put(rendered, 0, 50, {50, 50, 50, 255});
  EXPECT_EQ(measure_error(rendered, truth).p999, 0);
}

TEST(MeasureError, ThinFeaturesAreLinesAndNotWideAreas) {
  Image8 truth = empty(80, 60);
  fill(truth, 0, 0, 80, 60, {20, 20, 20, 255});
  fill(truth, 5, 5, 45, 7, {120, 120, 120, 255});     // a line, 2 pixels wide
  fill(truth, 5, 20, 6, 50, {60, 60, 60, 255});       // another line
  fill(truth, 30, 20, 60, 50, {200, 200, 200, 255});  // a wide area
  fill(truth, 70, 5, 72, 9, {90, 90, 90, 255});       // 8 pixels: too small to count
  ImageError same = measure_error(truth, truth);
  EXPECT_EQ(same.thin_feature_count, 2);
  EXPECT_EQ(same.min_thin_retained, 1);
  Image8 rendered = truth;
  fill(rendered, 5, 20, 6, 50, {40, 40, 40, 255});  // half of its contrast to its surroundings
  fill(rendered, 5, 5, 45, 7, {150, 150, 150, 255});
  const ImageError error = measure_error(rendered, truth);
  EXPECT_NEAR(error.min_thin_retained, 0.5, 1e-6);
  EXPECT_NEAR(error.thin_retained, (80 * 100 + 30 * 20) / (80 * 100 + 30 * 40.0), 1e-6);
}

TEST(MeasureFlicker, IsTheChangeOfTheError) {
  Image8 truth = empty(20, 20);
  fill(truth, 0, 0, 20, 20, {100, 100, 100, 255});
  Image8 brighter = truth, darker = truth;
  fill(brighter, 0, 0, 20, 20, {105, 105, 105, 255});
  fill(darker, 0, 0, 20, 20, {98, 98, 98, 255});
  EXPECT_EQ(measure_flicker({brighter, brighter, brighter}, {truth, truth, truth}), 0);
  EXPECT_DOUBLE_EQ(measure_flicker({brighter, darker, brighter}, {truth, truth, truth}), 7);
  // a change that is also in the reference does not count
  EXPECT_EQ(measure_flicker({brighter, truth}, {brighter, truth}), 0);
}

}  // namespace catena::test::image_error_test
