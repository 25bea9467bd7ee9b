// SPDX-License-Identifier: MIT
#include <cmath>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::isosurface_test {

using namespace catena::render;

class Isosurface : public ImageTest {};

IsosurfaceItem surface_item(GridPtr grid, double level, float opacity = 1, Color color = {0.8f, 0.8f, 0.9f}) {
  return {std::move(grid), level, color, opacity};
}

/// Distance from `c` on n^3 voxels.
GridPtr distance_grid(int n, const Vec3& c) {
  return make_grid({n, n, n}, [c](const Vec3& p) { return norm(p - c); });
}

/// The grid of y on 32^3 voxels, and its view along y.
GridPtr plane_grid() {
  return make_grid({32, 32, 32}, [](const Vec3& p) { return p.y; });
}
FramePacket along_y() { return make_packet({15.5, -60, 15.5}, {15.5, 0, 15.5}, 20); }

/// A green fog of 0.05 per unit on 32^3 voxels.
VolumeItem fog() {
  return volume_item(make_grid({32, 32, 32}, [](const Vec3&) { return 0.5; }), {{0, 0.05}, {1, 0.05}}, {0, 1, 0});
}

/// The first crossing along a ray by dense search and bisection in double precision; infinite if none.
double cpu_crossing(const field::ScalarGrid& grid, const Ray& ray, double level, double from, double to, double step) {
  field::Cursor cursor;
  const auto f = [&](double t) { return grid.sample(ray.origin + t * ray.direction, cursor).value - level; };
  double a = from, fa = f(a);
  for (double b = from + step; b < to; b += step) {
    const double fb = f(b);
    if ((fa >= 0) != (fb >= 0)) {
      double lo = a, hi = b;
      for (int i = 0; i < 60; ++i) {
        const double mid = 0.5 * (lo + hi);
        ((f(mid) >= 0) == (fa >= 0) ? lo : hi) = mid;
      }
      return 0.5 * (lo + hi);
    }
    a = b;
    fa = fb;
  }
  return HUGE_VAL;
}

void expect_depths(Renderer& renderer, const FramePacket& packet, const field::ScalarGrid& grid, double level, double voxel, int min_hits) {
  const auto depth = renderer.read_depth();
  ASSERT_TRUE(depth);
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  double worst = 0;
  int hits = 0, disagree = 0;
  for (const auto& [x, y] : pixels_of(packet, 2)) {
    const Ray ray = pixel_ray(camera, x + 0.5, y + 0.5);
    const auto [enter, leave] = ray_interval(grid, ray.origin, ray.direction);
    const double t = enter < leave ? cpu_crossing(grid, ray, level, enter + 1e-9, leave, 0.05 * voxel) : HUGE_VAL;
    const double expected = t * -dot(ray.direction, camera.back);
    const double found = depth->depth[y * packet.width + x];
    if (std::isfinite(expected) != std::isfinite(found)) {
      ++disagree;  // grazing rays
    } else if (std::isfinite(expected)) {
      ++hits;
      worst = std::max(worst, std::fabs(found - expected) / voxel);
    }
  }
  EXPECT_GT(hits, min_hits);
  EXPECT_LE(disagree, 2);
  EXPECT_LE(worst, 1e-3);
}

TEST_F(Isosurface, DepthOfASphereMatchesTheField) {
  const Vec3 c(15.3, 16.1, 14.7);
  const auto grid = distance_grid(32, c);
  FramePacket packet = make_packet({70, -50, 55}, c, 25);
  packet.isosurfaces = {surface_item(grid, 11)};
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
    RenderSettings settings{.layout = layout, .fast = {}};
    draw(packet, settings, layout == GridLayout::dense ? "dense" : "atlas");
    expect_depths(*renderer_, packet, *grid, 11, 1, 700);
  }
}

TEST_F(Isosurface, DepthOfARoughFieldOnARotatedGrid) {
  const Mat3 linear = Mat3(0.8, 0.3, 0, -0.4, 1.1, 0.2, 0.1, 0, 1.7);
  const auto grid = make_grid(
      {28, 24, 20}, [](const Vec3& p) { return std::sin(0.9 * p.x) + std::cos(0.8 * p.y) + std::sin(0.7 * p.z + 0.3 * p.x); },
      field::Mapping::from_linear(linear, {-500, 40, 3}));
  const Vec3 centre = grid->mapping().world_from_index({13.5, 11.5, 9.5});
  FramePacket packet = make_packet(centre + Vec3(60, -50, 40), centre, 30);
  packet.isosurfaces = {surface_item(grid, 0.3)};
  draw(packet, {}, "rough");
  expect_depths(*renderer_, packet, *grid, 0.3, 0.8, 800);
}

TEST_F(Isosurface, DepthInOrthographicProjection) {
  const Vec3 c(15.5);
  const auto grid = distance_grid(32, c);
  FramePacket packet = make_packet({70, -50, 55}, c);
  set_orthographic(packet, 30);
  packet.isosurfaces = {surface_item(grid, 10)};
  draw(packet, {}, "sphere");
  expect_depths(*renderer_, packet, *grid, 10, 1, 700);
}

TEST_F(Isosurface, ASphereIsShadedByItsNormal) {
  const Vec3 c(23.5);
  const double radius = 16;
  const auto grid = distance_grid(48, c);
  FramePacket packet = make_packet({100, -60, 70}, c, 22);
  packet.isosurfaces = {surface_item(grid, radius, 1, {0.9f, 0.5f, 0.1f})};
  const Image8 image = draw(packet);
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  int compared = 0;
  for (const auto& [x, y] : pixels_of(packet)) {
    const Ray ray = pixel_ray(camera, x + 0.5, y + 0.5);
    const Vec3 to = ray.origin - c;
    const double b = dot(to, ray.direction), q = b * b - dot(to, to) + radius * radius;
    if (q < 12) continue;  // the silhouette
    const Vec3 n = (to + (-b - std::sqrt(q)) * ray.direction) / radius;
    const double lambert = std::fabs(dot(n, ray.direction)), mirrored = std::max(0.0, 2 * lambert * lambert - 1);
    const double expected = (0.2 + 0.7 * lambert) * 0.9 + 0.2 * std::pow(mirrored, 20);
    ASSERT_NEAR(image.pixel(x, y)[0], 255 * std::min(1.0, expected), 3) << x << " " << y;
    ASSERT_EQ(image.pixel(x, y)[3], 255);
    ++compared;
  }
  EXPECT_GT(compared, 2000);
}

TEST_F(Isosurface, ATranslucentSphereShowsTwoWalls) {
  const Vec3 c(15.5);
  const auto grid = distance_grid(32, c);
  FramePacket packet = make_packet({70, -50, 55}, c, 25);
  packet.isosurfaces = {surface_item(grid, 11, 0.4f)};
  const Image8 image = draw(packet, {}, "shell");
  EXPECT_NEAR(image.pixel(80, 60)[3], 255 * (1 - 0.6 * 0.6), 1);
  EXPECT_EQ(image.pixel(2, 2)[3], 0);
}

TEST_F(Isosurface, ATranslucentSurfaceIsSortedWithTheVolume) {
  // a fog box of sigma s from y = 0 to 31, a plane at y = 16 of opacity 0.5, seen along +y
  FramePacket packet = along_y();
  packet.volumes = {fog()};
  packet.isosurfaces = {surface_item(plane_grid(), 16, 0.5f, {1, 0, 0})};
  packet.background = {0, 0, 1, 1};
  const Image8 image = draw(packet, {}, "sorted");
  const double front = std::exp(-0.05 * 16), all = 0.5 * std::exp(-0.05 * 31);
  const std::uint8_t* p = image.pixel(80, 60);
  // the plane faces the camera: 0.9 of its colour plus a white highlight of 0.2
  EXPECT_NEAR(p[0], 255 * front * 0.5 * 1.1, 1.5);
  EXPECT_NEAR(p[1], 255 * ((1 - front) + 0.5 * front - all + front * 0.5 * 0.2), 1.5);
  EXPECT_NEAR(p[2], 255 * (all + front * 0.5 * 0.2), 1.5);
}

TEST_F(Isosurface, SeveralTranslucentSurfacesAreInOrder) {
  const auto plane = plane_grid();
  FramePacket packet = along_y();
  packet.isosurfaces = {surface_item(plane, 24.5, 0.5f, {0, 0, 1}), surface_item(plane, 8.25, 0.5f, {0, 1, 0})};
  const Image8 image = draw(packet, {}, "planes");
  const std::uint8_t* p = image.pixel(80, 60);
  // premultiplied: near green 0.5, far blue 0.25; alpha 0.75; white highlights of 0.2 each
  EXPECT_NEAR(p[3], 255 * 0.75, 1);
  EXPECT_NEAR(p[1] * 0.75, 255 * (0.5 * 1.1 + 0.25 * 0.2), 2);
  EXPECT_NEAR(p[2] * 0.75, 255 * (0.25 * 1.1 + 0.5 * 0.2), 2);
}

TEST_F(Isosurface, AnOpaqueSurfaceHidesTheVolumeBehindIt) {
  FramePacket packet = along_y();
  packet.volumes = {fog()};
  packet.isosurfaces = {surface_item(plane_grid(), 12.5, 1, {1, 0, 0})};
  const Image8 image = draw(packet, {}, "cut");
  const double front = std::exp(-0.05 * 12.5);
  EXPECT_NEAR(image.pixel(80, 60)[1], 255 * ((1 - front) + front * 0.2), 1.5);
  EXPECT_EQ(image.pixel(80, 60)[3], 255);
}

TEST_F(Isosurface, MaskedCellsHaveNoSurface) {
  const Vec3 c(15.5);
  const auto grid = make_grid(
      {32, 32, 32}, [&](const Vec3& p) { return norm(p - c); }, {}, [](const Vec3& p) { return p.z < 16; });
  FramePacket packet = make_packet({70, -50, 40}, c, 25);
  packet.isosurfaces = {surface_item(grid, 11)};
  draw(packet, {}, "bowl");
  const std::vector<float> depth = depths();
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  int below = 0;
  for (const auto& [x, y] : pixels_of(packet)) {
    const float d = depth[y * packet.width + x];
    if (!std::isfinite(d)) continue;
    EXPECT_LT(unproject(camera, x + 0.5, y + 0.5, d).z, 15.01);
    ++below;
  }
  EXPECT_GT(below, 800);
}

}  // namespace catena::test::isosurface_test
