// Cubic grids (field::Interpolation) as every pass draws them: against the same field on the CPU at each pixel's place, and against
// polynomials of second degree, which a cubic repeats and a trilinear mix does not.
#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <random>

#include "render/frame/camera.h"
#include "tests/render/support/frames.h"

namespace catena::test {
namespace cubic_picture_test {

using namespace catena::render;

GridPtr smooth(const GridPtr& grid) {
  auto made = grid->cubic();
  EXPECT_TRUE(made);
  return made ? *made : nullptr;
}

/// Noise and waves in 0..1; `waves` is the share of these.
GridPtr noisy(const field::Index3& n, unsigned seed, double waves, const field::Mapping& mapping = {}, double masked = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::function<bool(const Vec3&)> valid;
  if (masked > 0) valid = [&](const Vec3&) { return uniform(random) >= masked; };
  return smooth(make_grid(
      n,
      [&](const Vec3& p) {
        const double wave = std::sin(0.4 * p.x) * std::sin(0.5 * p.y + 1) * std::sin(0.45 * p.z + 2 + 0.1 * p.x);
        return waves * (0.5 + 0.5 * wave) + (1 - waves) * uniform(random);
      },
      mapping, valid));
}

field::Mapping sheared() { return field::Mapping::from_linear(Mat3(0.8, 0.3, 0.1, -0.4, 1.1, 0.2, 0.1, 0.05, 1.7), {-300, 40, 3}); }

Vec3 middle_of(const field::ScalarGrid& grid) { return grid.mapping().world_from_index(0.5 * (grid.index_box().lo + grid.index_box().hi)); }

FramePacket seen(const field::ScalarGrid& grid, double distance, double fovy_deg = 30) {
  return packet_of(middle_of(grid) + distance * direction(Vec3(1, -0.7, 0.6)), middle_of(grid), fovy_deg);
}

IsosurfaceItem surface_of(GridPtr grid, double level) {
  IsosurfaceItem item;
  item.grid = std::move(grid);
  item.level = level;
  item.color = {0.8f, 0.6f, 0.4f};
  return item;
}

/// A pixel's ray by its depth, in the world, and where it is in the box of a grid.
struct PixelRay {
  Vec3 origin, direction;
  double from = 0, to = HUGE_VAL, voxels = 1;  ///< voxels a unit of depth

  PixelRay(const field::ScalarGrid& grid, const Camera& camera, std::uint32_t x, std::uint32_t y) {
    const Ray ray = ray_through(camera, x + 0.5, y + 0.5);
    direction = ray.direction / dot(ray.direction, -camera.back);
    origin = ray.origin - dot(ray.origin - camera.position, -camera.back) * direction;
    const Vec3 d = grid.mapping().index_from_world_linear * direction, o = grid.mapping().index_from_world(origin);
    voxels = norm(d);
    for (int a = 0; a < 3; ++a) {
      const double s = (grid.index_box().lo[a] - o[a]) / d[a], t = (grid.index_box().hi[a] - o[a]) / d[a];
      from = std::max(from, std::min(s, t));
      to = std::min(to, std::max(s, t));
    }
  }
  Vec3 at(double t) const { return origin + t * direction; }
};

/// The first root of the field's own values, looked for in steps and bisected; HUGE_VAL where there is none.
double first_root(const field::ScalarGrid& grid, double level, const PixelRay& ray, double step_voxels, field::Cursor& cursor) {
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

class CubicPicture : public PictureTest {
 protected:
  /// Every second pixel's depth against the field's own root: within 1e-5 voxels of the surface everywhere, and along the ray where it
  /// meets the surface at more than 30 degrees for 99 of 100. Where a ray only grazes the level either answer will do.
  void compare_depths(const FramePacket& packet, const RenderSettings& settings, const std::string& name, int least_hits) {
    const field::ScalarGrid& grid = *packet.isosurfaces[0].grid;
    const double level = float(packet.isosurfaces[0].level);
    draw(packet, settings, name);
    const auto depth = renderer_->read_depth();
    ASSERT_TRUE(depth);
    const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
    field::Cursor cursor;
    int hits = 0, grazing = 0;
    double worst = 0, worst_away = 0;
    std::vector<double> steep;
    for (std::uint32_t y = 0; y < packet.height; y += 2)
      for (std::uint32_t x = 0; x < packet.width; x += 2) {
        const PixelRay ray(grid, camera, x, y);
        const double found = depth->depth[y * packet.width + x];
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
          double swing = 0;  // what the answer that was not taken makes of it
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
        // both in index space
        const Vec3 normal = glm::transpose(grid.mapping().world_from_index_linear) * slope,
                   along = grid.mapping().index_from_world_linear * ray.direction;
        const double sine = std::fabs(dot(normal, along)) / (norm(normal) * norm(along));
        worst = std::max(worst, off(expected));
        worst_away = std::max(worst_away, off(expected) * sine);
        if (sine > 0.5) steep.push_back(off(expected));
      }
    EXPECT_GT(hits, least_hits) << name;
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

TEST_F(CubicPicture, DepthsAreTheRootsOfTheFieldItself) {
  const auto waves = noisy({37, 21, 50}, 2, 0.97);
  FramePacket packet = seen(*waves, 110);
  packet.isosurfaces = {surface_of(waves, 0.55)};
  compare_depths(packet, {}, "waves", 800);
  RenderSettings all;
  all.skip = false;
  compare_depths(packet, all, "waves, every cell", 800);
}

TEST_F(CubicPicture, DepthsOfNoise) {
  const auto noise = noisy({32, 32, 32}, 1, 0);
  FramePacket packet = seen(*noise, 95);
  packet.isosurfaces = {surface_of(noise, 0.5)};
  compare_depths(packet, {}, "noise", 2000);
  packet.isosurfaces = {surface_of(noise, 1.05)};  // above all samples
  compare_depths(packet, {}, "beyond the samples", 20);
}

TEST_F(CubicPicture, DepthsOfASheardGridWithHoles) {
  const auto grid = noisy({40, 32, 28}, 3, 0.8, sheared(), 0.02);
  FramePacket packet = seen(*grid, 120);
  packet.isosurfaces = {surface_of(grid, 0.45)};
  compare_depths(packet, {}, "sheared", 800);
  packet.view.orthographic = true;
  packet.view.height = 50;
  compare_depths(packet, {}, "orthographic", 800);
}

TEST_F(CubicPicture, AQuadraticSurfaceIsItselfWithItsNormals) {
  // an ellipsoid, 3.2 to 6.5 voxels across
  const Vec3 c(7.3, 6.9, 8.1), scale(1.0, 0.55, 0.8);
  const auto linear = make_grid({16, 15, 17}, [&](const Vec3& p) { return dot(scale * (p - c), scale * (p - c)); });
  const auto cubic = smooth(linear);
  FramePacket packet = packet_of(c + Vec3(30, -24, 20), c, 20);
  packet.lights = {{{0.2, -1, 1.5}, {1, 1, 1}, false}};
  RenderSettings settings;
  settings.float_picture = true;
  double depth_error[2]{}, color_error[2]{};
  for (const bool smooth_one : {false, true}) {
    packet.isosurfaces = {surface_of(smooth_one ? cubic : linear, 10.24)};
    ASSERT_TRUE(renderer_->draw(packet, settings));
    const auto depth = renderer_->read_depth();
    const auto colors = renderer_->read_back_float();
    ASSERT_TRUE(depth && colors);
    const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
    int hits = 0;
    for (std::uint32_t y = 0; y < packet.height; ++y)
      for (std::uint32_t x = 0; x < packet.width; ++x) {
        const std::size_t at = y * packet.width + x;
        const PixelRay ray(*linear, camera, x, y);
        const Vec3 o = scale * (ray.origin - c), d = scale * ray.direction;
        const double half = dot(o, d), root = half * half - dot(d, d) * (dot(o, o) - 10.24);
        if (root < 0.5 * dot(d, d)) continue;  // a rim of the picture is left out
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

TEST_F(CubicPicture, ASliceHasTheFieldsOwnValuesAndLines) {
  const auto grid = noisy({20, 18, 22}, 7, 0.4, sheared(), 0.01);
  FramePacket packet = seen(*grid, 45);
  SliceItem slice;
  slice.grid = grid;
  slice.point = middle_of(*grid) + Vec3(0.3, 0.1, 0.2);
  slice.normal = {0.6, -0.5, 0.9};
  slice.colors = {{-0.2, 0, 1, 0}, {1.2, 1, 0, 0}};
  packet.slices = {slice};
  const Picture plain = draw(packet, {}, "plain");
  packet.slices[0].levels = {0.35, 0.65};
  packet.slices[0].line_width = 2;
  packet.slices[0].line_color = {0, 0, 1};
  const Picture lines = draw(packet, {}, "lines");
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  field::Cursor cursor;
  const auto value_at = [&](double x, double y) -> std::optional<double> {
    const Ray ray = ray_through(camera, x, y);
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
      const double away = std::min(std::fabs(*value - 0.35), std::fabs(*value - 0.65)) / slope;
      const int blue = lines.pixel(x, y)[2];
      if (away < 0.1) {
        ++on;
        EXPECT_GT(blue, 200) << x << " " << y;
      }
      if (std::min(std::fabs(*value - 0.35), std::fabs(*value - 0.65)) > 0.2) {
        ++off;
        EXPECT_LT(blue, 30) << x << " " << y;
      }
    }
  EXPECT_GT(seen_pixels, 4000);
  EXPECT_GT(on, 50);
  EXPECT_GT(off, 60);
}

/// Light and what gets through, in segments of `step`; a headlight.
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
    const double lit = item.shade ? 0.2 + 0.7 * n + 0.2 * std::pow(std::max(0.0, 2 * n * n - 1), 20) : 1;
    const double after = through * std::exp(-sigma * length);
    light += (through - after) * lit;
    through = after;
  }
  return {light, 1 - through};
}

TEST_F(CubicPicture, AVolumeIsTheIntegralOfTheFieldAndItsGradient) {
  const auto grid = noisy({16, 14, 15}, 9, 0.3, sheared());
  FramePacket packet = seen(*grid, 60, 35);
  RenderSettings settings = reference_settings();
  for (const bool shade : {false, true}) {
    packet.volumes = {volume_item(grid, {{0.3, 0}, {1.1, 0.2}})};
    packet.volumes[0].shade = shade;
    const Picture picture = draw(packet, settings, shade ? "shaded" : "plain");
    const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
    int compared = 0;
    for (std::uint32_t y = 0; y < packet.height; y += 5)
      for (std::uint32_t x = 0; x < packet.width; x += 5) {
        const PixelRay ray(*grid, camera, x, y);
        if (!(ray.from < ray.to)) continue;
        ++compared;
        const auto [light, alpha] = integral(packet.volumes[0], ray, 0.05);
        ASSERT_NEAR(picture.pixel(x, y)[3], 255 * alpha, 1) << x << " " << y;
        if (alpha > 0.1) {
          ASSERT_NEAR(picture.pixel(x, y)[0], 255 * light / alpha, 3) << x << " " << y;
        }
      }
    EXPECT_GT(compared, 150);
  }
}

TEST_F(CubicPicture, NoBrickIsPassedThatAnOvershootMakesVisible) {
  // noughts and ones in a corner, halves elsewhere; seen is only what lies beyond the samples
  std::mt19937 random(4);
  const auto grid = smooth(make_grid({40, 33, 26}, [&](const Vec3& p) { return p.x < 14 && p.y < 15 ? double(random() & 1) : 0.5; }));
  FramePacket packet = seen(*grid, 110);
  RenderSettings all;
  all.skip = false;
  packet.volumes = {volume_item(grid, {{1.02, 0}, {1.06, 3}})};
  const Picture leaping = draw(packet, {}, "leaping");
  EXPECT_EQ(max_difference(leaping, draw(packet, all)), 0);
  int visible = 0;
  for (std::size_t i = 3; i < leaping.rgba.size(); i += 4) visible += leaping.rgba[i] > 20;
  EXPECT_GT(visible, 200);
  // and what asks for the fast raycast gets these rays: it reads its volumes as trilinear
  EXPECT_EQ(max_difference(leaping, draw(packet, balanced_settings())), 0);
}

TEST_F(CubicPicture, ProjectionsFindWhatLiesBetweenSamples) {
  const auto grid = noisy({20, 18, 16}, 10, 0.5, sheared(), 0.01);
  FramePacket packet = seen(*grid, 60, 35);
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  for (const Projection projection : {Projection::maximum, Projection::minimum, Projection::average}) {
    VolumeItem item = volume_item(grid, {{-1, 100}, {2, 100}});
    item.transfer.colors = {{-0.25, 0, 0, 0}, {1.25, 1, 1, 1}};
    item.projection = projection;
    packet.volumes = {item};
    RenderSettings settings;
    settings.texels = TexelFormat::r32f;
    settings.step_voxels = 0.05;
    const Picture picture = draw(packet, settings, std::to_string(int(projection)));
    field::Cursor cursor;
    int compared = 0;
    for (std::uint32_t y = 0; y < packet.height; y += 6)
      for (std::uint32_t x = 0; x < packet.width; x += 6) {
        const PixelRay ray(*grid, camera, x, y);
        if (!(ray.from + 0.5 < ray.to)) continue;
        double most = -HUGE_VAL, least = HUGE_VAL, sum = 0;
        int count = 0;
        for (int k = 0; k < 1500; ++k) {
          const auto s = grid->sample(ray.at(ray.from + (ray.to - ray.from) * (k + 0.5) / 1500), cursor);
          if (!s.inside) continue;
          most = std::max(most, s.value);
          least = std::min(least, s.value);
          sum += s.value;
          ++count;
        }
        if (count == 0) continue;
        ++compared;
        const double value = projection == Projection::maximum ? most : projection == Projection::minimum ? least : sum / count;
        ASSERT_NEAR(picture.pixel(x, y)[0], 255 * (value + 0.25) / 1.5, 1.1) << x << " " << y;
      }
    EXPECT_GT(compared, 100);
  }
}

TEST_F(CubicPicture, ATranslucentSurfaceIsCrossedAsOftenAsTheField) {
  const auto grid = noisy({24, 22, 20}, 12, 0.9);
  FramePacket packet = seen(*grid, 70);
  packet.isosurfaces = {surface_of(grid, 0.5)};
  packet.isosurfaces[0].opacity = 0.25f;
  RenderSettings settings;
  settings.termination = 1e-4;
  const Picture picture = draw(packet, settings, "translucent");
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  field::Cursor cursor;
  int compared = 0, different = 0;
  for (std::uint32_t y = 0; y < packet.height; y += 6)
    for (std::uint32_t x = 0; x < packet.width; x += 6) {
      PixelRay ray(*grid, camera, x, y);
      int crossings = 0;
      for (double t; ray.from < ray.to && (t = first_root(*grid, 0.5, ray, 0.05, cursor)) < HUGE_VAL; ++crossings) ray.from = t + 1e-6;
      if (crossings == 0 && picture.pixel(x, y)[3] == 0) continue;
      ++compared;
      different += std::fabs(picture.pixel(x, y)[3] - 255 * (1 - std::pow(0.75, crossings))) > 1;
    }
  EXPECT_GT(compared, 150);
  EXPECT_LE(different, 3) << "of " << compared;
}

TEST_F(CubicPicture, ColoursByACubicFieldAreItsValues) {
  const auto shape = make_grid({24, 24, 24}, [](const Vec3& p) { return norm(p - Vec3(11.5)); });
  const auto values = noisy({12, 13, 11}, 13, 0.3, field::Mapping::from_linear(Mat3(2.1), {0, -1, 1}));
  FramePacket packet = packet_of({60, -40, 40}, {11.5, 11.5, 11.5}, 20);
  packet.isosurfaces = {surface_of(shape, 9)};
  packet.isosurfaces[0].id = 3;
  packet.isosurfaces[0].color_by = ColorSource{values, {{-0.25, 0, 1, 0}, {1.25, 1, 0, 0}}};
  RenderSettings settings;
  settings.float_picture = true;
  ASSERT_TRUE(renderer_->draw(packet, settings));
  const auto depth = renderer_->read_depth();
  const auto colors = renderer_->read_back_float();
  ASSERT_TRUE(depth && colors);
  const Camera camera = make_camera(packet.view, packet.width, packet.height, Bounds{});
  field::Cursor cursor;
  int compared = 0;
  for (std::uint32_t y = 0; y < packet.height; y += 2)
    for (std::uint32_t x = 0; x < packet.width; x += 2) {
      const std::size_t at = y * packet.width + x;
      if (!std::isfinite(depth->depth[at])) continue;
      const auto s = values->sample(unproject(camera, x + 0.5, y + 0.5, depth->depth[at]), cursor);
      const float *c = &colors->rgba[4 * at], red = c[0] - c[2], green = c[1] - c[2];  // without the glint, which is white
      if (!s.inside || red + green < 0.3f) continue;
      ++compared;
      ASSERT_NEAR(red / (red + green), (s.value + 0.25) / 1.5, 5e-3) << x << " " << y;
    }
  EXPECT_GT(compared, 1000);
}

}  // namespace cubic_picture_test
}  // namespace catena::test
