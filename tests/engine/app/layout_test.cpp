// SPDX-License-Identifier: MIT
#include "engine/app/viewer/window/layout.h"

#include <gtest/gtest.h>

namespace catena::app::layout_test {

TEST(Layout, TheImageFillsTheAreaBesideThePanels) {
  const Area area = compute_image_area(1000, 700, {320, 20, 25});
  EXPECT_EQ(area, (Area{320, 20, 680, 655}));
  EXPECT_TRUE(area.contains(320, 20));
  EXPECT_FALSE(area.contains(319, 20));
  EXPECT_FALSE(area.contains(500, 675));
  EXPECT_EQ(compute_image_area(1000, 700, {}), (Area{0, 0, 1000, 700}));
}

TEST(Layout, TheImageAreaIsNeverEmpty) {
  for (const double size : {1.0, 2.0, 10.0, 300.0}) {
    const Area area = compute_image_area(size, size, {320, 20, 25});
    EXPECT_GE(area.width, 1);
    EXPECT_GE(area.height, 1);
    const auto [x0, y0, x1, y1] = to_pixel_rect(area, size, size, 1, 1);
    EXPECT_EQ(x1 - x0, 1u);
    EXPECT_EQ(y1 - y0, 1u);
    EXPECT_EQ(x1, 1u);
    EXPECT_EQ(y1, 1u);
  }
}

TEST(Layout, PixelsFollowTheFramebufferScale) {
  const Area area = compute_image_area(1000, 700, {320, 20, 25});
  EXPECT_EQ(to_pixel_rect(area, 1000, 700, 1000, 700), (std::array<std::uint32_t, 4>{320, 20, 1000, 675}));
  EXPECT_EQ(to_pixel_rect(area, 1000, 700, 2000, 1400), (std::array<std::uint32_t, 4>{640, 40, 2000, 1350}));
}

}  // namespace catena::app::layout_test
