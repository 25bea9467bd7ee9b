// SPDX-License-Identifier: MIT
// Picked positions against closed forms.
#include "engine/app/viewer/input/pick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "engine/field/grid/grid.h"

namespace catena::app::pick_test {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// The grid of f(world) on 33^3 nodes of the box -2..2.
std::shared_ptr<const field::ScalarGrid> grid_of(const std::function<double(const Vec3&)>& f) {
  constexpr int n = 33;
  Mat3 j(4.0 / (n - 1));
  const field::Mapping mapping = field::Mapping::from_linear(j, Vec3(-2.0));
  std::vector<float> values;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) values.push_back(static_cast<float>(f(mapping.world_from_index(Vec3(x, y, z)))));
  return field::make_scalar_grid("f", mapping, {n, n, n}, values);
}

render::FramePacket packet_with(const std::function<double(const Vec3&)>& f, const std::vector<std::array<double, 2>>& extinctions) {
  render::FramePacket packet;
  packet.width = packet.height = 101;
  packet.view.position = {-6, 0, 0};
  packet.view.target = {0, 0, 0};
  render::VolumeItem item;
  item.grid = grid_of(f);
  item.transfer.extinctions = extinctions;
  item.id = packet.add_object("volume", "f");
  packet.volumes.push_back(item);
  return packet;
}

const render::Ray kAlongX{{-6, 0, 0}, {1, 0, 0}};

TEST(Pick, AUniformVolumeIsPickedAtHalfOpacity) {
  const auto packet = packet_with([](const Vec3&) { return 1.0; }, {{0, 0.4}, {2, 0.4}});
  const PickHit place = pick_volume(packet, kAlongX, kNone).value();
  EXPECT_TRUE(place.is_volume);
  EXPECT_NEAR(place.world.x, -2 + std::log(2) / 0.4, 1e-6);
  EXPECT_EQ(object_label(packet, place.id), "volume f");
}

TEST(Pick, ALinearExtinctionIsPickedAtHalfOpacity) {
  // With sigma = a (x + 2), the opacity is half where 1 - exp(-a t^2 / 2) = 1/2.
  const double a = 0.3;
  const auto packet = packet_with([](const Vec3& p) { return p.x; }, {{-2, 0}, {2, 4 * a}});
  EXPECT_NEAR(pick_volume(packet, kAlongX, kNone).value().world.x, -2 + std::sqrt(2 * std::log(2) / a), 2e-3);
}

TEST(Pick, AFaintShellIsPickedAtItsMaximumContribution) {
  // A peak of sigma at x = 0.7, with an opacity below a half.
  const auto packet = packet_with([](const Vec3& p) { return p.x; }, {{0.2, 0}, {0.7, 0.3}, {1.2, 0}});
  const PickHit place = pick_volume(packet, kAlongX, kNone).value();
  EXPECT_NEAR(place.world.x, 0.7, 0.07);
  EXPECT_NEAR(place.opacity, 1 - std::exp(-0.15), 2e-3);
  const auto nothing = packet_with([](const Vec3& p) { return p.x; }, {{0.2, 0}, {0.7, 0.02}, {1.2, 0}});
  EXPECT_FALSE(pick_volume(nothing, kAlongX, kNone));
}

TEST(Pick, AMaximumProjectionIsPickedAtTheMaximum) {
  auto packet = packet_with([](const Vec3& p) { return -(p.x - 0.5) * (p.x - 0.5); }, {{-10, 0}, {0, 9}});
  packet.volumes[0].projection = render::Projection::maximum;
  EXPECT_NEAR(pick_volume(packet, kAlongX, kNone).value().world.x, 0.5, 0.07);
}

TEST(Pick, ClipPlanesApplyUnlessTheVolumeIgnoresThem) {
  auto packet = packet_with([](const Vec3&) { return 1.0; }, {{0, 2}, {2, 2}});
  packet.clip_planes.push_back({{0.3, 0, 0}, {1, 0, 0}});
  EXPECT_NEAR(pick_volume(packet, kAlongX, kNone)->world.x, 0.3 + std::log(2) / 2, 1e-6);
  packet.volumes[0].is_clipped = false;
  EXPECT_NEAR(pick_volume(packet, kAlongX, kNone)->world.x, -2 + std::log(2) / 2, 1e-6);
}

TEST(Pick, ASurfaceIsPickedInFrontOfHalfOpacityOnly) {
  const auto packet = packet_with([](const Vec3&) { return 1.0; }, {{0, 0.4}, {2, 0.4}});
  // The volume is half opaque at -2 + 1.73: a surface at x = -1 is nearer, and one at x = 1 is hidden.
  const PickHit before = pick(packet, 50.5, 50.5, 5, 7).value(), behind = pick(packet, 50.5, 50.5, 7, 7).value();
  EXPECT_FALSE(before.is_volume);
  EXPECT_EQ(before.id, 7u);
  EXPECT_NEAR(before.world.x, -1, 1e-9);
  EXPECT_TRUE(behind.is_volume);
  EXPECT_NEAR(behind.world.x, -2 + std::log(2) / 0.4, 1e-6);
}

TEST(Pick, DepthsBecomePositionsOnASphereAndAPlane) {
  render::FramePacket packet;
  packet.width = 160;
  packet.height = 120;
  packet.view.position = {0, -5, 2};
  packet.view.target = {0, 0, 0};
  const render::Camera camera = render::make_camera(packet.view, 160, 120, Bounds());
  for (const auto& [x, y] : {std::pair{80.5, 60.5}, std::pair{95.5, 50.5}, std::pair{70.5, 72.5}}) {
    const render::Ray ray = render::pixel_ray(camera, x, y);
    // The intersection with the unit sphere: |o + t d| = 1.
    const double b = dot(ray.origin, ray.direction), c = dot(ray.origin, ray.origin) - 1, t = -b - std::sqrt(b * b - c);
    const Vec3 truth = ray.origin + t * ray.direction;
    EXPECT_NEAR(norm(pick(packet, x, y, -dot(camera.back, truth - camera.position), 3).value().world - truth), 0, 1e-12);
    const Vec3 on_plane = ray.origin + (0.4 - ray.origin.z) / ray.direction.z * ray.direction;
    EXPECT_NEAR(pick(packet, x, y, -dot(camera.back, on_plane - camera.position), 3)->world.z, 0.4, 1e-12);
  }
  EXPECT_FALSE(pick(packet, 80, 60, kNone, 0));
}

TEST(Pick, AnArrowIsPickedOnItsShaftAndItsHead) {
  render::FramePacket packet;
  render::GlyphItem item;
  item.glyphs = {{{0, -2, 0}, {0, 2, 0}, {1, 0, 0}}, {{3, -1, 0}, {3, 1, 0}, {1, 0, 0}}};
  item.shaft_radius = 0.05;
  item.head_length = 0.25;
  item.head_radius = 0.15;
  item.id = packet.add_object("glyphs", "v", "glyphs[0]");
  packet.glyphs = {item};
  const auto met = [&](double y, double z) { return pick_solid(packet, {{-6, y, z}, {1, 0, 0}}, kNone); };
  EXPECT_NEAR(met(0, 0).value().world.x, -0.2, 1e-9);
  EXPECT_EQ(object_label(packet, met(0, 0)->id), "glyphs v");
  EXPECT_TRUE(met(1.5, 0.25));
  EXPECT_FALSE(met(0, 0.25));
  EXPECT_FALSE(met(2.7, 0));
  packet.clip_planes = {{{1, 0, 0}, {1, 0, 0}}};
  EXPECT_NEAR(met(0, 0).value().world.x, 2.9, 1e-9) << "the first one is cut away";
}

}  // namespace catena::app::pick_test
