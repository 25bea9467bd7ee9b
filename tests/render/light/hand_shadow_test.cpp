// SPDX-License-Identifier: MIT
/// The hand's shadow against directions over the light's disc that are tested one by one; on volumes; halos of lines.
#include <cmath>
#include <numbers>

#include "render/passes/cursor_parts.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::hand_shadow_test {

using namespace catena::render;

constexpr double kTurn = 2 * std::numbers::pi;

/// A floor at y = 0, seen along +y at 0.05 units a pixel, and a hand one unit in front of it: a probe, a proxy beside it, their link.
FramePacket hand_packet(double angular_size_deg) {
  FramePacket packet = make_packet({0, -10, 0}, {0, 0, 0});
  packet.background = {0, 0, 0, 1};
  set_size(packet, 120, 120);
  set_orthographic(packet, 6);
  packet.meshes.push_back({square_at(0, 2.5), {0.5f, 0.5f, 0.5f}});
  packet.lights = {{{0.6, -1, 0}, {1, 1, 1}, false, angular_size_deg}};
  packet.illumination.shadows = true;
  packet.illumination.bounds = {Vec3(-2.5, 0, -2.5), Vec3(2.5, 0, 2.5)};
  CursorItem cursor;
  cursor.probe = {1, -1, 0};
  cursor.proxies = {{1, -1, 1}};
  cursor.link_active = {true};
  cursor.radius = 0.3;
  packet.cursors.push_back(cursor);
  return packet;
}

double distance_to(const CursorPart& part, const Vec3& from, const Vec3& ray) {
  // closest approach of a ray and the part's axis, by dense points of the axis
  double nearest = 1e9;
  for (int k = 0; k <= 200; ++k) {
    const Vec3 p = part.from + (k / 200.0) * (part.to - part.from) - from;
    if (const double along = dot(p, ray); along > 0) nearest = std::min(nearest, norm(p - along * ray));
  }
  return nearest;
}

/// Returns the share of the light's disc that is not covered, by `count` directions.
double open_share(const FramePacket& packet, const Vec3& from, int count) {
  const LightItem& light = packet.lights[0];
  const Vec3 l = direction(light.direction), a = direction(cross(l, Vec3(0.0, 0.0, 1.0))), b = cross(l, a);
  const double radius = std::tan(0.5 * light.angular_size_deg * kTurn / 360);
  int open = 0;
  for (int i = 0; i < count; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / count), angle = 2.399963229728653 * i;
    const Vec3 ray = direction(l + r * std::cos(angle) * a + r * std::sin(angle) * b);
    bool covered = false;
    for (const CursorPart& part : cursor_parts(packet.cursors[0])) covered = covered || distance_to(part, from, ray) < part.radius;
    open += covered ? 0 : 1;
  }
  return double(open) / count;
}

class HandShadows : public ImageTest {
 protected:
  static int at(const Image8& image, double x, double z) { return image.pixel(std::uint32_t(60 + 20 * x), std::uint32_t(60 - 20 * z))[0]; }
};

TEST_F(HandShadows, CoverTheShareOfTheLightThatDirectionsFind) {
  for (const double size_deg : {6.0, 25.0}) {
    const FramePacket packet = hand_packet(size_deg);
    const Image8 image = draw(packet, {}, "hand");
    const double cosine = 1 / std::sqrt(1.36);
    double widest = 0;
    for (double z = -1.5; z < 2.4; z += 0.1) {
      const double x = 0.4 + 0.5 / 20;  // the shadow's middle, at a pixel's middle
      const double share = open_share(packet, {x, 0, z + 0.5 / 20}, 600);
      const double expected = 255 * 0.5 * (0.2 + 0.7 * cosine * share);
      widest = std::max(widest, std::fabs(at(image, 0.41, z + 0.01) - expected));
    }
    EXPECT_LT(widest, 4) << size_deg;
    EXPECT_LT(at(image, 0.4, 0), at(image, -1.5, -1.5) - 50);
  }
  FramePacket dark = hand_packet(6);
  dark.lights[0].camera_relative = true;
  FramePacket off = hand_packet(6);
  off.illumination.shadows = false;
  for (const FramePacket* packet : {&dark, &off}) {
    const Image8 image = draw(*packet);
    EXPECT_NEAR(at(image, 0.4, 0), at(image, -1.5, -1.5), 2);
  }
}

TEST_F(HandShadows, FallOnVolumesWhereNothingIsRebuilt) {
  const auto grid = make_grid({40, 40, 40}, [](const Vec3& p) { return p.y > 20 ? 1.0 : 0.0; });
  FramePacket packet = make_packet({19.5, -40, 19.5}, {19.5, 10, 19.5});
  packet.background = {0, 0, 0, 1};
  set_size(packet, 80, 80);
  set_orthographic(packet, 40);
  VolumeItem volume;
  volume.grid = grid;
  volume.transfer.colors = {{0, 0.8, 0.8, 0.8}, {1, 0.8, 0.8, 0.8}};
  volume.transfer.extinctions = {{0.5, 0}, {1, 0.4}};
  packet.volumes.push_back(volume);
  packet.lights = {{{0, -1, 0.5}, {0.6f, 0.6f, 0.6f}, false, 3}};
  packet.illumination.shadows = true;
  packet.illumination.bounds = grid->world_bounds();
  CursorItem cursor;
  cursor.probe = {12, 12, 20};
  cursor.radius = 2;
  packet.cursors.push_back(cursor);
  for (const bool fast : {true, false}) {
    RenderSettings settings;
    settings.reuse_rays = true;
    if (fast) settings.fast.emplace();
    draw(packet, settings);
    packet.cursors[0].probe = {26, 12, 20};
    const Image8 moved = draw(packet, settings, fast ? "fast" : "exact");
    EXPECT_TRUE(renderer_->stats().rays_reused);
    // 8.5 voxels in front of the wall: the shadow is half as far below
    EXPECT_LT(moved.pixel(53, 79 - 31)[0], moved.pixel(25, 79 - 31)[0] - 40) << fast;
    EXPECT_NEAR(moved.pixel(25, 79 - 31)[0], moved.pixel(10, 79 - 60)[0], 3) << "no trace of where the hand was";
    packet.cursors[0].probe = {12, 12, 20};
  }
}

TEST_F(HandShadows, AHaloIsDarkerTheFartherBehindAndAbsentAtOneDepth) {
  FramePacket packet = make_packet({0, -10, 0}, {0, 0, 0});
  packet.background = {0, 0, 0, 1};
  set_size(packet, 80, 80);
  set_orthographic(packet, 4);
  const auto line = [&](const Vec3& a, const Vec3& b) {
    TubeItem tube{{a, b}, 0.1, {1, 1, 1}, {}};
    tube.id = 1;
    packet.tubes.push_back(tube);
  };
  // two lines along x, crossed by one along z; the upper one is far behind it, the lower one touches it
  line({-2, 2, 1}, {2, 2, 1});
  line({-2, 0.05, -1}, {2, 0.05, -1});
  line({0, 0, -2}, {0, 0, 2});
  const Image8 plain = draw(packet);
  packet.has_line_halos = true;
  const Image8 halos = draw(packet, {}, "halos");
  const auto x = std::uint32_t(40 + 20 * 0.1);  // beside the crossing line
  EXPECT_LT(halos.pixel(x, 20)[0], plain.pixel(x, 20)[0] / 2);
  EXPECT_EQ(halos.pixel(x, 60)[0], plain.pixel(x, 60)[0]);
  EXPECT_EQ(halos.pixel(x + 8, 20)[0], plain.pixel(x + 8, 20)[0]);
  EXPECT_EQ(halos.pixel(x, 40)[0], plain.pixel(x, 40)[0]) << "the background";
}

}  // namespace catena::test::hand_shadow_test
