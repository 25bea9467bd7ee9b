// SPDX-License-Identifier: MIT
/// Modes of the exact raycast: opacity by the gradient, colours by another field, jitter, homogeneous bricks, transforms and clip planes
/// of each volume, many surfaces. Against closed forms and sums in double precision.
#include <cmath>
#include <numeric>

#include "tests/render/support/ray_alpha.h"

namespace catena::test::volume_modes_test {

using namespace catena::render;

class VolumeModes : public ImageTest {};

Camera camera_of(const FramePacket& packet) { return make_camera(packet.view, packet.width, packet.height, Bounds{}); }

void expect_alpha(const Image8& image, const FramePacket& packet, double tolerance_255, const OfRay& depth) {
  EXPECT_LE(worst_alpha(image, packet, depth), tolerance_255);
  EXPECT_GT(covered(image, 6), 1000);
}

/// Entry and exit of a ray in a grid's domain, clipped by the planes.
std::array<double, 2> interval_of(const field::ScalarGrid& grid, const Ray& ray, const std::vector<Plane>& clip = {}) {
  const Vec3 o = grid.mapping().index_from_world(ray.origin), d = grid.mapping().index_from_world_linear * ray.direction;
  double enter = 0, leave = 1e9;
  const auto cut = [&](double at, double along) {  // keeps the part with at + t along >= 0
    if (std::fabs(along) < 1e-12) {
      if (at < 0) leave = -1;
    } else if (along > 0) {
      enter = std::max(enter, -at / along);
    } else {
      leave = std::min(leave, -at / along);
    }
  };
  for (int a = 0; a < 3; ++a) {
    cut(o[a] - grid.index_box().lo[a], d[a]);
    cut(grid.index_box().hi[a] - o[a], -d[a]);
  }
  for (const Plane& plane : clip) cut(dot(plane.normal, ray.origin - plane.point), dot(plane.normal, ray.direction));
  return {enter, std::max(enter, leave)};
}

double length_of(const std::array<double, 2>& interval) { return interval[1] - interval[0]; }

RenderSettings fine_settings(double step = 0.25) {
  RenderSettings settings{.step_voxels = step, .texel_format = TexelFormat::r32f, .fast = {}};
  return settings;
}

TEST_F(VolumeModes, TheFactorFollowsTheGradientInWorldUnits) {
  // slope 0.02 per voxel of half a unit up to x = 16, then constant: |grad| = 0.04, then 0; seen along x
  const auto grid = make_grid(
      {33, 20, 20}, [](const Vec3& p) { return 0.02 * std::min(p.x, 16.0); },
      field::Mapping::from_linear(Mat3(0.5, 0, 0, 0, 1, 0, 0, 0, 2), {}));
  FramePacket packet = make_packet({-60, 9.5, 19}, {8, 9.5, 19});
  set_orthographic(packet, 30);
  packet.volumes = {volume_item(grid, {{0, 0.3}, {1, 0.3}})};
  packet.volumes[0].transfer.gradient_factors = {{0, 0}, {0.08, 1}};
  for (const bool shade : {false, true}) {
    packet.volumes[0].is_shaded = shade;
    const Image8 image = draw(packet, fine_settings(), shade ? "shaded" : "plain");
    // the factor falls from one half to zero over x = 15 .. 17: its mean applies
    expect_alpha(image, packet, 1, [&](const Ray& ray) { return length_of(interval_of(*grid, ray)) > 0 ? 0.3 * 0.5 * 8 : 0; });
  }
  packet.volumes[0].transfer.gradient_factors = {{0.01, 0}, {0.03, 0.25}};  // constant beyond its ends
  expect_alpha(draw(packet, fine_settings()), packet, 2, [&](const Ray& ray) {
    // 0.25 where |grad| >= 0.03, linear down to 0.01: x = 15 .. 15.5 full, .. 16.5 falling
    return length_of(interval_of(*grid, ray)) > 0 ? 0.3 * 0.25 * 0.5 * (15.5 + 0.5) : 0;
  });
}

TEST_F(VolumeModes, GradientFactorsAreDrawnByExactRays) {
  const auto grid =
      make_grid({24, 24, 24}, [](const Vec3& p) { return 0.5 + 0.4 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y + 0.3 * p.z); });
  FramePacket packet = make_packet({60, -40, 45}, {11.5, 11.5, 11.5});
  RenderSettings fast{.fast = FastSettings{1, 1, -1, -1}};
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.3}})};
  EXPECT_TRUE(renderer_->can_draw_fast(packet));
  FramePacket factors = packet, colored = packet, projected = packet;
  factors.volumes[0].transfer.gradient_factors = {{0, 0}, {0.3, 1}};
  colored.volumes[0].color_by = ColorSource{grid, {{0, 1, 0, 0}, {1, 0, 0, 1}}};
  projected.volumes[0].projection = Projection::maximum;
  for (const FramePacket& p : {factors, colored, projected}) {
    EXPECT_FALSE(renderer_->can_draw_fast(p));
    EXPECT_EQ(max_difference(draw(p, fast), draw(p)), 0);
  }
}

TEST_F(VolumeModes, AVolumeIsColoredByAnotherFieldAtTheSamePosition) {
  const auto grid = even_grid({24, 24, 24});
  // covers a part only, rotated and finer
  const auto other = make_grid(
      {30, 26, 28}, [](const Vec3& p) { return (p.x + 2 * p.y - p.z + 27) / 106; },
      field::Mapping::from_linear(turned(0.5, -0.3) * Mat3(0.6), {8, 2, 3}));
  FramePacket packet = make_packet({60, -40, 45}, {11.5, 11.5, 11.5});
  packet.volumes = {volume_item(grid, {{0, 0.06}, {1, 0.06}}, {0, 1, 0})};
  packet.volumes[0].color_by = ColorSource{other, {{0, 1, 0, 0}, {1, 0, 0, 1}}};
  const Image8 image = draw(packet, fine_settings(0.1), "by other");
  const Camera camera = camera_of(packet);
  int both = 0;
  double worst = 0;
  for (const auto& [x, y] : pixels_of(image, 3)) {
    const Ray ray = pixel_ray(camera, x + 0.5, y + 0.5);
    const auto [enter, leave] = interval_of(*grid, ray);
    const int steps = 2000;
    const double h = (leave - enter) / steps;
    if (leave - enter < 2) continue;
    Vec3 sum(0.0);
    bool inside = false, outside = false;
    for (int k = 0; k < steps; ++k) {
      const double s = (k + 0.5) * h;
      const Vec3 index = other->mapping().index_from_world(ray.origin + (enter + s) * ray.direction);
      const bool in = index.x >= 0 && index.y >= 0 && index.z >= 0 && index.x <= 29 && index.y <= 25 && index.z <= 27;
      (in ? inside : outside) = true;
      const double v = std::clamp((index.x + 2 * index.y - index.z + 27) / 106, 0.0, 1.0);
      sum += (in ? Vec3(1 - v, 0, v) : Vec3(0, 1, 0)) * (std::exp(-0.06 * s) * (1 - std::exp(-0.06 * h)));
    }
    both += inside && outside;
    const double alpha = 1 - std::exp(-0.06 * (leave - enter));
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::fabs(image.pixel(x, y)[c] - 255 * sum[c] / alpha));
  }
  EXPECT_GT(both, 150);
  EXPECT_LE(worst, 3);
}

TEST_F(VolumeModes, ASurfaceIsColoredByAnotherField) {
  // the plane y = 10 seen along y; the other field, world x / 20, covers only x >= 6.3
  const auto plane = make_grid({21, 21, 21}, [](const Vec3& p) { return p.y; });
  const auto other = make_grid(
      {30, 30, 30}, [](const Vec3& p) { return (6.3 + 0.7 * p.x) / 20; }, field::Mapping::from_linear(Mat3(0.7), {6.3, 0, 0}));
  FramePacket packet = square_packet_along_y(120, 30);
  const ColorSource by_other{other, {{0, 0, 0, 0}, {1, 0.8, 0, 0}}};
  for (const float opacity : {1.0f, 0.5f}) {
    packet.isosurfaces = {{plane, 10, {0, 0.5f, 0}, opacity, 3, true, by_other}};
    const Image8 image = draw(packet, {}, opacity < 1 ? "translucent" : "opaque");
    for (std::uint32_t x = 22; x < 98; x += 3) {
      const double world = 10 + (x + 0.5 - 60) * 0.25;
      const auto lit = [](double c) { return 255 * std::min(1.0, 0.9 * c + 0.2); };
      const bool covered = world > 6.3;
      EXPECT_NEAR(image.pixel(x, 60)[0], lit(covered ? 0.8 * world / 20 : 0), 1.5) << x;
      EXPECT_NEAR(image.pixel(x, 60)[1], lit(covered ? 0 : 0.5), 1.5) << x;
      EXPECT_NEAR(image.pixel(x, 60)[3], 255 * opacity, 1);
    }
  }
}

TEST_F(VolumeModes, JitterDoesNotChangeHomogeneousFog) {
  const auto grid = even_grid({20, 33, 12});
  const auto second = even_grid({12, 12, 12}, field::Mapping::from_linear(turned(0.4, 0.9) * Mat3(1.3), {4, 9, -5}));
  FramePacket packet = make_packet({52, -41, 37}, {9.5, 16, 5.5}, 40);
  packet.jitter = true;
  for (const double step : {0.3, 1.0, 4.0, 50.0}) {
    RenderSettings settings{.step_voxels = step, .fast = {}};
    packet.volumes = {volume_item(grid, {{0, 0.1}, {1, 0.1}})};
    expect_alpha(draw(packet, settings), packet, 1, even_depth(grid, 0.1));
    packet.volumes.push_back(volume_item(second, {{0, 0.05}, {1, 0.05}}));
    expect_alpha(draw(packet, settings), packet, 1,
                 [&](const Ray& ray) { return even_depth(grid, 0.1)(ray) + even_depth(second, 0.05)(ray); });
  }
}

TEST_F(VolumeModes, JitterTurnsRingsIntoNoise) {
  const Vec3 c(23.5);
  const auto grid = make_grid({48, 48, 48}, [&](const Vec3& p) { return std::exp(-0.3 * std::pow(norm(p - c) - 17, 2)); });
  FramePacket packet = make_packet({120, -80, 90}, c, 22);
  packet.volumes = {volume_item(grid, {{0, 0}, {0.3, 0}, {1, 0.2}})};
  const Image8 truth = draw(packet, reference_settings(), "reference");
  RenderSettings coarse{.step_voxels = 4, .fast = {}};
  const Image8 rings = draw(packet, coarse, "rings");
  packet.jitter = true;
  const Image8 grain = draw(packet, coarse, "grain");
  EXPECT_EQ(max_difference(grain, draw(packet, coarse)), 0) << "the same picture every time";
  EXPECT_GT(max_difference(grain, rings), 20);
  // remaining error after a blur over 8 x 8 pixels
  const auto blurred_error = [&](const Image8& p) {
    double sum = 0;
    for (std::uint32_t y = 0; y + 8 <= p.height; y += 8)
      for (std::uint32_t x = 0; x + 8 <= p.width; x += 8) {
        double block = 0;
        for (std::uint32_t i = 0; i < 64; ++i) block += double(p.pixel(x + i % 8, y + i / 8)[3]) - truth.pixel(x + i % 8, y + i / 8)[3];
        sum += block * block / (64 * 64);
      }
    return std::sqrt(sum);
  };
  EXPECT_LT(blurred_error(grain), 0.6 * blurred_error(rings));
}

TEST_F(VolumeModes, SkippingHomogeneousBricksChangesNothing) {
  // plateaus of three heights with slopes between them, and a table that is constant over the lower two rises
  const auto grid = make_grid({64, 56, 48}, [](const Vec3& p) {
    const double s = norm(p - Vec3(30, 28, 24));
    return s < 14 ? 1.0 : s < 17 ? 1 - 0.5 * (s - 14) / 3 : p.x < 20 ? 0.25 : p.x < 22 ? 0.25 + 0.125 * (p.x - 20) : 0.5;
  });
  FramePacket packet = make_packet({110, -90, 80}, {31, 27, 23}, 28);
  packet.volumes = {volume_item(grid, {{0, 0.01}, {0.4, 0.01}, {0.45, 0.02}, {0.8, 0.02}, {0.9, 0.1}, {1, 0.1}})};
  packet.volumes[0].transfer.colors = {{0, 0.1, 0.2, 0.9}, {0.3, 0.1, 0.2, 0.9}, {0.45, 0.9, 0.8, 0.1}, {0.6, 0.9, 0.8, 0.1}, {1, 1, 0, 0}};
  const auto small = make_grid(
      {24, 24, 24}, [](const Vec3&) { return 1.0; }, field::Mapping::from_linear(turned(0.2, 0.7), {20, 10, 5}));
  for (const bool two : {false, true})
    for (const bool jitter : {false, true})
      for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
        if (two) packet.volumes.resize(1), packet.volumes.push_back(volume_item(small, {{0, 0.01}, {1, 0.01}}));
        packet.jitter = jitter;
        RenderSettings settings{.layout = layout, .fast = {}};
        settings.termination = 0;
        const Image8 with = draw(packet, settings, two ? "two" : "one");
        settings.skip_empty = false;
        EXPECT_LE(max_difference(with, draw(packet, settings)), 1);
      }
  // shaded volumes and volumes with a gradient factor are not homogeneous at a constant value
  packet.volumes.resize(1);
  packet.volumes[0].is_shaded = true;
  packet.volumes[0].transfer.gradient_factors = {{0, 0.3}, {0.2, 1}};
  RenderSettings all{.skip_empty = false, .fast = {}};
  EXPECT_EQ(max_difference(draw(packet, {}, "shaded"), draw(packet, all)), 0);
}

TEST_F(VolumeModes, EachVolumeHasItsTransformAndItsClipping) {
  const std::vector<GridPtr> grids{
      even_grid({20, 20, 20}),
      even_grid({20, 14, 9}, field::Mapping::from_linear(turned(0.4, -0.9) * Mat3(0.8, 0, 0, 0, 1.2, 0, 0.3, 0, 2), {9, 4, -2})),
      even_grid({9, 12, 30}, field::Mapping::from_linear(turned(-1.1, 0.6), {3, 16, 8})),
      even_grid({16, 16, 16}, field::Mapping::from_linear(Mat3(-1, 0, 0, 0, 0.5, 0, 0, 0, 1.5), {22, 6, 0}))};
  const double sigmas[] = {0.04, 0.03, 0.05, 0.02};
  FramePacket packet = make_packet({90, -70, 60}, {12, 10, 10});
  packet.clip_planes = {{{12, 9, 9}, {1, 0.5, -0.2}}, {{0, 0, 16}, {0, 0, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    packet.volumes.push_back(volume_item(grids[i], {{0, sigmas[i]}, {1, sigmas[i]}}));
    packet.volumes.back().is_clipped = i % 2 == 0;
  }
  const OfRay depth = [&](const Ray& ray) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += sigmas[i] * length_of(interval_of(*grids[i], ray, packet.volumes[i].is_clipped ? packet.clip_planes : std::vector<Plane>{}));
    return sum;
  };
  expect_alpha(draw(packet, {}, "four"), packet, 1, depth);
  set_orthographic(packet, 50);
  expect_alpha(draw(packet), packet, 1, depth);
}

TEST_F(VolumeModes, AClippedSurfaceShowsTheVolumeBehindIt) {
  // fog from y = 0 to 20 with the plane y = 5 in it, cut away for x < 10; seen along y
  const auto fog = even_grid({21, 21, 21});
  const auto plane = make_grid({21, 21, 21}, [](const Vec3& p) { return p.y; });
  FramePacket packet = square_packet_along_y(120, 30);
  packet.volumes = {volume_item(fog, {{0, 0.05}, {1, 0.05}}, {0, 0, 1})};
  packet.volumes[0].is_clipped = false;
  packet.clip_planes = {{{10, 0, 0}, {1, 0, 0}}};
  for (const float opacity : {1.0f, 0.4f}) {
    packet.isosurfaces = {{plane, 5, {1, 0, 0}, opacity}};
    const Image8 image = draw(packet, {}, opacity < 1 ? "translucent" : "opaque");
    EXPECT_NEAR(image.pixel(40, 60)[3], 255 * (1 - std::exp(-0.05 * 20)), 1);
    EXPECT_NEAR(image.pixel(80, 60)[3], 255 * (1 - std::exp(-0.05 * (opacity < 1 ? 20 : 5)) * (1 - opacity)), 1);
    const double behind = opacity < 1 ? std::exp(-0.25) * (1 - opacity) * (1 - std::exp(-0.75)) : 0;
    const double alpha = image.pixel(80, 60)[3] / 255.0;
    const double blue = (1 - std::exp(-0.25)) + behind + std::exp(-0.25) * opacity * 0.2, red = std::exp(-0.25) * opacity;
    EXPECT_NEAR(image.pixel(80, 60)[2], 255 * blue / alpha, 2);
    EXPECT_NEAR(image.pixel(80, 60)[0], 255 * std::min(1.0, 1.1 * red / alpha), 2);
  }
}

TEST_F(VolumeModes, EightTranslucentSurfacesInOrder) {
  const auto plane = make_grid({21, 21, 21}, [](const Vec3& p) { return p.y; });
  FramePacket packet = square_packet_along_y(64, 16);
  double through = 1, red = 0;
  for (const int i : {5, 2, 7, 0, 3, 1, 6, 4})  // in random order
    packet.isosurfaces.push_back({plane, 2.0 + 2 * i, {0.1f * float(i), 0, 0}, 0.1f + 0.05f * float(i)});
  for (int i = 0; i < 8; ++i) {
    red += through * (0.1 + 0.05 * i) * (0.9 * 0.1 * i + 0.2);
    through *= 1 - (0.1 + 0.05 * i);
  }
  const Image8 image = draw(packet);
  EXPECT_NEAR(image.pixel(32, 32)[3], 255 * (1 - through), 1);
  EXPECT_NEAR(image.pixel(32, 32)[0], 255 * red / (1 - through), 1.5);
  packet.volumes = {volume_item(plane, {{0, 0.1}, {1, 0.1}})};
  expect_refused(packet, "expected at most 8 together");
}

}  // namespace catena::test::volume_modes_test
