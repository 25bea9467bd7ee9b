// SPDX-License-Identifier: MIT
#include <cmath>

#include "tests/render/support/image_fixture.h"
#include "tests/support/mesh_shapes.h"

namespace catena::test::mesh_test {

using namespace catena::render;

class Mesh : public ImageTest {};

TubeItem tube_of(const Vec3& a, const Vec3& b, double radius, Color color) { return {{a, b}, radius, color}; }

FramePacket along_y() {
  FramePacket packet = make_packet({15.5, -60, 15.5}, {15.5, 0, 15.5}, 20);
  packet.background = {0, 0, 0, 1};
  return packet;
}

TEST_F(Mesh, ATubeInFrontOfAndBehindAVolume) {
  const auto fog = make_grid({32, 32, 32}, [](const Vec3&) { return 0.5; });
  for (const double y : {-5.0, 15.0, 40.0}) {
    FramePacket packet = along_y();
    packet.volumes = {volume_item(fog, {{0, 0.05}, {1, 0.05}}, {0, 1, 0})};
    packet.tubes = {tube_of({-20, y, 15.5}, {50, y, 15.5}, 2, {1, 0, 0})};
    const Image8 image = draw(packet, {}, "y" + std::to_string(int(y)));
    // the tube's front is at y - 2
    const double length = std::min(31.0, std::max(0.0, y - 2)), through = std::exp(-0.05 * length);
    const std::uint8_t* p = image.pixel(80, 60);
    EXPECT_NEAR(p[0], std::min(255.0, 255 * through * 1.1), 5) << y;
    EXPECT_NEAR(p[1], 255 * ((1 - through) + through * 0.2), 5) << y;
  }
}

TEST_F(Mesh, ColorsVaryAlongATube) {
  FramePacket packet = along_y();
  set_orthographic(packet, 24);
  TubeItem tube = tube_of({3.5, 10, 15.5}, {27.5, 10, 15.5}, 3, {1, 1, 1});
  tube.points = {tube.points[0], Vec3(15.5, 10, 15.5), tube.points[1]};
  tube.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  packet.tubes = {tube};
  const Image8 image = draw(packet, {}, "rainbow");
  // 5 pixels per unit; the centre faces the camera and has a white highlight
  const auto part = [&](std::uint32_t x, int channel) {
    const std::uint8_t* p = image.pixel(x, 60);
    return static_cast<double>(p[channel]) / (p[0] + p[1] + p[2]);
  };
  EXPECT_GT(part(21, 0), 0.65);
  EXPECT_NEAR(part(50, 0), 0.5, 0.1);
  EXPECT_NEAR(part(50, 1), 0.5, 0.1);
  EXPECT_GT(part(80, 1), 0.65);
  EXPECT_NEAR(part(110, 2), 0.5, 0.1);
  EXPECT_GT(part(139, 2), 0.65);
}

TEST_F(Mesh, ArrowsAndTheIndicatorAreDrawn) {
  FramePacket packet = along_y();
  set_orthographic(packet, 24);
  packet.arrows = {{{5.5, 10, 15.5}, {11.5, 10, 15.5}, 3, {1, 0, 0}}};
  packet.indicators = {{tube_of({17.5, 10, 15.5}, {21.5, 10, 15.5}, 1, {0, 1, 0}), {{21.5, 10, 15.5}, {25.5, 10, 15.5}, 2.5, {0, 1, 0}}}};
  const Image8 image = draw(packet, {}, "arrows");
  // wide at its base, empty beyond its tip
  EXPECT_GT(image.pixel(33, 72)[0], 60);
  EXPECT_EQ(image.pixel(55, 72)[0], 0);
  EXPECT_GT(image.pixel(55, 60)[0], 60);
  EXPECT_GT(image.pixel(95, 60)[1], 100);
  EXPECT_GT(image.pixel(114, 68)[1], 40);
  EXPECT_EQ(image.pixel(95, 68)[1], 0);
}

TEST_F(Mesh, DepthOfATubeIsExact) {
  FramePacket packet = along_y();
  packet.tubes = {tube_of({-20, 10, 15.5}, {50, 10, 15.5}, 2, {1, 0, 0})};
  draw(packet, {}, "tube");
  const std::vector<float> depth = depths();
  // 68 from the camera; a faceted tube is slightly thinner
  EXPECT_NEAR(depth[60 * 160 + 80], 68, 0.1);
  EXPECT_TRUE(std::isinf(depth[2 * 160 + 80]));
}

MeshItem item_of(const mesh::TriangleSoup& soup, Color color) { return {geometry_of(soup), color}; }

/// A box seen along y in orthographic projection: a rectangle with sharp edges, one colour and one depth.
TEST_F(Mesh, ABoxHasItsSilhouetteColorAndDepth) {
  FramePacket packet = make_packet({0, -10, 0}, {0, 0, 0});
  packet.background = {0, 0, 0, 1};
  set_orthographic(packet, 12);  // 0.1 per pixel
  packet.meshes = {item_of(box_soup({-2, 1, -1}, {3, 4, 1.5}), {1, 0.5, 0})};
  const Image8 image = draw(packet, {}, "box");
  const std::vector<float> depth = depths();
  for (std::uint32_t y = 0; y < 120; ++y)
    for (std::uint32_t x = 0; x < 160; ++x) {
      const double u = (x - 79.5) * 0.1, v = (59.5 - y) * 0.1;
      const bool inside = u > -2 && u < 3 && v > -1 && v < 1.5;
      const std::uint8_t* p = image.pixel(x, y);
      // facing the camera: 0.9 of the colour and the full highlight
      ASSERT_NEAR(p[0], inside ? 255 : 0, 1) << x << " " << y;
      ASSERT_NEAR(p[1], inside ? 255 * (0.9 * 0.5 + 0.2) : 0, 1) << x << " " << y;
      ASSERT_NEAR(p[2], inside ? 255 * 0.2 : 0, 1) << x << " " << y;
      const float d = depth[y * 160 + x];
      ASSERT_EQ(std::isfinite(d), inside) << x << " " << y;
      if (inside) {
        ASSERT_NEAR(d, 11, 1e-5);
      }
    }
}

/// Rotated by 60 degrees the face is shaded by its own normal: 0.2 + 0.7 cos of the colour, without smoothing across the edge.
TEST_F(Mesh, FacesAreShadedByTheirOwnNormals) {
  FramePacket packet = make_packet({0, -10, 0}, {0, 0, 0});
  packet.background = {0, 0, 0, 1};
  set_orthographic(packet, 12);
  mesh::TriangleSoup roof;
  const double rise = 4 * std::sqrt(3.0);
  add_quad(roof, {0, 0, -4}, {4, rise, -4}, {4, rise, 4}, {0, 0, 4});
  add_quad(roof, {0, 0, -4}, {0, 0, 4}, {-4, 0, 4}, {-4, 0, -4});
  packet.meshes = {item_of(roof, {0, 0, 1})};
  const Image8 image = draw(packet, {}, "roof");
  for (const std::uint32_t x : {81u, 100u, 118u}) EXPECT_NEAR(image.pixel(x, 60)[2], 255 * (0.2 + 0.7 * 0.5), 1.5) << x;
  for (const std::uint32_t x : {42u, 60u, 78u}) EXPECT_EQ(image.pixel(x, 60)[2], 255) << x;
  EXPECT_EQ(image.pixel(125, 60)[2], 0);
}

TEST_F(Mesh, ANearerTubeHidesTheFartherOne) {
  FramePacket packet = along_y();
  const TubeItem red = tube_of({-20, 10, 15.5}, {50, 10, 15.5}, 2, {1, 0, 0}), blue = tube_of({15.5, 4, -9}, {15.5, 4, 40}, 2, {0, 0, 1});
  for (const bool red_first : {true, false}) {
    packet.tubes = red_first ? std::vector{red, blue} : std::vector{blue, red};
    const Image8 image = draw(packet, {}, red_first ? "a" : "b");
    EXPECT_GT(image.pixel(80, 60)[2], 200);
    EXPECT_LT(image.pixel(80, 60)[0], 60);
    EXPECT_GT(image.pixel(20, 60)[0], 150);
  }
}

TEST_F(Mesh, TubeAndOpaqueSurfaceHideEachOther) {
  const auto plane = make_grid({32, 32, 32}, [](const Vec3& p) { return p.y; });
  for (const bool orthographic : {false, true})
    for (const double y : {8.0, 20.0}) {
      FramePacket packet = along_y();
      if (orthographic) set_orthographic(packet, 25);
      packet.isosurfaces = {{plane, 14.5, {0, 1, 0}}};
      packet.tubes = {tube_of({-20, y, 15.5}, {50, y, 15.5}, 2, {1, 0, 0})};
      const Image8 image = draw(packet, {}, std::string(orthographic ? "o" : "p") + std::to_string(int(y)));
      EXPECT_EQ(image.pixel(80, 60)[0] > 150, y < 14) << y << " " << orthographic;
      EXPECT_EQ(image.pixel(80, 60)[1] > 150, y > 14);
    }
}

TEST_F(Mesh, ATubeFarFromTheOriginIsAtItsPosition) {
  const Vec3 far{3e6, -2e6, 1e6};
  FramePacket near_packet = along_y(), far_packet = along_y();
  near_packet.tubes = {tube_of({-4, 10, 12}, {34, 14, 20}, 1, {1, 0.5, 0})};
  far_packet.tubes = {tube_of(far + Vec3(-4, 10, 12), far + Vec3(34, 14, 20), 1, {1, 0.5, 0})};
  far_packet.view.position += far;
  far_packet.view.target += far;
  EXPECT_LE(max_difference(draw(near_packet), draw(far_packet, {}, "far")), 2);
}

TEST_F(Mesh, TheCursorIsDrawn) {
  FramePacket packet = along_y();
  packet.cursors = {{{15.5, 10, 15.5}, {{19, 10, 15.5}}, {true}, {}, 1, {}}};
  const Image8 image = draw(packet, {}, "cursor");
  int covered = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) covered += image.rgba[i] + image.rgba[i + 1] + image.rgba[i + 2] > 30;
  EXPECT_GT(covered, 60);
}

}  // namespace catena::test::mesh_test
