// SPDX-License-Identifier: MIT
/// Shared helpers for images of cubic grids: rough grids, and the field along a pixel's ray.
#pragma once
#include <cmath>
#include <optional>
#include <random>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::cubic_rays {

inline GridPtr smoothed_grid(const GridPtr& grid) {
  auto made = grid->as_cubic();
  EXPECT_TRUE(made);
  return made ? *made : nullptr;
}

/// Noise and waves in 0..1; `waves` is the fraction of the waves.
inline GridPtr noisy_grid(const field::Index3& n, unsigned seed, double waves, const field::Mapping& mapping = {}, double masked = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::function<bool(const Vec3&)> valid;
  if (masked > 0) valid = [&](const Vec3&) { return uniform(random) >= masked; };
  return smoothed_grid(make_grid(
      n,
      [&](const Vec3& p) {
        const double wave = std::sin(0.4 * p.x) * std::sin(0.5 * p.y + 1) * std::sin(0.45 * p.z + 2 + 0.1 * p.x);
        return waves * (0.5 + 0.5 * wave) + (1 - waves) * uniform(random);
      },
      mapping, valid));
}

inline field::Mapping sheared() { return field::Mapping::from_linear(Mat3(0.8, 0.3, 0.1, -0.4, 1.1, 0.2, 0.1, 0.05, 1.7), {-300, 40, 3}); }

inline Vec3 grid_center(const field::ScalarGrid& grid) {
  return grid.mapping().world_from_index(0.5 * (grid.index_box().lo + grid.index_box().hi));
}

inline render::FramePacket packet_of_grid(const field::ScalarGrid& grid, double distance, double fovy_deg = 30) {
  return make_packet(grid_center(grid) + distance * direction(Vec3(1, -0.7, 0.6)), grid_center(grid), fovy_deg);
}

inline render::IsosurfaceItem make_isosurface_item(GridPtr grid, double level) { return {std::move(grid), level, {0.8f, 0.6f, 0.4f}}; }

/// A pixel's world ray, parametrized by depth, and its range in a grid's box.
struct PixelRay {
  Vec3 origin, direction;
  double from = 0, to = HUGE_VAL, voxels = 1;  ///< range of depth in the box; voxels per unit of depth

  PixelRay(const field::ScalarGrid& grid, const render::Camera& camera, std::uint32_t x, std::uint32_t y) {
    const render::Ray ray = render::pixel_ray(camera, x + 0.5, y + 0.5);
    direction = ray.direction / dot(ray.direction, -camera.back);
    origin = ray.origin - dot(ray.origin - camera.position, -camera.back) * direction;
    voxels = norm(grid.mapping().index_from_world_linear * direction);
    const auto [enter, leave] = ray_interval(grid, origin, direction);
    from = enter;
    to = leave;
  }
  Vec3 at(double t) const { return origin + t * direction; }
};

/// Depth of the first root of the field along the ray, by steps and bisection; HUGE_VAL if none.
inline double first_root(const field::ScalarGrid& grid, double level, const PixelRay& ray, double step_voxels, field::Cursor& cursor) {
  double before = ray.from;
  std::optional<bool> was;
  const int count = std::max(1, int(std::ceil((ray.to - ray.from) * ray.voxels / step_voxels)));
  for (int k = 0; k <= count; ++k) {
    double t = ray.from + (ray.to - ray.from) * k / count;
    const field::ScalarSample s = grid.sample(ray.at(t), cursor);
    const bool above = s.value >= level;
    if (s.inside && was && *was != above) {
      double low = before, high = t;
      for (int n = 0; n < 50; ++n) {
        const double half = 0.5 * (low + high);
        ((grid.sample(ray.at(half), cursor).value >= level) == *was ? low : high) = half;
      }
      return high;
    }
    was = s.inside ? std::optional(above) : std::nullopt;
    before = t;
  }
  return HUGE_VAL;
}

}  // namespace catena::test::cubic_rays
