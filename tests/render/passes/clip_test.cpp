// SPDX-License-Identifier: MIT
/// Clip planes on volumes, surfaces and triangles, against closed forms.
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::clip_test {

using namespace catena::render;

/// A homogeneous box of 21^3 voxels seen along y, orthographic: one pixel is 0.25 units.
FramePacket box_packet(double sigma) {
  FramePacket packet = square_packet_along_y(120, 30);
  packet.volumes.push_back(volume_item(make_grid({21, 21, 21}, [](const Vec3&) { return 0.5; }), {{0, sigma}, {1, sigma}}));
  return packet;
}

double alpha_of(double sigma, double length) { return 255 * (1 - std::exp(-sigma * length)); }

class Clip : public ImageTest {};

TEST_F(Clip, AnObliquePlaneLeavesAWedgeOfAHomogeneousBox) {
  FramePacket packet = box_packet(0.1);
  packet.clip_planes = {{{10, 10, 10}, {0.3, 1, 0}}};  // y >= 10 - 0.3 (x - 10)
  for (const bool fast : {false, true}) {
    RenderSettings settings;
    if (fast) settings.fast = FastSettings{1, 1, -1, -1};
    const Image8 image = draw(packet, settings, fast ? "fast" : "exact");
    for (std::uint32_t x = 24; x < 96; x += 3) {
      const double world = 10 + (x + 0.5 - 60) * 0.25;
      EXPECT_NEAR(image.pixel(x, 60)[3], alpha_of(0.1, 20 - (10 - 0.3 * (world - 10))), 1.01) << x;
    }
  }
}

TEST_F(Clip, PlanesBehindAndAcrossTheViewInPerspective) {
  FramePacket packet = box_packet(0.05);
  packet.view.orthographic = false;
  packet.view.fovy_deg = 30;
  packet.clip_planes = {{{0, 5, 0}, {0, 1, 0}}, {{12, 0, 0}, {-1, 0, 0}}};  // y >= 5, x <= 12
  const Image8 image = draw(packet, {}, "two");
  const Camera camera = make_camera(packet.view, 120, 120, {});
  for (const Vec3& p : {Vec3(11.7, 5, 10), Vec3(8, 5, 12), Vec3(12.6, 5, 10), Vec3(13.5, 5, 10)}) {
    const auto pixel = project(camera, p);
    const Ray ray = pixel_ray(camera, std::floor(pixel->x) + 0.5, std::floor(pixel->y) + 0.5);
    // entry at y = 5, exit at y = 20 or x = 12
    const double enter = (5 - ray.origin.y) / ray.direction.y, leave = (20 - ray.origin.y) / ray.direction.y;
    double to = leave;
    if (ray.direction.x > 0) to = std::min(to, (12 - ray.origin.x) / ray.direction.x);
    EXPECT_NEAR(image.pixel(std::uint32_t(pixel->x), std::uint32_t(pixel->y))[3], alpha_of(0.05, std::max(0.0, to - enter)), 1.01);
  }
}

TEST_F(Clip, ASurfaceIsDrawnAtItsNextCrossingAndTrianglesAreCut) {
  FramePacket packet = box_packet(0);
  packet.volumes.clear();
  const auto sphere = make_grid({21, 21, 21}, [](const Vec3& p) { return norm(p - Vec3(10.0)); });
  packet.isosurfaces.push_back({sphere, 6.0, {1, 1, 1}, 1.0f, 7});
  packet.tubes.push_back({{{10, 10, 0}, {10, 10, 3}}, 0.5, {1, 0, 0}, {}, 9});
  packet.clip_planes = {{{0, 6, 0}, {0, 1, 0}}, {{0, 0, 2}, {0, 0, 3}}};  // y >= 6, z >= 2
  draw(packet, {}, "cut");
  // in the middle the front of the sphere is clipped: its back is visible through the opening
  EXPECT_NEAR(depths()[60 * 120 + 60], 40 + 10 + 6, 0.05);
  EXPECT_EQ(ids()[60 * 120 + 60], 7u);
  // the tube remains for z >= 2 (rows: z = 10 - (row + 0.5 - 60) / 4)
  const auto id_at = [&](double z) { return ids()[std::size_t(60 + (10 - z) * 4) * 120 + 60]; };
  EXPECT_EQ(id_at(2.8), 9u);
  EXPECT_EQ(id_at(1.0), 0u);
  // an object that is not clipped is complete
  packet.isosurfaces[0].is_clipped = packet.tubes[0].is_clipped = false;
  draw(packet, {}, "whole");
  EXPECT_NEAR(depths()[60 * 120 + 60], 40 + 10 - 6, 0.05);
  EXPECT_EQ(id_at(1.0), 9u);
}

TEST_F(Clip, MoreThanEightPlanesAreAnErrorInOneLine) {
  FramePacket packet = box_packet(0.1);
  packet.clip_planes.resize(9);
  expect_refused(packet, "9 clip planes");
}

}  // namespace catena::test::clip_test
