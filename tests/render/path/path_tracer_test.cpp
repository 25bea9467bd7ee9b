// SPDX-License-Identifier: MIT
/// Path tracer against closed forms. Each mean has a standard error of at most 0.3 % of the value and lies within three of it: a bias of 1
/// % would be found.
#include "render/path/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/frame/linear_color.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::path_tracer_test {

using namespace catena::render;

/// An orthographic view of 32 x 32 pixels downwards, 8 units wide, in an environment of radiance 0.5 without lights.
FramePacket make_scene() {
  FramePacket packet = make_packet({0, 0, 40}, {0, 0, 0});
  packet.view.up = {0, 1, 0};
  set_size(packet, 32, 32);
  set_orthographic(packet, 8);
  packet.background = {0, 0, 0, 0};
  packet.illumination.is_linear = true;
  packet.illumination.sky = packet.illumination.ground = {0.5f, 0.5f, 0.5f};
  packet.lights = {{{0, 0, 1}, {0, 0, 0}, true}};
  return packet;
}

/// Mean of the red channel and of the coverage over all pixels, with the standard error over independent images.
struct Estimate {
  double mean = 0, alpha = 0, error = 0, alpha_error = 0;
};
Estimate estimate(const FramePacket& packet, int bounces, std::uint32_t samples, int column = -1) {
  const Result<PathScene> scene = PathScene::make(packet);
  EXPECT_TRUE(bool(scene));
  constexpr int kImages = 24;
  double sum = 0, squares = 0, alphas = 0, alpha_squares = 0;
  for (int seed = 0; seed < kImages; ++seed) {
    PathImage image(*scene, packet, {bounces, std::uint64_t(seed)});
    image.add_samples(samples);
    double mean = 0, alpha = 0;
    int count = 0;
    for (std::size_t i = 0; i < 32 * 32; ++i) {
      if (column >= 0 && int(i % 32) != column) continue;
      double rgba[4];
      image.mean(i, rgba);
      mean += rgba[0], alpha += rgba[3], ++count;
    }
    mean /= count, alpha /= count;
    sum += mean, squares += mean * mean, alphas += alpha, alpha_squares += alpha * alpha;
  }
  const auto deviation = [](double total, double total2) {
    return std::sqrt(std::max(0.0, total2 / kImages - total * total / kImages / kImages) / (kImages - 1));
  };
  return {sum / kImages, alphas / kImages, deviation(sum, squares), deviation(alphas, alpha_squares)};
}

void expect_mean(const Estimate& found, double expected) {
  EXPECT_LE(found.error, 0.003 * expected);
  EXPECT_NEAR(found.mean, expected, 3 * found.error + 1e-6 * expected);
}

/// A homogeneous slab of 4 units below z = 0, wider than the view, of extinction sigma.
FramePacket slab_scene(double sigma, double color = 1) {
  FramePacket packet = make_scene();
  auto grid = make_grid({81, 81, 5}, [](const Vec3&) { return 1.0; });
  packet.volumes.push_back(
      {grid->with_mapping(field::Mapping::from_linear(Mat3(1.0), Vec3(-40, -40, -4))), {{{0, color, color, color}}, {{0, sigma}}, {}}});
  packet.illumination.bounds = packet.volumes[0].grid->world_bounds();
  return packet;
}

// White surfaces in a white furnace cannot be told from it, however often light is scattered.
TEST(PathTracer, WhiteSurfacesInAFurnace) {
  FramePacket packet = make_scene();
  packet.meshes.push_back({square_at(0, 30), {1, 1, 1}});
  std::swap(packet.view.position.y, packet.view.position.z);  // the square's normal is along y
  packet.view.up = {0, 0, 1};
  packet.view.position.y = -40;
  const auto ball = make_grid({33, 33, 33}, [](const Vec3& p) { return 11 - norm(p - Vec3(16)) + std::sin(p.x); });
  packet.isosurfaces.push_back({ball->with_mapping(field::Mapping::from_linear(Mat3(0.2), Vec3(-3.2, -4, -3.2))), 0, {1, 1, 1}});
  auto set = std::make_shared<SphereSet>();
  set->offsets = {{1, -3, 1}, {2, -1, 2}, {-2, -1, 1}};
  set->radii = {1, 0.8f, 0.5f};
  set->colors.assign(3, Color{1, 1, 1});
  packet.spheres.push_back({set});
  packet.illumination.bounds = {Vec3(-30), Vec3(30)};
  const Estimate found = estimate(packet, PathSettings::kUnlimited, 2);
  expect_mean(found, 0.5);
  EXPECT_EQ(found.alpha, 1);
}

// So do volumes of albedo 1, with and without a phase function and reflection by the gradient.
TEST(PathTracer, WhiteVolumesInAFurnace) {
  for (const bool is_shaded : {false, true}) {
    FramePacket packet = make_scene();
    const auto ball = make_grid({33, 33, 33}, [](const Vec3& p) { return std::max(0.0, 12 - norm(p - Vec3(16))); });
    packet.volumes.push_back(
        {ball->with_mapping(field::Mapping::from_linear(Mat3(0.3), Vec3(-4.8))), {{{0, 1, 1, 1}}, {{0, 0}, {6, 3}}, {}}});
    packet.volumes[0].is_shaded = is_shaded;
    packet.volumes[0].scattering = {1, is_shaded ? 0 : 0.6, 0.7};
    packet.illumination.bounds = packet.volumes[0].grid->world_bounds();
    const Estimate found = estimate(packet, PathSettings::kUnlimited, 8);
    expect_mean(found, 0.5 * found.alpha);
  }
}

TEST(PathTracer, ASlabAbsorbsByBeersLaw) {
  const Estimate found = estimate(slab_scene(0.3), 1, 8);
  const double expected = 1 - std::exp(-0.3 * 4);
  EXPECT_LE(found.alpha_error, 0.003 * expected);
  EXPECT_NEAR(found.alpha, expected, 3 * found.alpha_error);
}

// Single scattering in a slab: the integral of sigma exp(-sigma x (1 + 1 / mu)) phase / 4 over its depth.
TEST(PathTracer, ASlabScattersOnceByItsPhaseFunction) {
  for (const double g : {0.0, 0.5, -0.3}) {
    FramePacket packet = slab_scene(0.4, 0.8);
    const Vec3 to_light = direction(Vec3(0.6, 0, 1));
    packet.lights = {{to_light, {2, 2, 2}, false}};
    packet.illumination.sky = packet.illumination.ground = {};
    packet.illumination.shadows = true;
    packet.volumes[0].scattering.anisotropy = g;
    const double mu = to_light.z, base = 1 + g * g + 2 * g * mu;  // light is turned back: the cosine is -mu
    const double phase = (1 - g * g) / std::pow(base, 1.5), rate = 0.4 * (1 + 1 / mu);
    const double expected = 2 * 0.8 * 0.25 * phase * 0.4 * (1 - std::exp(-rate * 4)) / rate;
    expect_mean(estimate(packet, 1, 16), expected);
  }
}

// The first moment of the phase function is g: of an environment that grows with the height a thin slab scatters (1 - g) / 2.
TEST(PathTracer, ThePhaseFunctionsMeanIsItsAnisotropy) {
  for (const double g : {0.7, -0.7}) {
    FramePacket packet = slab_scene(0.5);
    packet.illumination.sky = {1, 1, 1};
    packet.illumination.ground = {0, 0, 0};
    packet.volumes[0].scattering.anisotropy = g;
    expect_mean(estimate(packet, 1, 24), (1 - std::exp(-0.5 * 4)) * 0.5 * (1 - g));
  }
}

// Behind the edge of a half plane, a disc light is seen in part: integrated over the disc.
TEST(PathTracer, APenumbraOfADiscLight) {
  FramePacket packet = make_packet({0, -40, 0}, {0, 0, 0});
  set_size(packet, 32, 32);
  set_orthographic(packet, 8);
  packet.illumination.is_linear = true;
  packet.illumination.sky = packet.illumination.ground = {};
  packet.illumination.shadows = true;
  packet.meshes.push_back({square_at(0, 60), {1, 1, 1}});
  auto half = std::make_shared<MeshGeometry>();
  half->vertices = {{-60, -5, -60}, {0, -5, -60}, {0, -5, 60}, {-60, -5, 60}};
  half->triangles = {0, 1, 2, 0, 2, 3};
  packet.meshes.push_back({half, {1, 1, 1}});
  packet.illumination.bounds = {Vec3(-60), Vec3(60)};
  constexpr double kSize = 30;
  packet.lights = {{{0, -1, 0}, {1, 1, 1}, false, kSize}};
  for (const int column : {17, 19}) {
    double expected = 0, total = 0;
    const double least = std::cos(0.5 * kSize * M_PI / 180);
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double cosine = 1 - (i + 0.5) / kSteps * (1 - least), angle = 2 * M_PI * (j + 0.5) / kSteps;
        const double shift = 5 * std::sqrt(1 - cosine * cosine) / cosine * std::cos(angle);
        // the pixel is a quarter of a unit wide
        const double left = 0.25 * (column - 16), seen = std::clamp((left + 0.25 + shift) / 0.25, 0.0, 1.0);
        expected += seen * cosine;
        total += 1;
      }
    packet.view.window = {};
    expect_mean(estimate(packet, 1, 256, column), expected / total);
  }
}

TEST(PathTracer, TheSameSeedGivesTheSameBits) {
  FramePacket packet = slab_scene(0.5);
  const Result<PathScene> scene = PathScene::make(packet);
  PathImage once(*scene, packet, {8, 3}), parts(*scene, packet, {8, 3}), other(*scene, packet, {8, 4});
  once.add_samples(6);
  parts.add_samples(2);
  parts.add_samples(4);
  other.add_samples(6);
  EXPECT_EQ(once.display(), parts.display());
  EXPECT_NE(once.display(), other.display());
}

}  // namespace catena::test::path_tracer_test
