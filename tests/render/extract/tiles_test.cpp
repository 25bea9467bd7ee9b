// SPDX-License-Identifier: MIT
#include "render/frame/tiles.h"

#include <gtest/gtest.h>

#include "render/frame/camera.h"

namespace catena::render::tiles_test {

TEST(Tiles, CoverEverySampleOnce) {
  for (const auto& [w, h, n, tile] : {std::array{200u, 150u, 1u, 64u}, {33u, 7u, 3u, 24u}, {5000u, 3u, 1u, 0u}, {64u, 64u, 1u, 64u}}) {
    const TilePlan plan = plan_tiles(w, h, n, tile, true, 4096);
    std::vector<int> seen(std::size_t(w) * n * h * n);
    for (std::uint32_t row = 0; row < plan.rows(); ++row)
      for (std::uint32_t column = 0; column < plan.columns(); ++column) {
        const TileArea a = plan.area(column, row);
        EXPECT_EQ(a.x % kTileAlignment, 0u);
        EXPECT_EQ(a.render_x % kTileAlignment, 0u);
        EXPECT_EQ(a.render_y % kTileAlignment, 0u);
        EXPECT_EQ(a.x % n + a.width % n + a.y % n + a.height % n, 0u) << "whole pixels";
        EXPECT_LE(a.render_x, a.x);
        EXPECT_GE(a.render_x + a.render_width, a.x + a.width);
        EXPECT_LE(a.render_x + a.render_width, w * n);
        EXPECT_LE(a.render_width, 4096u);
        for (std::uint32_t y = a.y; y < a.y + a.height; ++y)
          for (std::uint32_t x = a.x; x < a.x + a.width; ++x) ++seen[std::size_t(y) * w * n + x];
      }
    for (const int count : seen) ASSERT_EQ(count, 1);
  }
}

TEST(Tiles, SmallImagesAreOneTile) {
  EXPECT_EQ(plan_tiles(1024, 768, 1, 0, true, 16384).count(), 1u);
  EXPECT_EQ(plan_tiles(2048, 2048, 1, 0, true, 16384).count(), 1u);
  EXPECT_EQ(plan_tiles(1024, 1024, 2, 0, true, 16384).count(), 1u);
  EXPECT_GT(plan_tiles(2049, 2048, 1, 0, true, 16384).count(), 1u);
  EXPECT_GT(plan_tiles(20000, 4, 1, 0, true, 16384).count(), 1u) << "longer than an image of the device";
  EXPECT_EQ(plan_tiles(200, 150, 1, 64, false, 16384).count(), 12u);
}

TEST(Tiles, ATileHasTheRaysOfTheWholeImage) {
  FramePacket packet;
  packet.width = 300;
  packet.height = 200;
  packet.view = {{3.0, -7.0, 2.0}, {0.1, 0.2, 0.3}, {0.0, 0.0, 1.0}, 37, false, 5};
  packet.view.window = {-0.8, 1.3, -1, 0.9};  // an off-axis eye
  for (const bool orthographic : {false, true}) {
    packet.view.orthographic = orthographic;
    const TilePlan plan = plan_tiles(300, 200, 1, 64, true, 16384);
    const Camera whole = make_camera(packet.view, 300, 200, {});
    for (const auto& [column, row] : {std::pair{0u, 0u}, {2u, 1u}, {4u, 3u}}) {
      const TileArea a = plan.area(column, row);
      const FramePacket part = make_tile_packet(packet, plan, a);
      EXPECT_EQ(part.overlay.frame.x, a.render_x);
      EXPECT_EQ(part.overlay.frame.width, 300);
      const Camera tile = make_camera(part.view, part.width, part.height, {});
      for (const double x : {0.5, 20.5}) {
        const Ray here = pixel_ray(tile, x, 7.5), there = pixel_ray(whole, a.render_x + x, a.render_y + 7.5);
        EXPECT_LE(norm(here.direction - there.direction), 1e-14);
        EXPECT_LE(norm(here.origin - there.origin), 1e-13);
      }
    }
  }
}

}  // namespace catena::render::tiles_test
