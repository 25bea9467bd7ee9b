// SPDX-License-Identifier: MIT
// Isosurfaces of cubic grids (field::Interpolation): depths against the field's roots on the CPU, and against quadratics, which cubic
// interpolation reproduces and trilinear does not; shading, colours, number of crossings per ray.
#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "tests/render/support/cubic_rays.h"

namespace catena::test::cubic_surface_test {

using namespace catena::render;
using namespace cubic_rays;

class CubicSurface : public ImageTest {
 protected:
  /// Compares every second pixel's depth with the field's root: within 1e-5 voxels of the surface everywhere, and along the ray for 99 %
  /// of the rays at more than 30 degrees to the surface. For rays that graze the level both results are accepted.
  void compare_depths(const FramePacket& packet, const RenderSettings& settings, const std::string& name, int min_hits) {
    const field::ScalarGrid& grid = *packet.isosurfaces[0].grid;
    const double level = float(packet.isosurfaces[0].level);
    draw(packet, settings, name);
    const std::vector<float> depth = depths();
    const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
    field::Cursor cursor;
    int hits = 0, grazing = 0;
    double worst = 0, worst_away = 0;
    std::vector<double> steep;
    for (std::uint32_t y = 0; y < packet.height; y += 2)
      for (std::uint32_t x = 0; x < packet.width; x += 2) {
        const PixelRay ray(grid, camera, x, y);
        const double found = depth[y * packet.width + x];
        const auto off = [&](double expected) {
          return std::isfinite(found) && std::isfinite(expected)   ? std::fabs(found - expected) * ray.voxels
                 : std::isfinite(found) != std::isfinite(expected) ? HUGE_VAL
                                                                   : 0;
        };
        double expected = ray.from < ray.to ? first_root(grid, level, ray, 0.1, cursor) : HUGE_VAL;
        if (off(expected) > 1e-3) expected = first_root(grid, level, ray, 0.002, cursor);
        if (off(expected) > 1e-3) {
          ++grazing;
          const double early = std::min(found, expected), late = std::max(found, expected);
          double swing = 0;  // deviation from the level at the other result
          for (double t = early; t < std::min(late, early + 0.2 / ray.voxels); t += 0.01 / ray.voxels) {
            const auto s = grid.sample(ray.at(t), cursor);
            if (s.inside) swing = std::max(swing, s.value >= level ? s.value - level : level - s.value);
          }
          EXPECT_LT(swing, 2e-2) << name << " " << x << " " << y << ": found " << found << " expected " << expected;
          continue;
        }
        if (!std::isfinite(found)) continue;
        ++hits;
        const Vec3 slope = grid.sample(ray.at(expected), cursor).gradient;
        // in index space
        const Vec3 normal = glm::transpose(grid.mapping().world_from_index_linear) * slope,
                   along = grid.mapping().index_from_world_linear * ray.direction;
        const double sine = std::fabs(dot(normal, along)) / (norm(normal) * norm(along));
        worst = std::max(worst, off(expected));
        worst_away = std::max(worst_away, off(expected) * sine);
        if (sine > 0.5) steep.push_back(off(expected));
      }
    EXPECT_GT(hits, min_hits) << name;
    ASSERT_FALSE(steep.empty());
    std::sort(steep.begin(), steep.end());
    std::printf("  %-20s hits %6d  grazing %2d  %.1e voxel in the middle, %.1e at worst, %.1e from the surface\n", name.c_str(), hits,
                grazing, steep[steep.size() / 2], worst, worst_away);
    EXPECT_LE(steep[steep.size() * 99 / 100], 1e-5) << name;
    EXPECT_LE(grazing, 5) << name;
    EXPECT_LE(worst_away, 1e-5) << name;
    EXPECT_LE(worst, 1e-4) << name;
  }
};

TEST_F(CubicSurface, DepthsMatchTheRootsOfTheField) {
  const auto waves = noisy_grid({37, 21, 50}, 2, 0.97);
  FramePacket packet = packet_of_grid(*waves, 110);
  packet.isosurfaces = {make_isosurface_item(waves, 0.55)};
  compare_depths(packet, {}, "waves", 800);
  RenderSettings all{.skip_empty = false, .fast = {}};
  compare_depths(packet, all, "waves, every cell", 800);
}

TEST_F(CubicSurface, DepthsOfNoise) {
  const auto noise = noisy_grid({32, 32, 32}, 1, 0);
  FramePacket packet = packet_of_grid(*noise, 95);
  packet.isosurfaces = {make_isosurface_item(noise, 0.5)};
  compare_depths(packet, {}, "noise", 2000);
  packet.isosurfaces = {make_isosurface_item(noise, 1.05)};  // above all sample values
  compare_depths(packet, {}, "beyond the samples", 20);
}

TEST_F(CubicSurface, DepthsOfASheardGridWithHoles) {
  const auto grid = noisy_grid({40, 32, 28}, 3, 0.8, sheared(), 0.02);
  FramePacket packet = packet_of_grid(*grid, 120);
  packet.isosurfaces = {make_isosurface_item(grid, 0.45)};
  compare_depths(packet, {}, "sheared", 800);
  set_orthographic(packet, 50);
  compare_depths(packet, {}, "orthographic", 800);
}

TEST_F(CubicSurface, AQuadraticSurfaceIsExactWithItsNormals) {
  // an ellipsoid, 3.2 to 6.5 voxels across
  const Vec3 c(7.3, 6.9, 8.1), scale(1.0, 0.55, 0.8);
  const auto linear = make_grid({16, 15, 17}, [&](const Vec3& p) { return dot(scale * (p - c), scale * (p - c)); });
  const auto cubic = smoothed_grid(linear);
  FramePacket packet = make_packet(c + Vec3(30, -24, 20), c, 20);
  packet.lights = {{{0.2, -1, 1.5}, {1, 1, 1}, false}};
  RenderSettings settings{.float_image = true, .fast = {}};
  double depth_error[2]{}, color_error[2]{};
  for (const bool smooth_one : {false, true}) {
    packet.isosurfaces = {make_isosurface_item(smooth_one ? cubic : linear, 10.24)};
    ASSERT_TRUE(renderer_->draw(packet, settings));
    const auto depth = renderer_->read_depth();
    const auto colors = renderer_->read_back_float();
    ASSERT_TRUE(depth && colors);
    const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
    int hits = 0;
    for (const auto& [x, y] : pixels_of(packet)) {
      const std::size_t at = y * packet.width + x;
      const PixelRay ray(*linear, camera, x, y);
      const Vec3 o = scale * (ray.origin - c), d = scale * ray.direction;
      const double half = dot(o, d), root = half * half - dot(d, d) * (dot(o, o) - 10.24);
      if (root < 0.5 * dot(d, d)) continue;  // excludes the silhouette
      const double t = (-half - std::sqrt(root)) / dot(d, d);
      ASSERT_TRUE(std::isfinite(depth->depth[at]));
      ++hits;
      depth_error[smooth_one] = std::max(depth_error[smooth_one], std::fabs(depth->depth[at] - t));
      const Vec3 normal = direction(scale * scale * (ray.at(t) - c)), eye = -direction(ray.direction),
                 light = direction(packet.lights[0].direction);
      const double n = dot(normal, light);
      const double glint = n > 0 ? 0.2 * std::pow(std::max(0.0, dot(2 * n * normal - light, eye)), 20) : 0;
      const double red = 0.8 * (0.2 + 0.7 * std::max(0.0, n)) + glint;
      color_error[smooth_one] = std::max(color_error[smooth_one], std::fabs(double(colors->rgba[4 * at]) - red));
    }
    EXPECT_GT(hits, 1500);
  }
  EXPECT_LE(depth_error[1], 2e-5);
  EXPECT_GT(depth_error[0], 0.02) << "linear";
  EXPECT_LE(color_error[1], 2e-3) << "as floats of 11 bits hold it";
  EXPECT_GT(color_error[0], 4 * color_error[1]) << "linear";
}

TEST_F(CubicSurface, ATranslucentSurfaceHasEveryCrossingOfTheField) {
  const auto grid = noisy_grid({24, 22, 20}, 12, 0.9);
  FramePacket packet = packet_of_grid(*grid, 70);
  packet.isosurfaces = {make_isosurface_item(grid, 0.5)};
  packet.isosurfaces[0].opacity = 0.25f;
  RenderSettings settings{.termination = 1e-4, .fast = {}};
  const Image8 image = draw(packet, settings, "translucent");
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  field::Cursor cursor;
  int compared = 0, different = 0;
  for (const auto& [x, y] : pixels_of(packet, 6)) {
    PixelRay ray(*grid, camera, x, y);
    int crossings = 0;
    for (double t; ray.from < ray.to && (t = first_root(*grid, 0.5, ray, 0.05, cursor)) < HUGE_VAL; ++crossings) ray.from = t + 1e-6;
    if (crossings == 0 && image.pixel(x, y)[3] == 0) continue;
    ++compared;
    different += std::fabs(image.pixel(x, y)[3] - 255 * (1 - std::pow(0.75, crossings))) > 1;
  }
  EXPECT_GT(compared, 150);
  EXPECT_LE(different, 3) << "of " << compared;
}

TEST_F(CubicSurface, ColorsByACubicFieldMatchItsValues) {
  const auto shape = make_grid({24, 24, 24}, [](const Vec3& p) { return norm(p - Vec3(11.5)); });
  const auto values = noisy_grid({12, 13, 11}, 13, 0.3, field::Mapping::from_linear(Mat3(2.1), {0, -1, 1}));
  FramePacket packet = make_packet({60, -40, 40}, {11.5, 11.5, 11.5}, 20);
  packet.isosurfaces = {make_isosurface_item(shape, 9)};
  packet.isosurfaces[0].id = 3;
  packet.isosurfaces[0].color_by = ColorSource{values, {{-0.25, 0, 1, 0}, {1.25, 1, 0, 0}}};
  RenderSettings settings{.float_image = true, .fast = {}};
  ASSERT_TRUE(renderer_->draw(packet, settings));
  const auto depth = renderer_->read_depth();
  const auto colors = renderer_->read_back_float();
  ASSERT_TRUE(depth && colors);
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  field::Cursor cursor;
  int compared = 0;
  for (const auto& [x, y] : pixels_of(packet, 2)) {
    const std::size_t at = y * packet.width + x;
    if (!std::isfinite(depth->depth[at])) continue;
    const auto s = values->sample(unproject(camera, x + 0.5, y + 0.5, depth->depth[at]), cursor);
    const float *c = &colors->rgba[4 * at], red = c[0] - c[2], green = c[1] - c[2];  // without the white highlight
    if (!s.inside || red + green < 0.3f) continue;
    ++compared;
    ASSERT_NEAR(red / (red + green), (s.value + 0.25) / 1.5, 5e-3) << x << " " << y;
  }
  EXPECT_GT(compared, 1000);
}

}  // namespace catena::test::cubic_surface_test
