// SPDX-License-Identifier: MIT
// Depth and id of one pixel, against the whole images and the closed forms of an isosurface and a slice.
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::pick_test {

using namespace catena::render;

class Pick : public ImageTest {};

TEST_F(Pick, ASphereAndASliceAreFoundAtTheirDepth) {
  // |x - c| on 25^3 nodes, level 8; a slice in front of the right half
  const Vec3 centre(12.0);
  const auto grid = make_grid({25, 25, 25}, [&](const Vec3& p) { return norm(p - centre); });
  FramePacket packet = make_packet(centre + Vec3(0, -50, 0), centre);
  packet.isosurfaces = {{grid, 8, {}, 1, 5}};
  ASSERT_TRUE(renderer_->draw(packet));
  EXPECT_EQ(renderer_->view_size(), (std::array<std::uint32_t, 2>{160, 120}));
  const std::vector<std::uint32_t> id = ids();
  const std::vector<float> depth = depths();
  const Camera camera = make_camera(packet.view, 160, 120, {});
  int met = 0;
  for (const auto& [x, y] : {std::pair{80u, 60u}, std::pair{95u, 52u}, std::pair{70u, 75u}, std::pair{2u, 2u}, std::pair{159u, 119u}}) {
    const auto picked = renderer_->pick(x, y);
    ASSERT_TRUE(picked) << picked.error().message;
    const std::size_t at = y * 160 + x;
    EXPECT_EQ(picked->id, id[at]);
    if (picked->id == 0) {
      EXPECT_TRUE(std::isinf(picked->depth));
      continue;
    }
    ++met;
    EXPECT_NEAR(picked->depth, depth[at], 1e-5);
    const Vec3 place = unproject(camera, x + 0.5, y + 0.5, picked->depth);
    EXPECT_NEAR(norm(place - centre), 8, 0.05) << "trilinear between the nodes";
  }
  EXPECT_EQ(met, 3);

  packet.isosurfaces.clear();
  packet.slices = {{grid, centre, {0, 1, 0}, {{0, 1, 0, 0}, {20, 0, 1, 0}}}};
  packet.slices[0].id = 9;
  ASSERT_TRUE(renderer_->draw(packet));
  const auto picked = renderer_->pick(100, 40);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->id, 9u);
  // distance 50 units, minus the depth offset over coplanar surfaces
  EXPECT_NEAR(unproject(camera, 100.5, 40.5, picked->depth).y, 12 - 8e-6 * 50, 1e-4);
}

TEST_F(Pick, WithoutOpaqueObjectsNothingIsFound) {
  FramePacket packet = make_packet({0, -5, 0}, {0, 0, 0});
  ASSERT_TRUE(renderer_->draw(packet));
  const auto picked = renderer_->pick(3, 4);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->id, 0u);
  EXPECT_TRUE(std::isinf(picked->depth));
}

TEST_F(Pick, APickDoesNotChangeTheNextImage) {
  const auto grid = make_grid({9, 9, 9}, [](const Vec3& p) { return p.x; });
  FramePacket packet = make_packet({4, -20, 4}, {4, 4, 4});
  packet.volumes = {volume_item(grid, {{0, 0}, {8, 0.3}})};
  packet.isosurfaces = {{grid, 6, {}, 1, 1}};
  const Image8 first = draw(packet);
  ASSERT_TRUE(renderer_->pick(80, 60));
  ASSERT_TRUE(renderer_->read_back());
  EXPECT_EQ(draw(packet).rgba, first.rgba);
}

TEST_F(Pick, AWindowAreaShowsTheImageBesideBlack) {
  FramePacket packet = make_packet({0, -5, 0}, {0, 0, 0});
  packet.background = {0, 1, 0, 1};
  set_size(packet, 20, 10);
  ASSERT_TRUE(renderer_->draw(packet));
  UiItems items;
  const auto shown = [&](std::uint32_t width, std::uint32_t height) {
    EXPECT_TRUE(renderer_->paint_window(width, height, items));
    auto image = renderer_->read_back_window();
    EXPECT_TRUE(image);
    return *image;
  };
  items.image_area = {10, 5, 30, 15};
  const Image8 window = shown(40, 20);
  for (std::uint32_t y = 0; y < 20; ++y)
    for (std::uint32_t x = 0; x < 40; ++x) {
      const bool inside = x >= 10 && x < 30 && y >= 5 && y < 15;
      ASSERT_EQ(int(window.pixel(x, y)[1]), inside ? 255 : 0) << x << " " << y;
      ASSERT_EQ(int(window.pixel(x, y)[0]), 0);
    }
  // a smaller window shows the visible part of the area, or only the image
  EXPECT_EQ(int(shown(15, 20).pixel(12, 10)[1]), 255);
  EXPECT_EQ(int(shown(15, 20).pixel(2, 2)[1]), 0);
  EXPECT_EQ(int(shown(8, 4).pixel(2, 2)[1]), 255);
}

}  // namespace catena::test::pick_test
