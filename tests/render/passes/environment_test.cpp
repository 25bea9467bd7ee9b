// SPDX-License-Identifier: MIT
/// Lights, fog, bounding box and ground, against the formulas of shaders/lib/lighting.glsl and closed forms.
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::environment_test {

using namespace catena::render;

/// A square perpendicular to y at `y`, seen along +y in orthographic projection: 0.1 units per pixel.
FramePacket square_packet(double y, const Color& color) {
  FramePacket packet = make_packet({0, -10, 0}, {0, 0, 0});
  packet.background = {0, 0, 0, 1};
  set_size(packet, 60, 60);
  set_orthographic(packet, 6);
  packet.meshes.push_back({square_at(y, 2), color});
  return packet;
}

class EnvironmentPass : public ImageTest {
 protected:
  std::array<int, 3> middle(const FramePacket& packet, const std::string& name, const RenderSettings& settings = {}) {
    const Image8 image = draw(packet, settings, name);
    const std::uint8_t* p = image.pixel(packet.width / 2, packet.height / 2);
    return {p[0], p[1], p[2]};
  }
};

void expect_color(const std::array<int, 3>& found, const Vec3& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[std::size_t(c)], 255 * std::min(1.0, expected[c]), 1.01) << c;
}

TEST_F(EnvironmentPass, AWorldLightShadesByItsAngle) {
  FramePacket packet = square_packet(0, {0.5f, 0.6f, 0.7f});
  const Vec3 color(0.5, 0.6, 0.7), to_eye(0, -1, 0);
  expect_color(middle(packet, "headlight"), 0.9 * color + Vec3(0.2));
  const Vec3 l = direction(Vec3(1, -1, 1)), white(1.0);
  packet.lights = {{{1, -1, 1}, {1.0f, 0.5f, 0.25f}, false}};
  const double d = dot(l, to_eye), m = std::max(0.0, dot(2 * d * to_eye - l, to_eye));
  const Vec3 shine = 0.7 * d * color + 0.2 * std::pow(m, 20) * white;
  expect_color(middle(packet, "side"), 0.2 * color + Vec3(1.0, 0.5, 0.25) * shine);
  // behind the surface: only ambient light
  packet.lights[0].direction = {1, 1, 1};
  expect_color(middle(packet, "behind"), 0.2 * color);
  // two lights add
  packet.lights = {{{1, -1, 1}, {1, 0, 0}, false}, {{-1, -1, -1}, {0, 0, 1}, false}};
  expect_color(middle(packet, "two"), 0.2 * color + Vec3(1, 0, 1) * shine);
}

TEST_F(EnvironmentPass, ACameraLightRotatesWithTheCamera) {
  // (right, up, towards the camera): equal to (1, -1, 1) above for any camera direction
  for (const bool turned : {false, true}) {
    FramePacket packet = square_packet(0, {0.5f, 0.5f, 0.5f});
    packet.lights = {{{1, 1, 1}, {1, 1, 1}, true}};
    if (turned) packet.view.position = {0, 10, 0};
    const double d = 1 / std::sqrt(3.0), mirrored = std::max(0.0, 2 * d - d);
    expect_color(middle(packet, turned ? "turned" : "straight"), Vec3(0.1 + 0.35 * d + 0.2 * std::pow(mirrored, 20)));
  }
}

TEST_F(EnvironmentPass, FogBlendsByDepth) {
  const Vec3 fog(0.1, 0.3, 0.8);
  for (const double y : {-7.0, -2.0, 1.0, 9.0}) {
    FramePacket packet = square_packet(y, {0.5f, 0.25f, 0.1f});
    packet.fog = FogItem{{0.1f, 0.3f, 0.8f}, 5, 15, 0.6};
    const double share = 0.6 * std::clamp((y + 10 - 5) / 10, 0.0, 1.0);
    expect_color(middle(packet, ""), (1 - share) * (0.9 * Vec3(0.5, 0.25, 0.1) + Vec3(0.2)) + share * fog);
  }
}

TEST_F(EnvironmentPass, FogBlendsAnIsosurfaceAndAThinVolume) {
  // z of the grid along the view; the surface at index 10
  const auto grid = make_grid({21, 21, 21}, [](const Vec3& p) { return p.y; });
  FramePacket packet = make_packet({10, -20, 10}, {10, 0, 10});
  packet.background = {0, 0, 0, 1};
  set_size(packet, 60, 60);
  set_orthographic(packet, 12);
  packet.isosurfaces.push_back({grid, 10.0, {0.5f, 0.25f, 0.1f}, 1.0f});
  packet.fog = FogItem{{0.1f, 0.3f, 0.8f}, 25, 35, 1};
  expect_color(middle(packet, "surface"), 0.5 * (0.9 * Vec3(0.5, 0.25, 0.1) + Vec3(0.2)) + 0.5 * Vec3(0.1, 0.3, 0.8));
  // dense and beyond the end of the fog: all its colour is fogged
  packet.isosurfaces.clear();
  packet.volumes.push_back(volume_item(grid, {{0, 0}, {15.8, 0}, {16, 400}, {16.2, 0}, {20, 0}}, {0.5f, 0.25f, 0.1f}));
  RenderSettings settings{.step_voxels = 0.02, .fast = {}};
  expect_color(middle(packet, "volume", settings), Vec3(0.1, 0.3, 0.8));
}

TEST_F(EnvironmentPass, BoundingBoxAndGroundAreAtTheirPositions) {
  FramePacket packet = square_packet(0, {0.2f, 0.2f, 0.2f});
  packet.environment.tubes.push_back({{{-2.5, 0, 2.5}, {2.5, 0, 2.5}}, 0.1, {1, 0, 0}, {}, 4});
  packet.clip_planes = {{{0, 0, 0}, {0, 0, -1}}};  // clips the square, not the bounding box
  draw(packet, {}, "clipped");
  EXPECT_EQ(ids()[5 * 60 + 30], 4u);
  EXPECT_EQ(renderer_->stats().passes, (std::vector<std::string>{"aids", "meshes", "compose"}));
  EXPECT_TRUE(std::isinf(depths()[20 * 60 + 30]));
  EXPECT_NEAR(depths()[40 * 60 + 30], 10, 1e-4);
}

TEST_F(EnvironmentPass, FogIsDrawnByExactRays) {
  FramePacket packet = make_packet({10, -40, 10}, {10, 10, 10});
  packet.volumes.push_back(volume_item(make_grid({21, 21, 21}, [](const Vec3& p) { return p.x; }), {{0, 0.1}, {20, 0.1}}));
  EXPECT_TRUE(renderer_->can_draw_fast(packet));
  packet.lights = {{{1, 0, 0}, {1, 1, 1}, false}};
  EXPECT_TRUE(renderer_->can_draw_fast(packet));
  packet.fog = FogItem{};
  EXPECT_FALSE(renderer_->can_draw_fast(packet));
}

}  // namespace catena::test::environment_test
