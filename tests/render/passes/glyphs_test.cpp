// SPDX-License-Identifier: MIT
// Arrow glyphs in the image: start, end, width, occlusion and clipping.
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::glyphs_test {

using namespace catena::render;

class Glyphs : public ImageTest {};

/// View along y with 5 pixels per unit; (x, z) is at pixel (80 + 5 x, 60 - 5 z).
FramePacket along_y() {
  FramePacket packet = make_packet({0, -60, 0}, {0, 0, 0}, 20);
  packet.background = {0, 0, 0, 1};
  set_orthographic(packet, 24);
  return packet;
}

/// An arrow from (-8, 0, 0) to (8, 0, 0) with its head from x = 4; half-widths 1 (shaft) and 2.5 (head).
GlyphItem arrow() {
  GlyphItem item;
  item.glyphs = {{{-8, 0, 0}, {8, 0, 0}, {1, 0, 0}}};
  item.shaft_radius = 1.0 / 16;
  item.head_length = 0.25;
  item.head_radius = 2.5 / 16;
  item.id = 7;
  return item;
}

TEST_F(Glyphs, AnArrowStartsAndEndsAtItsVector) {
  FramePacket packet = along_y();
  packet.glyphs = {arrow()};
  const Image8 image = draw(packet, {}, "arrow");
  const std::vector<std::uint32_t> id = ids();
  const auto expect_id = [&](std::uint32_t expected, const std::vector<std::array<double, 2>>& places) {
    for (const auto& [x, z] : places)
      EXPECT_EQ(id[static_cast<std::size_t>(60 - 5 * z) * 160 + static_cast<std::size_t>(80 + 5 * x)], expected) << x << " " << z;
  };
  // along the axis: covered between the ends only
  expect_id(7, {{-7.8, 0}, {0, 0}, {7.5, 0}});
  expect_id(0, {{-8.4, 0}, {8.4, 0}});
  // half-widths: shaft 1, head 2.5 at its base and half of it at its middle
  expect_id(7, {{0, 0.7}, {4.3, 1.9}, {6, 0.9}});
  expect_id(0, {{0, 1.3}, {3.6, 1.9}, {6, 1.7}});
  EXPECT_GT(image.pixel(80, 60)[0], 150);
  EXPECT_EQ(image.pixel(80, 60)[1], image.pixel(80, 60)[2]) << "red, and white where it shines";
  const auto picked = renderer_->pick(80, 60);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->id, 7u);
  EXPECT_NEAR(unproject(make_camera(packet.view, 160, 120, {}), 80.5, 60.5, picked->depth).y, -1, 0.1) << "its wall, an octagon's";
}

TEST_F(Glyphs, AnArrowWithoutAHeadIsARod) {
  FramePacket packet = along_y();
  GlyphItem item = arrow();
  item.head_length = 0;
  packet.glyphs = {item};
  const Image8 image = draw(packet, {}, "rod");
  EXPECT_GT(image.pixel(118, 60)[0], 60);
  EXPECT_EQ(image.pixel(122, 60)[0], 0);
  EXPECT_EQ(image.pixel(101, 51)[0], 0) << "where the head was";
}

TEST_F(Glyphs, EveryGlyphHasItsSizeAndColor) {
  FramePacket packet = along_y();
  GlyphItem item = arrow();
  item.glyphs = {{{-10, 0, 6}, {6, 0, 6}, {0, 1, 0}}, {{-10, 0, -6}, {-6, 0, -6}, {0, 0, 1}}};
  packet.glyphs = {item};
  const Image8 image = draw(packet, {}, "two");
  EXPECT_GT(image.pixel(55, 30)[1], 100);
  EXPECT_EQ(image.pixel(55, 30)[0], image.pixel(55, 30)[2]);
  EXPECT_GT(image.pixel(36, 90)[2], 100);
  EXPECT_EQ(image.pixel(36, 93)[2], 0) << "a quarter as long, and as wide";
  EXPECT_GT(image.pixel(55, 33)[1], 40);
}

TEST_F(Glyphs, GlyphsAreClippedAndAttenuatedByVolumes) {
  FramePacket packet = along_y();
  packet.glyphs = {arrow()};
  packet.clip_planes = {{{-2, 0, 0}, {1, 0, 0}}};
  Image8 image = draw(packet, {}, "clipped");
  EXPECT_EQ(image.pixel(62, 60)[0], 0);
  EXPECT_GT(image.pixel(80, 60)[0], 100);
  packet.glyphs[0].is_clipped = false;
  EXPECT_GT(draw(packet).pixel(62, 60)[0], 100);
  packet.clip_planes.clear();
  const double bare = draw(packet).pixel(80, 60)[0];
  // 7 of the fog's 15 units are in front of the arrow
  const auto fog = make_grid(
      {16, 16, 16}, [](const Vec3&) { return 0.5; }, field::Mapping::from_linear(Mat3(1.0), {-7.5, -8, -7.5}));
  packet.volumes = {volume_item(fog, {{0, 0.1}, {1, 0.1}}, {0, 0, 1})};
  image = draw(packet, {}, "mist");
  EXPECT_NEAR(image.pixel(80, 60)[0], bare * std::exp(-0.7), 6);
  EXPECT_GT(image.pixel(80, 60)[2], 100);
}

}  // namespace catena::test::glyphs_test
