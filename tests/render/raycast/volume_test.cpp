// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "tests/render/support/ray_alpha.h"

namespace catena::test::volume_test {

using namespace catena::render;

class Volume : public ImageTest {};

void expect_alpha(const Image8& image, const FramePacket& packet, double tolerance_255, const OfRay& depth) {
  EXPECT_LE(worst_alpha(image, packet, depth), tolerance_255);
}

TEST_F(Volume, AHomogeneousBoxSeenObliquelyIsExact) {
  const auto grid = even_grid({20, 33, 12});
  FramePacket packet = make_packet({52, -41, 37}, {9.5, 16, 5.5}, 40);
  for (const double sigma : {0.02, 0.1, 1.0}) {
    packet.volumes = {volume_item(grid, {{0, sigma}, {1, sigma}}, {0.2f, 0.5f, 0.9f})};
    for (const double step : {0.25, 0.5, 1.0}) {
      RenderSettings settings{.step_voxels = step, .fast = {}};
      const Image8 image = draw(packet, settings, step == 1 && sigma == 0.1 ? "box" : "");
      expect_alpha(image, packet, 1, even_depth(grid, sigma));
      EXPECT_GT(covered(image), 2500);
      EXPECT_LT(covered(image), 15000);
    }
  }
  // straight alpha: the colour is the table's at any sufficient alpha
  const Image8 image = draw(packet);
  for (const auto& [x, y] : pixels_of(image))
    if (image.pixel(x, y)[3] > 8) {
      ASSERT_NEAR(image.pixel(x, y)[0], 51, 1);
      ASSERT_NEAR(image.pixel(x, y)[1], 127.5, 1.5);
      ASSERT_NEAR(image.pixel(x, y)[2], 229.5, 1.5);
    }
}

TEST_F(Volume, CameraInsideTheBox) {
  const auto grid = even_grid({24, 24, 24});
  FramePacket packet = make_packet({11.3, 9.7, 12.1}, {20, 14, 9}, 90);
  packet.volumes = {volume_item(grid, {{0, 0.07}, {1, 0.07}})};
  expect_alpha(draw(packet), packet, 1, even_depth(grid, 0.07));
}

TEST_F(Volume, AnAnisotropicRotatedGridFarFromTheOrigin) {
  const Mat3 linear = turned(0.4, -0.9) * Mat3(0.5, 0, 0, 0, 1.25, 0, 0.3, 0, 3);
  const Vec3 far{-8200.5, 1e5, 77.25};
  const auto grid = make_grid(
      {30, 14, 9}, [](const Vec3&) { return 1.0; }, field::Mapping::from_linear(linear, far));
  const Vec3 centre = grid->mapping().world_from_index({14.5, 6.5, 4});
  FramePacket packet = make_packet(centre + Vec3(31, -44, 25), centre, 35);
  packet.volumes = {volume_item(grid, {{0, 0.08}, {1, 0.08}})};
  const Image8 image = draw(packet, {}, "box");
  expect_alpha(image, packet, 1, even_depth(grid, 0.08));
  EXPECT_GT(covered(image), 2000);
}

TEST_F(Volume, Orthographic) {
  const auto grid = even_grid({16, 16, 16});
  FramePacket packet = make_packet({40, -30, 35}, {7.5, 7.5, 7.5});
  set_orthographic(packet, 30);
  packet.volumes = {volume_item(grid, {{0, 0.1}, {1, 0.1}})};
  const Image8 image = draw(packet, {}, "box");
  expect_alpha(image, packet, 1, even_depth(grid, 0.1));
  EXPECT_GT(covered(image), 3000);
}

TEST_F(Volume, AlongAnAxis) {
  const auto grid = make_grid({16, 16, 16}, [](const Vec3& p) { return p.x > 9 && p.x < 12 && p.z > 3 ? 1.0 : 0.0; });
  FramePacket packet = make_packet({7.5, -30, 7.5}, {7.5, 0, 7.5});
  set_orthographic(packet, 20);
  packet.volumes = {volume_item(grid, {{0, 0.1}, {1, 0.1}})};
  expect_alpha(draw(packet), packet, 1, even_depth(grid, 0.1));
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.1}})};
  RenderSettings all{.skip_empty = false, .fast = {}};
  EXPECT_EQ(max_difference(draw(packet, {}, "bars"), draw(packet, all)), 0);
}

TEST_F(Volume, LinearSigmaIsExact) {
  const auto grid = make_grid({17, 17, 17}, [](const Vec3& p) { return (p.x + 2 * p.y + 3 * p.z) / 96; });
  FramePacket packet = make_packet({40, -30, 35}, {8, 8, 8});
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.2}})};
  RenderSettings settings{.texel_format = TexelFormat::r32f, .fast = {}};
  for (const double step : {0.5, 2.0}) {
    settings.step_voxels = step;
    expect_alpha(draw(packet, settings), packet, 1, linear_depth(grid));
  }
}

/// Values from 1e-6 to 1e3: narrow features at one end are as visible as wide ones at the other.
TEST_F(Volume, NarrowFeaturesOfWideTablesAreVisible) {
  const auto grid = make_grid({12, 12, 10}, [](const Vec3& p) { return std::pow(10, std::lround(p.z) - 6); });
  FramePacket packet = make_packet({5.5, 5.5, 40}, {5.5, 5.5, 4.5});
  packet.view.up = {0, 1, 0};
  set_orthographic(packet, 8);
  set_size(packet, 32, 32);
  packet.volumes = {volume_item(grid, {{0, 0}, {1e-4, 0}, {5e-4, 1}, {9e-4, 0}, {10, 0}, {50, 1}, {90, 0}, {1000, 0}})};
  RenderSettings settings{.step_voxels = 0.02, .texel_format = TexelFormat::r32f, .fast = {}};
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
  RenderSettings fine{.step_voxels = 0.25, .texel_format = TexelFormat::r32f, .fast = {}};
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
      RenderSettings settings{.layout = layout, .fast = {}};
      const Image8 with = draw(packet, settings, shade ? "shaded" : "plain");
      settings.skip_empty = false;
      EXPECT_LE(max_difference(with, draw(packet, settings)), 0);
      EXPECT_GT(covered(with), 500);
    }
}

TEST_F(Volume, DenseAndAtlasStorageDrawTheSameImage) {
  const auto grid =
      make_grid({37, 45, 29}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.4 * p.x) * std::cos(0.3 * p.y + 0.2 * p.z); });
  FramePacket packet = make_packet({80, -70, 60}, {18, 22, 14});
  packet.volumes = {volume_item(grid, {{0, 0}, {0.5, 0}, {1, 0.3}})};
  packet.volumes[0].is_shaded = true;
  RenderSettings settings{.layout = GridLayout::dense, .fast = {}};
  const Image8 dense = draw(packet, settings, "dense");
  settings.layout = GridLayout::atlas;
  EXPECT_LE(max_difference(dense, draw(packet, settings, "atlas")), 1);
}

TEST_F(Volume, MaskedCellsAreTransparent) {
  // cells with a corner at x > 15 are masked: the box ends at x = 15
  const auto grid = make_grid(
      {32, 16, 16}, [](const Vec3&) { return 0.5; }, {}, [](const Vec3& p) { return p.x <= 15; });
  const auto half = even_grid({16, 16, 16});
  FramePacket packet = make_packet({55, -40, 35}, {10, 8, 8});
  packet.volumes = {volume_item(grid, {{0, 0.2}, {1, 0.2}})};
  RenderSettings settings{.step_voxels = 0.05, .fast = {}};
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
    settings.layout = layout;
    expect_alpha(draw(packet, settings, layout == GridLayout::dense ? "dense" : "atlas"), packet, 3, even_depth(half, 0.2));
  }
}

TEST_F(Volume, NanIsTransparent) {
  const auto grid = make_grid({24, 24, 24}, [](const Vec3& p) { return p.z == 12 ? std::nan("") : p.z == 5 ? HUGE_VAL : 0.5; });
  FramePacket packet = make_packet({60, -40, 45}, {11.5, 11.5, 11.5});
  packet.volumes = {volume_item(grid, {{0, 0.2}, {1, 0.2}})};
  packet.volumes[0].is_shaded = true;
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
    RenderSettings settings{.layout = layout, .fast = {}};
    EXPECT_GT(covered(draw(packet, settings, "slabs")), 2000);
  }
}

TEST_F(Volume, EarlyTerminationChangesLittle) {
  const auto grid =
      make_grid({48, 48, 48}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.5 * p.x + 0.3 * p.y) * std::cos(0.4 * p.z); });
  FramePacket packet = make_packet({120, -80, 90}, {23.5, 23.5, 23.5});
  packet.background = {0, 0, 0, 1};
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.8}})};
  packet.volumes[0].transfer.colors = {{0, 0, 0.2, 1}, {1, 1, 0.9, 0}};
  RenderSettings all{.termination = 0, .fast = {}};
  EXPECT_LE(max_difference(draw(packet, {}, "early"), draw(packet, all)), 1);
}

TEST_F(Volume, TheExtinctionsOfTwoVolumesAdd) {
  const auto a = even_grid({20, 20, 20});
  const auto b = even_grid({20, 20, 20}, field::Mapping::from_linear(Mat3(1.5), {9.3, 4, -2}));
  FramePacket packet = make_packet({90, -70, 60}, {14, 12, 10});
  packet.volumes = {volume_item(a, {{0, 0.05}, {1, 0.05}}), volume_item(b, {{0, 0.03}, {1, 0.03}})};
  for (const bool skip : {true, false}) {
    RenderSettings settings{.skip_empty = skip, .fast = {}};
    expect_alpha(draw(packet, settings, "two"), packet, 1,
                 [&](const Ray& ray) { return even_depth(a, 0.05)(ray) + even_depth(b, 0.03)(ray); });
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
  expect_refused(packet, "5 volumes");
}

}  // namespace catena::test::volume_test
