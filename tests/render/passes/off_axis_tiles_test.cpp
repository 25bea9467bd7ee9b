// SPDX-License-Identifier: MIT
/// Off-axis frusta and tiles: a window of the frustum has exactly the pixels of the whole image.
#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::window_test {

using namespace catena::render;

FramePacket scene_packet(bool orthographic) {
  FramePacket packet = make_packet({-14, -32, 22}, {10, 10, 9}, 34);
  packet.background = {0, 0, 0, 1};
  set_size(packet, 120, 80);
  if (orthographic) set_orthographic(packet, 34);
  const auto sphere = make_grid({21, 21, 21}, [](const Vec3& p) { return norm(p - Vec3(10.0)); });
  packet.isosurfaces.push_back({sphere, 5.0, {0.9f, 0.7f, 0.3f}, 1.0f, 1});
  packet.volumes.push_back(volume_item(sphere, {{0, 0.0}, {12, 0.06}, {18, 0.0}}, {0.3f, 0.5f, 1.0f}));
  packet.tubes.push_back({{{-2, 3, 2}, {8, 1, 12}, {22, 8, 16}}, 0.6, {1, 0, 0}});
  packet.clip_planes = {{{10, 10, 14}, {0.1, 0.2, -1}}};
  return packet;
}

class OffAxisTiles : public ImageTest {
 protected:
  void expect_tiles_equal(const FramePacket& whole_packet) {
    const Image8 whole = draw(whole_packet, {}, "whole");
    EXPECT_GT(std::count_if(whole.rgba.begin(), whole.rgba.end(), [](int value) { return value > 60; }), 2000);
    for (std::uint32_t row = 0; row < 2; ++row)
      for (std::uint32_t column = 0; column < 3; ++column) {
        FramePacket packet = whole_packet;
        set_size(packet, 40, 40);
        packet.view.window = {-1 + 2 * column / 3.0, -1 + 2 * (column + 1) / 3.0, 1 - (row + 1.0), 1.0 - row};
        ASSERT_LE(max_difference(draw(packet), whole, 40 * column, 40 * row), 2) << column << " " << row;
      }
  }
};

TEST_F(OffAxisTiles, TilesEqualTheWholeImageInPerspective) { expect_tiles_equal(scene_packet(false)); }

TEST_F(OffAxisTiles, TilesEqualTheWholeImageInOrthographicProjection) { expect_tiles_equal(scene_packet(true)); }

TEST(Window, CameraFunctionsAgreeOffTheAxis) {
  for (const bool orthographic : {false, true}) {
    View view;
    view.position = {1, -8, 3};
    view.target = {0.5, 0, 0.2};
    view.orthographic = orthographic;
    view.height = 5;
    view.window = {-0.4, 1.3, 0.1, 0.9};
    Bounds bounds;
    bounds.extend(Vec3(-1.0));
    bounds.extend(Vec3(1.0));
    const Camera camera = make_camera(view, 170, 80, bounds);
    for (const Vec3& p : {Vec3(0.3, 0.1, -0.2), Vec3(-0.7, 0.9, 0.6)}) {
      const auto pixel = project(camera, p);
      ASSERT_TRUE(pixel);
      EXPECT_LT(norm(unproject(camera, pixel->x, pixel->y, pixel->z) - p), 1e-12);
      const Ray ray = pixel_ray(camera, pixel->x, pixel->y);
      EXPECT_LT(norm(cross(p - ray.origin, ray.direction)), 1e-12);
      // clip space: the same pixel
      const glm::dvec4 clip = clip_from_world(camera) * glm::dvec4(p.x, p.y, p.z, 1.0);
      EXPECT_NEAR((clip.x / clip.w + 1) / 2 * 170, pixel->x, 1e-9);
      EXPECT_NEAR((clip.y / clip.w + 1) / 2 * 80, pixel->y, 1e-9);
      const glm::dvec4 back = world_from_clip(camera) * (clip / clip.w);
      EXPECT_LT(norm(Vec3(back.x, back.y, back.z) / back.w - p), 1e-9);
    }
  }
}

}  // namespace catena::test::window_test
