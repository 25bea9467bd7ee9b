// SPDX-License-Identifier: MIT
// Slices, volumes and projections of cubic grids (field::Interpolation) against the same field on the CPU along each pixel's ray.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/render/support/cubic_rays.h"

namespace catena::test::cubic_picture_test {

using namespace catena::render;
using namespace cubic_rays;

class CubicImage : public ImageTest {};

TEST_F(CubicImage, ASliceMatchesTheFieldsValuesAndContours) {
  const auto grid = noisy_grid({20, 18, 22}, 7, 0.4, sheared(), 0.01);
  FramePacket packet = packet_of_grid(*grid, 45);
  const SliceItem slice{grid, grid_center(*grid) + Vec3(0.3, 0.1, 0.2), {0.6, -0.5, 0.9}, {{-0.2, 0, 1, 0}, {1.2, 1, 0, 0}}};
  packet.slices = {slice};
  const Image8 plain = draw(packet, {}, "plain");
  packet.slices[0].contour_levels = {0.35, 0.65};
  packet.slices[0].line_width = 2;
  packet.slices[0].line_color = {0, 0, 1};
  const Image8 lines = draw(packet, {}, "lines");
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  field::Cursor cursor;
  const auto value_at = [&](double x, double y) -> std::optional<double> {
    const Ray ray = pixel_ray(camera, x, y);
    const auto s =
        grid->sample(ray.origin + dot(slice.normal, slice.point - ray.origin) / dot(slice.normal, ray.direction) * ray.direction, cursor);
    return s.inside ? std::optional(s.value) : std::nullopt;
  };
  int seen_pixels = 0, on = 0, off = 0;
  for (std::uint32_t y = 1; y + 1 < packet.height; ++y)
    for (std::uint32_t x = 1; x + 1 < packet.width; ++x) {
      const auto value = value_at(x + 0.5, y + 0.5);
      if (!value) continue;
      ++seen_pixels;
      const double part = std::clamp((*value + 0.2) / 1.4, 0.0, 1.0);
      ASSERT_NEAR(plain.pixel(x, y)[0], 255 * part, 1) << x << " " << y;
      ASSERT_NEAR(plain.pixel(x, y)[1], 255 * (1 - part), 1);
      const auto right = value_at(x + 0.6, y + 0.5), below = value_at(x + 0.5, y + 0.6);
      if (!right || !below) continue;
      const double slope = std::hypot(*right - *value, *below - *value) / 0.1;
      const double off_level = std::min(std::fabs(*value - 0.35), std::fabs(*value - 0.65));
      const int blue = lines.pixel(x, y)[2];
      if (off_level / slope < 0.1) {
        ++on;
        EXPECT_GT(blue, 200) << x << " " << y;
      }
      if (off_level > 0.2) {
        ++off;
        EXPECT_LT(blue, 30) << x << " " << y;
      }
    }
  EXPECT_GT(seen_pixels, 4000);
  EXPECT_GT(on, 50);
  EXPECT_GT(off, 60);
}

/// Colour and transmittance along a ray in segments of `step`, with a headlight.
std::array<double, 2> integral(const VolumeItem& item, const PixelRay& ray, double step) {
  const auto& [first, last] = std::pair{item.transfer.extinctions.front(), item.transfer.extinctions.back()};
  const int count = std::max(1, int(std::ceil((ray.to - ray.from) / step)));
  const double h = (ray.to - ray.from) / count, length = h * norm(ray.direction);
  const Vec3 eye = direction(ray.direction);
  double through = 1, light = 0;
  field::Cursor cursor;
  for (int k = 0; k < count; ++k) {
    const auto s = item.grid->sample(ray.at(ray.from + (k + 0.5) * h), cursor);
    const double sigma = first[1] + (last[1] - first[1]) * std::clamp((s.value - first[0]) / (last[0] - first[0]), 0.0, 1.0);
    const double n = std::fabs(dot(direction(s.gradient), eye));
    const double lit = item.is_shaded ? 0.2 + 0.7 * n + 0.2 * std::pow(std::max(0.0, 2 * n * n - 1), 20) : 1;
    const double after = through * std::exp(-sigma * length);
    light += (through - after) * lit;
    through = after;
  }
  return {light, 1 - through};
}

TEST_F(CubicImage, AVolumeMatchesTheIntegralOfTheField) {
  const auto grid = noisy_grid({16, 14, 15}, 9, 0.3, sheared());
  FramePacket packet = packet_of_grid(*grid, 60, 35);
  RenderSettings settings = reference_settings();
  for (const bool shade : {false, true}) {
    packet.volumes = {volume_item(grid, {{0.3, 0}, {1.1, 0.2}})};
    packet.volumes[0].is_shaded = shade;
    const Image8 image = draw(packet, settings, shade ? "shaded" : "plain");
    const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
    int compared = 0;
    for (const auto& [x, y] : pixels_of(packet, 5)) {
      const PixelRay ray(*grid, camera, x, y);
      if (!(ray.from < ray.to)) continue;
      ++compared;
      const auto [light, alpha] = integral(packet.volumes[0], ray, 0.05);
      ASSERT_NEAR(image.pixel(x, y)[3], 255 * alpha, 1) << x << " " << y;
      if (alpha > 0.1) {
        ASSERT_NEAR(image.pixel(x, y)[0], 255 * light / alpha, 3) << x << " " << y;
      }
    }
    EXPECT_GT(compared, 150);
  }
}

TEST_F(CubicImage, BricksWithVisibleOvershootsAreNotSkipped) {
  // zeros and ones in a corner, 0.5 elsewhere; only values beyond the samples are visible
  std::mt19937 random(4);
  const auto grid =
      smoothed_grid(make_grid({40, 33, 26}, [&](const Vec3& p) { return p.x < 14 && p.y < 15 ? double(random() & 1) : 0.5; }));
  FramePacket packet = packet_of_grid(*grid, 110);
  RenderSettings all{.skip_empty = false, .fast = {}};
  packet.volumes = {volume_item(grid, {{1.02, 0}, {1.06, 3}})};
  const Image8 leaping = draw(packet, {}, "leaping");
  EXPECT_EQ(max_difference(leaping, draw(packet, all)), 0);
  EXPECT_GT(covered(leaping, 21), 200);
  // the fast raycast, which reads volumes as trilinear, is replaced by exact rays
  EXPECT_EQ(max_difference(leaping, draw(packet, balanced_settings())), 0);
}

TEST_F(CubicImage, ProjectionsFindExtremesBetweenSamples) {
  const auto grid = noisy_grid({20, 18, 16}, 10, 0.5, sheared(), 0.01);
  FramePacket packet = packet_of_grid(*grid, 60, 35);
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  for (const Projection projection : {Projection::maximum, Projection::minimum, Projection::average}) {
    VolumeItem item = volume_item(grid, {{-1, 100}, {2, 100}});
    item.transfer.colors = {{-0.25, 0, 0, 0}, {1.25, 1, 1, 1}};
    item.projection = projection;
    packet.volumes = {item};
    RenderSettings settings{.texel_format = TexelFormat::r32f, .fast = {}};
    settings.step_voxels = 0.05;
    const Image8 image = draw(packet, settings, std::to_string(int(projection)));
    field::Cursor cursor;
    int compared = 0;
    for (const auto& [x, y] : pixels_of(packet, 6)) {
      const PixelRay ray(*grid, camera, x, y);
      if (!(ray.from + 0.5 < ray.to)) continue;
      double max_value = -HUGE_VAL, min_value = HUGE_VAL, sum = 0;
      int count = 0;
      for (int k = 0; k < 1500; ++k) {
        const auto s = grid->sample(ray.at(ray.from + (ray.to - ray.from) * (k + 0.5) / 1500), cursor);
        if (!s.inside) continue;
        max_value = std::max(max_value, s.value);
        min_value = std::min(min_value, s.value);
        sum += s.value;
        ++count;
      }
      if (count == 0) continue;
      ++compared;
      const double value = projection == Projection::maximum ? max_value : projection == Projection::minimum ? min_value : sum / count;
      ASSERT_NEAR(image.pixel(x, y)[0], 255 * (value + 0.25) / 1.5, 1.1) << x << " " << y;
    }
    EXPECT_GT(compared, 100);
  }
}

}  // namespace catena::test::cubic_picture_test
