// SPDX-License-Identifier: MIT
#include <cmath>

#include "tests/render/support/image_fixture.h"

namespace catena::test::renderer_test {

using namespace catena::render;

class Frames : public ImageTest {};

TEST_F(Frames, AnEmptyPacketShowsTheBackground) {
  FramePacket packet = make_packet({0, -5, 0}, {0, 0, 0});
  packet.background = {0.2f, 0.4f, 0.6f, 1};
  const Image8 image = draw(packet);
  const int expected[] = {51, 102, 153, 255};
  for (std::size_t i = 0; i < image.rgba.size(); ++i) ASSERT_EQ(image.rgba[i], expected[i % 4]);
  packet.background = {1, 1, 1, 0};
  const Image8 clear = draw(packet);
  for (const std::uint8_t byte : clear.rgba) ASSERT_EQ(byte, 0);
}

TEST_F(Frames, PassesAreCreatedOnDemand) {
  FramePacket packet = make_packet({30, -40, 30}, {8, 8, 8});
  draw(packet);
  EXPECT_EQ(renderer_->stats().pipelines, 1u);  // compose
  EXPECT_EQ(renderer_->stats().resident_grids, 0u);
  const auto grid = make_grid({16, 16, 16}, [](const Vec3& p) { return p.x / 16; });
  packet.volumes = {volume_item(grid, {{0, 0.1}, {1, 0.1}})};
  draw(packet);
  EXPECT_EQ(renderer_->stats().pipelines, 3u);  // volume, and compose over it
  packet.volumes.clear();
  packet.tubes.push_back({{{0, 0, 0}, {16, 16, 16}}, 1, {}});
  draw(packet);
  EXPECT_EQ(renderer_->stats().pipelines, 5u);  // mesh, and compose over it
  EXPECT_EQ(renderer_->stats().resident_grids, 0u);
}

TEST_F(Frames, TheSecondFrameUploadsNothing) {
  const auto grid = make_grid({40, 40, 40}, [](const Vec3& p) { return p.x / 40; });
  FramePacket packet = make_packet({60, -70, 50}, {20, 20, 20});
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.1}})};
  packet.isosurfaces = {{grid, 0.7, {}}, {grid, 0.3, {}, 0.5f}};
  packet.tubes.push_back({{{0, 0, 0}, {40, 40, 40}}, 1, {}});
  packet.cursors = {cursor_item({0, 0, 0}, 1)};
  draw(packet);
  const RenderStats first = renderer_->stats();
  EXPECT_GT(first.uploads, 3u);
  EXPECT_GT(first.upload_bytes, 40u * 40 * 40 * 2);
  packet.view.position.x += 3;
  draw(packet);
  const RenderStats second = renderer_->stats();
  EXPECT_EQ(second.uploads, first.uploads);
  EXPECT_EQ(second.pipelines, first.pipelines);
  EXPECT_LE(second.gpu_bytes, first.gpu_bytes);
  // an edit of the transfer function does not upload the values
  packet.volumes[0].transfer.extinctions[1][1] = 0.2;
  draw(packet);
  EXPECT_GT(renderer_->stats().uploads, second.uploads);
  EXPECT_LT(renderer_->stats().upload_bytes - second.upload_bytes, 100000u);
}

TEST_F(Frames, UnreferencedResourcesAreFreed) {
  FramePacket packet = make_packet({60, -70, 50}, {20, 20, 20});
  draw(packet);
  const std::uint64_t empty = renderer_->stats().gpu_bytes;
  packet.volumes = {volume_item(make_grid({64, 64, 64}, [](const Vec3& p) { return p.x / 64; }), {{0, 0}, {1, 0.1}})};
  draw(packet);
  const std::uint64_t full = renderer_->stats().gpu_bytes;
  EXPECT_GT(full, empty + 64 * 64 * 64 * 2);
  EXPECT_EQ(renderer_->stats().resident_grids, 1u);
  packet.volumes.clear();
  draw(packet);
  draw(packet);
  EXPECT_EQ(renderer_->stats().resident_grids, 0u);
  EXPECT_LT(renderer_->stats().gpu_bytes, full - 64 * 64 * 64 * 2);
}

TEST_F(Frames, TransparentImagesKeepStraightAlpha) {
  const auto grid = make_grid({16, 16, 16}, [](const Vec3&) { return 0.5; });
  FramePacket packet = make_packet({30, -40, 30}, {8, 8, 8});
  packet.volumes = {volume_item(grid, {{0, 0.01}, {1, 0.01}}, {1, 0.5f, 0})};
  const Image8 clear = draw(packet, {}, "clear");
  packet.background = {0, 0, 0, 1};
  const Image8 black = draw(packet, {}, "black");
  for (std::uint32_t y = 0; y < 120; ++y)
    for (std::uint32_t x = 0; x < 160; ++x) {
      const std::uint8_t* c = clear.pixel(x, y);
      const std::uint8_t* b = black.pixel(x, y);
      ASSERT_EQ(b[3], 255);
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(b[i], c[i] * c[3] / 255.0, 1.01);
    }
  EXPECT_NEAR(clear.pixel(80, 60)[0], 255, 1);
}

TEST_F(Frames, ImagesRepeatAfterAResize) {
  const auto grid = make_grid({16, 16, 16}, [](const Vec3&) { return 0.5; });
  FramePacket packet = make_packet({30, -40, 30}, {8, 8, 8});
  packet.volumes = {volume_item(grid, {{0, 0.1}, {1, 0.1}})};
  const Image8 first = draw(packet);
  set_size(packet, 33, 71);
  EXPECT_EQ(draw(packet).rgba.size(), 33u * 71 * 4);
  set_size(packet, 160, 120);
  EXPECT_EQ(max_difference(first, draw(packet)), 0);
}

TEST_F(Frames, ImpossibleSizesAreRefused) {
  FramePacket packet = make_packet({30, -40, 30}, {8, 8, 8});
  packet.width = 1 << 20;
  expect_refused(packet, "1048576 x 120");
}

}  // namespace catena::test::renderer_test
