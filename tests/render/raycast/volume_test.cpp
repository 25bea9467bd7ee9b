// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "render/frame/camera.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test {
namespace volume_test {

using namespace catena::render;

class Volume : public ImageTest {};

/// Compares alpha with 1 - exp(-tau(ray)) at every pixel.
void expect_alpha(const Image8& image, const FramePacket& packet, double tolerance_255, const std::function<double(const Ray&)>& depth) {
  Bounds none;
  const Camera camera = make_camera(packet.view, packet.width, packet.height, none);
  double worst = 0;
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const double expected = 255 * (1 - std::exp(-depth(pixel_ray(camera, x + 0.5, y + 0.5))));
      worst = std::max(worst, std::fabs(image.pixel(x, y)[3] - expected));
    }
  EXPECT_LE(worst, tolerance_255);
}

int covered(const Image8& image) {
  int count = 0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) count += image.rgba[i] > 0;
  return count;
}

TEST_F(Volume, AHomogeneousBoxSeenObliquelyIsExact) {
  const auto grid = make_grid({20, 33, 12}, [](const Vec3&) { return 0.5; });
  FramePacket packet = make_packet({52, -41, 37}, {9.5, 16, 5.5}, 40);
  for (const double sigma : {0.02, 0.1, 1.0}) {
    packet.volumes = {volume_item(grid, {{0, sigma}, {1, sigma}}, {0.2f, 0.5f, 0.9f})};
    for (const double step : {0.25, 0.5, 1.0}) {
      RenderSettings settings;
      settings.step_voxels = step;
      const Image8 image = draw(packet, settings, step == 1 && sigma == 0.1 ? "box" : "");
      expect_alpha(image, packet, 1, [&](const Ray& ray) { return sigma * chord_length(*grid, ray.origin, ray.direction); });
      EXPECT_GT(covered(image), 2500);
      EXPECT_LT(covered(image), 15000);
    }
  }
  // straight alpha: the colour is the table's at any sufficient alpha
  const Image8 image = draw(packet);
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x)
      if (image.pixel(x, y)[3] > 8) {
        ASSERT_NEAR(image.pixel(x, y)[0], 51, 1);
        ASSERT_NEAR(image.pixel(x, y)[1], 127.5, 1.5);
        ASSERT_NEAR(image.pixel(x, y)[2], 229.5, 1.5);
      }
}

TEST_F(Volume, CameraInsideTheBox) {
  const auto grid = make_grid({24, 24, 24}, [](const Vec3&) { return 0.5; });
  FramePacket packet = make_packet({11.3, 9.7, 12.1}, {20, 14, 9}, 90);
  packet.volumes = {volume_item(grid, {{0, 0.07}, {1, 0.07}})};
  expect_alpha(draw(packet), packet, 1, [&](const Ray& ray) { return 0.07 * chord_length(*grid, ray.origin, ray.direction); });
}

TEST_F(Volume, AnAnisotropicRotatedGridFarFromTheOrigin) {
  const double a = 0.4, b = -0.9;
  const Mat3 turn = Mat3(std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a), 0, 0, 0, 1) *
                    Mat3(1, 0, 0, 0, std::cos(b), std::sin(b), 0, -std::sin(b), std::cos(b));
  const Mat3 linear = turn * Mat3(0.5, 0, 0, 0, 1.25, 0, 0.3, 0, 3);
  const Vec3 far{-8200.5, 1e5, 77.25};
  const auto grid = make_grid(
      {30, 14, 9}, [](const Vec3&) { return 1.0; }, field::Mapping::from_linear(linear, far));
  const Vec3 centre = grid->mapping().world_from_index({14.5, 6.5, 4});
  FramePacket packet = make_packet(centre + Vec3(31, -44, 25), centre, 35);
  packet.volumes = {volume_item(grid, {{0, 0.08}, {1, 0.08}})};
  const Image8 image = draw(packet, {}, "box");
  expect_alpha(image, packet, 1, [&](const Ray& ray) { return 0.08 * chord_length(*grid, ray.origin, ray.direction); });
  EXPECT_GT(covered(image), 2000);
}

TEST_F(Volume, Orthographic) {
  const auto grid = make_grid({16, 16, 16}, [](const Vec3&) { return 0.5; });
  FramePacket packet = make_packet({40, -30, 35}, {7.5, 7.5, 7.5});
  packet.view.orthographic = true;
  packet.view.height = 30;
  packet.volumes = {volume_item(grid, {{0, 0.1}, {1, 0.1}})};
  const Image8 image = draw(packet, {}, "box");
  expect_alpha(image, packet, 1, [&](const Ray& ray) { return 0.1 * chord_length(*grid, ray.origin, ray.direction); });
  EXPECT_GT(covered(image), 3000);
}

TEST_F(Volume, AlongAnAxis) {
  const auto grid = make_grid({16, 16, 16}, [](const Vec3& p) { return p.x > 9 && p.x < 12 && p.z > 3 ? 1.0 : 0.0; });
  FramePacket packet = make_packet({7.5, -30, 7.5}, {7.5, 0, 7.5});
  packet.view.orthographic = true;
  packet.view.height = 20;
  packet.volumes = {volume_item(grid, {{0, 0.1}, {1, 0.1}})};
  expect_alpha(draw(packet), packet, 1, [&](const Ray& ray) { return 0.1 * chord_length(*grid, ray.origin, ray.direction); });
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.1}})};
  RenderSettings all;
  all.skip_empty = false;
  EXPECT_EQ(max_difference(draw(packet, {}, "bars"), draw(packet, all)), 0);
}

TEST_F(Volume, LinearSigmaIsExact) {
  const auto grid = make_grid({17, 17, 17}, [](const Vec3& p) { return (p.x + 2 * p.y + 3 * p.z) / 96; });
  FramePacket packet = make_packet({40, -30, 35}, {8, 8, 8});
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.2}})};
  RenderSettings settings;
  settings.texel_format = TexelFormat::r32f;
  for (const double step : {0.5, 2.0}) {
    settings.step_voxels = step;
    expect_alpha(draw(packet, settings), packet, 1, [&](const Ray& ray) {
      const double length = chord_length(*grid, ray.origin, ray.direction);
      if (!(length > 0)) return 0.0;
      // the mean of a linear function is its value at the midpoint
      double enter = 0, leave = 1000;
      for (int k = 0; k < 3; ++k) {
        const double s = (0 - ray.origin[k]) / ray.direction[k], t = (16 - ray.origin[k]) / ray.direction[k];
        enter = std::max(enter, std::min(s, t));
        leave = std::min(leave, std::max(s, t));
      }
      const Vec3 middle = ray.origin + 0.5 * (enter + leave) * ray.direction;
      return length * 0.2 * (middle.x + 2 * middle.y + 3 * middle.z) / 96;
    });
  }
}

/// Values from 1e-6 to 1e3: narrow features at one end are as visible as wide ones at the other.
TEST_F(Volume, NarrowFeaturesOfWideTablesAreVisible) {
  const auto grid = make_grid({12, 12, 10}, [](const Vec3& p) { return std::pow(10, std::lround(p.z) - 6); });
  FramePacket packet = make_packet({5.5, 5.5, 40}, {5.5, 5.5, 4.5});
  packet.view.up = {0, 1, 0};
  packet.view.orthographic = true;
  packet.view.height = 8;
  packet.width = packet.height = 32;
  packet.volumes = {volume_item(grid, {{0, 0}, {1e-4, 0}, {5e-4, 1}, {9e-4, 0}, {10, 0}, {50, 1}, {90, 0}, {1000, 0}})};
  RenderSettings settings;
  settings.step_voxels = 0.02;
  settings.texel_format = TexelFormat::r32f;
  // two triangles of height 1, each over eight ninths of a cell
  expect_alpha(draw(packet, settings), packet, 1, [](const Ray&) { return 8.0 / 9; });
  EXPECT_FALSE(renderer_->can_draw_fast(packet)) << "256 codes take one of them";
  packet.volumes[0].transfer.extinctions = {{0, 0}, {10, 0}, {50, 1}, {90, 0}, {1000, 0}};
  EXPECT_TRUE(renderer_->can_draw_fast(packet));
  expect_alpha(draw(packet, settings), packet, 1, [](const Ray&) { return 4.0 / 9; });
}

TEST_F(Volume, AGaussianMatchesItsIntegral) {
  const double s = 4.5;  // width 9 voxels
  const Vec3 c(31.5);
  const auto grid = make_grid({64, 64, 64}, [&](const Vec3& p) { return std::exp(-dot(p - c, p - c) / (2 * s * s)); });
  FramePacket packet = make_packet({120, -80, 90}, c, 25);
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.15}})};
  const auto depth = [&](const Ray& ray) {
    const Vec3 to = c - ray.origin;
    const double along = dot(to, ray.direction), b2 = dot(to, to) - along * along;
    return 0.15 * s * std::sqrt(2 * std::numbers::pi) * std::exp(-b2 / (2 * s * s));
  };
  expect_alpha(draw(packet, {}, "blob"), packet, 2, depth);
  RenderSettings fine;
  fine.step_voxels = 0.25;
  fine.texel_format = TexelFormat::r32f;
  expect_alpha(draw(packet, fine), packet, 2, depth);
}

TEST_F(Volume, EmptySpaceSkippingChangesNothing) {
  const Vec3 c(20, 40, 30);
  const auto grid =
      make_grid({64, 56, 48}, [&](const Vec3& p) { return std::max(0.0, 1 - norm(p - c) / 11) + (p.x > 55 && p.z < 9 ? 0.7 : 0.0); });
  FramePacket packet = make_packet({110, -90, 80}, {31, 27, 23}, 28);
  packet.volumes = {volume_item(grid, {{0, 0}, {0.1, 0}, {1, 0.3}})};
  packet.volumes[0].transfer.colors = {{0, 0.1, 0.2, 0.9}, {0.6, 0.9, 0.8, 0.1}, {1, 1, 0, 0}};
  for (const bool shade : {false, true})
    for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
      packet.volumes[0].is_shaded = shade;
      RenderSettings settings;
      settings.layout = layout;
      const Image8 with = draw(packet, settings, shade ? "shaded" : "plain");
      settings.skip_empty = false;
      const Image8 without = draw(packet, settings);
      EXPECT_LE(max_difference(with, without), 0);
      EXPECT_GT(covered(with), 500);
    }
}

TEST_F(Volume, DenseAndAtlasStorageDrawTheSameImage) {
  const auto grid =
      make_grid({37, 45, 29}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.4 * p.x) * std::cos(0.3 * p.y + 0.2 * p.z); });
  FramePacket packet = make_packet({80, -70, 60}, {18, 22, 14});
  packet.volumes = {volume_item(grid, {{0, 0}, {0.5, 0}, {1, 0.3}})};
  packet.volumes[0].is_shaded = true;
  RenderSettings settings;
  settings.layout = GridLayout::dense;
  const Image8 dense = draw(packet, settings, "dense");
  settings.layout = GridLayout::atlas;
  EXPECT_LE(max_difference(dense, draw(packet, settings, "atlas")), 1);
}

TEST_F(Volume, MaskedCellsAreTransparent) {
  // cells with a corner at x > 15 are masked: the box ends at x = 15
  const auto valid = [](const Vec3& p) { return p.x <= 15; };
  const auto grid = make_grid(
      {32, 16, 16}, [](const Vec3&) { return 0.5; }, {}, valid);
  const auto half = make_grid({16, 16, 16}, [](const Vec3&) { return 0.5; });
  FramePacket packet = make_packet({55, -40, 35}, {10, 8, 8});
  packet.volumes = {volume_item(grid, {{0, 0.2}, {1, 0.2}})};
  RenderSettings settings;
  settings.step_voxels = 0.05;
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
    settings.layout = layout;
    expect_alpha(draw(packet, settings, layout == GridLayout::dense ? "dense" : "atlas"), packet, 3,
                 [&](const Ray& ray) { return 0.2 * chord_length(*half, ray.origin, ray.direction); });
  }
}

TEST_F(Volume, NanIsTransparent) {
  const auto grid = make_grid({24, 24, 24}, [](const Vec3& p) { return p.z == 12 ? std::nan("") : p.z == 5 ? HUGE_VAL : 0.5; });
  FramePacket packet = make_packet({60, -40, 45}, {11.5, 11.5, 11.5});
  packet.volumes = {volume_item(grid, {{0, 0.2}, {1, 0.2}})};
  packet.volumes[0].is_shaded = true;
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
    RenderSettings settings;
    settings.layout = layout;
    const Image8 image = draw(packet, settings, "slabs");
    EXPECT_GT(covered(image), 2000);
  }
}

TEST_F(Volume, EarlyTerminationChangesLittle) {
  const auto grid =
      make_grid({48, 48, 48}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.5 * p.x + 0.3 * p.y) * std::cos(0.4 * p.z); });
  FramePacket packet = make_packet({120, -80, 90}, {23.5, 23.5, 23.5});
  packet.background = {0, 0, 0, 1};
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.8}})};
  packet.volumes[0].transfer.colors = {{0, 0, 0.2, 1}, {1, 1, 0.9, 0}};
  RenderSettings all;
  all.termination = 0;
  EXPECT_LE(max_difference(draw(packet, {}, "early"), draw(packet, all)), 1);
}

TEST_F(Volume, TheExtinctionsOfTwoVolumesAdd) {
  const auto a = make_grid({20, 20, 20}, [](const Vec3&) { return 0.5; });
  const auto b = make_grid(
      {20, 20, 20}, [](const Vec3&) { return 0.5; }, field::Mapping::from_linear(Mat3(1.5), {9.3, 4, -2}));
  FramePacket packet = make_packet({90, -70, 60}, {14, 12, 10});
  packet.volumes = {volume_item(a, {{0, 0.05}, {1, 0.05}}), volume_item(b, {{0, 0.03}, {1, 0.03}})};
  for (const bool skip : {true, false}) {
    RenderSettings settings;
    settings.skip_empty = skip;
    expect_alpha(draw(packet, settings, "two"), packet, 1, [&](const Ray& ray) {
      return 0.05 * chord_length(*a, ray.origin, ray.direction) + 0.03 * chord_length(*b, ray.origin, ray.direction);
    });
  }
}

TEST_F(Volume, GridsTooThinForACellAreNotDrawn) {
  FramePacket packet = make_packet({20, -20, 20}, {4, 4, 0});
  packet.volumes = {volume_item(make_grid({8, 8, 1}, [](const Vec3&) { return 1.0; }), {{0, 1}, {1, 1}})};
  EXPECT_EQ(covered(draw(packet)), 0);
}

TEST_F(Volume, TooManyVolumesAreAnError) {
  const auto grid = make_grid({8, 8, 8}, [](const Vec3&) { return 1.0; });
  FramePacket packet = make_packet({20, -20, 20}, {4, 4, 4});
  packet.volumes.assign(5, volume_item(grid, {{0, 1}, {1, 1}}));
  const auto drawn = renderer_->draw(packet);
  ASSERT_FALSE(drawn);
  EXPECT_NE(drawn.error().message.find("5 volumes"), std::string::npos);
}

}  // namespace volume_test
}  // namespace catena::test
