// SPDX-License-Identifier: MIT
/// Packed formats of the fast raycast: grids with invalid cells, and large grids as bricks. Known images, and agreement with exact rays.
#include <cmath>

#include "render/image/image_error.h"
#include "tests/render/support/ray_alpha.h"

namespace catena::test::packed_formats_test {

using namespace catena::render;

RenderSettings fast(double step, bool smooth = false) {
  RenderSettings settings{.fast = FastSettings{step, 1, 0, -1}};
  settings.fast->smooth_gradients = smooth;
  return settings;
}

double covered_rmse(const Image8& found, const Image8& expected) { return measure_error(found, expected).rmse; }

class PackedFormats : public ImageTest {};

TEST_F(PackedFormats, AHomogeneousBoxEndsAtItsInvalidCells) {
  const auto valid = [](const Vec3& p) { return p.x <= 15; };
  const auto masked = make_grid(
      {32, 16, 16}, [](const Vec3& p) { return p.x <= 15 ? 0.5 : std::nan(""); }, {}, valid);
  const auto half = even_grid({16, 16, 16});
  FramePacket packet = make_packet({55, -40, 35}, {10, 8, 8});
  packet.volumes = {volume_item(masked, {{0, 0.2}, {1, 0.2}})};
  ASSERT_TRUE(renderer_->can_draw_fast(packet));
  const Image8 found = draw(packet, fast(0.25), "half");
  packet.volumes = {volume_item(half, {{0, 0.2}, {1, 0.2}})};
  const Image8 expected = draw(packet, fast(0.25));
  // tolerance: a segment cut by the mask counts half, an eighth of a voxel
  EXPECT_LE(max_difference(found, expected), 0.125 * 0.2 * 255 + 1);
  EXPECT_LT(covered_rmse(found, expected), 2);
}

TEST_F(PackedFormats, MaskedCellsAreInvisibleAndDoNotAffectNeighbouringShading) {
  const Vec3 c(23.5, 19.5, 21.5);
  const auto valid = [&](const Vec3& p) { return p.y > 12 || length(p - c) < 10; };
  const auto grid = make_grid(
      {48, 40, 44},
      [&](const Vec3& p) {
        if (!valid(p)) return 7.0;  // invisible
        return 0.5 + 0.5 * std::sin(0.31 * p.x) * std::cos(0.27 * p.y + 0.2 * p.z);
      },
      {}, valid);
  FramePacket packet = make_packet({130, -100, 90}, {23.5, 19.5, 21.5});
  for (const bool shade : {false, true}) {
    packet.volumes = {volume_item(grid, {{0, 0}, {0.3, 0}, {1, 0.4}, {6, 0.4}, {7, 3}})};
    packet.volumes[0].transfer.colors = {{0, 0.1, 0.1, 0.9}, {0.6, 0.9, 0.8, 0.1}, {1, 1, 0, 0}, {7, 0, 1, 0}};
    packet.volumes[0].is_shaded = shade;
    const Image8 exact = draw(packet, reference_settings(), shade ? "exact-shaded" : "exact");
    ASSERT_TRUE(renderer_->can_draw_fast(packet));
    EXPECT_LT(covered_rmse(draw(packet, fast(0.5, shade), shade ? "fast-shaded" : "fast"), exact), shade ? 2.0 : 1.5);
    EXPECT_LT(covered_rmse(draw(packet, fast(1, shade)), exact), shade ? 3.0 : 2.5);
  }
}

/// A grid larger than a texture's maximum size, so that it is packed as bricks.
class Bricks : public PackedFormats {
 protected:
  static double wave(const Vec3& p) {
    return 0.5 + 0.5 * std::sin(0.31 * p.x) * std::cos(0.27 * p.y + 0.2 * p.z) * std::exp(-1e-3 * (p.x - 44) * (p.x - 44));
  }
  GridPtr long_grid() const { return make_grid({std::int32_t(renderer_->device().info().limits.maxImageDimension3D) + 60, 40, 36}, wave); }
  static FramePacket looking() { return make_packet({134, -90, 80}, {44, 19.5, 17.5}, 40); }
};

TEST_F(Bricks, MatchTheExactRaycast) {
  FramePacket packet = looking();
  for (const bool shade : {false, true}) {
    packet.volumes = {volume_item(long_grid(), {{0, 0}, {0.55, 0}, {1, 0.3}})};
    packet.volumes[0].transfer.colors = {{0, 0.1, 0.1, 0.9}, {0.6, 0.9, 0.8, 0.1}, {1, 1, 0, 0}};
    packet.volumes[0].is_shaded = shade;
    ASSERT_TRUE(renderer_->can_draw_fast(packet));
    const Image8 exact = draw(packet, reference_settings(), shade ? "exact-shaded" : "exact");
    const Image8 found = draw(packet, fast(0.5, shade), shade ? "fast-shaded" : "fast");
    EXPECT_TRUE(renderer_->stats().warnings.empty());
    EXPECT_GT(measure_error(found, exact).covered_share, 0.15);
    EXPECT_LT(covered_rmse(found, exact), shade ? 1.0 : 0.5);
  }
}

TEST_F(Bricks, AreRepackedForANewTransferFunction) {
  FramePacket packet = looking();
  const GridPtr grid = long_grid();
  const auto rendered = [&](double from) {
    packet.volumes = {volume_item(grid, {{0, 0}, {from, 0}, {1, 0.3}})};
    return draw(packet, fast(1));
  };
  const Image8 little = rendered(0.9), much = rendered(0.6), again = rendered(0.9);
  EXPECT_EQ(max_difference(little, again), 0);
  EXPECT_GT(max_difference(little, much), 20);
  packet.volumes[0].transfer.extinctions = {{0, 0}, {0.6, 0}, {1, 0.3}};
  EXPECT_LT(covered_rmse(much, draw(packet, reference_settings())), 1.0);
}

TEST_F(Bricks, BeyondTheMemoryAreDrawnByExactRaysWithANote) {
  FramePacket packet = looking();
  packet.volumes = {volume_item(long_grid(), {{0, 0}, {0.6, 0}, {1, 0.3}})};
  RenderSettings settings = fast(1);
  settings.fast->max_bytes = 1000;
  const Image8 found = draw(packet, settings);
  ASSERT_EQ(renderer_->stats().warnings.size(), 1u);
  EXPECT_NE(renderer_->stats().warnings[0].find("is drawn by exact rays"), std::string::npos) << renderer_->stats().warnings[0];
  EXPECT_EQ(max_difference(found, draw(packet)), 0);
}

TEST_F(Bricks, HaveGradientsAsFineAsTheMemoryAllows) {
  // noise: a gradient per voxel is more accurate than one per two voxels
  std::uint32_t state = 1;
  const GridPtr whole = long_grid();
  const auto noise = make_grid({std::int32_t(whole->index_box().hi.x) + 1, 40, 36}, [&](const Vec3& p) {
    state = state * 1664525u + 1013904223u;
    return 0.85 * wave(p) + 0.15 * double(state >> 8) / (1 << 24);
  });
  FramePacket packet = looking();
  packet.volumes = {volume_item(noise, {{0, 0}, {0.2, 0}, {1, 0.3}})};
  packet.volumes[0].is_shaded = true;
  const Image8 exact = draw(packet, reference_settings());
  const Image8 fine = draw(packet, fast(0.5, true), "fine");
  const std::uint64_t fine_bytes = renderer_->stats().gpu_bytes;
  EXPECT_LT(covered_rmse(fine, exact), 2.0);

  renderer_ = make_renderer(fine_bytes * 3 / 4);
  ASSERT_TRUE(renderer_);
  const Image8 coarse = draw(packet, fast(0.5, true), "coarse");
  EXPECT_TRUE(renderer_->can_draw_fast(packet)) << renderer_->stats().warnings[0];
  EXPECT_LE(renderer_->device().counters().peak_bytes, fine_bytes * 3 / 4);
  EXPECT_GT(covered_rmse(coarse, exact), covered_rmse(fine, exact));
}

}  // namespace catena::test::packed_formats_test
