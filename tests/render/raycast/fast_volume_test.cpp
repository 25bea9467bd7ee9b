// SPDX-License-Identifier: MIT
/// The fast raycast: known images within 2/255 at every spacing, agreement with the exact raycast, opaque objects inside the volume.
#include <cmath>
#include <numbers>

#include "render/image/image_error.h"
#include "tests/render/support/ray_alpha.h"

namespace catena::test::fast_volume_test {

using namespace catena::render;

class FastVolume : public ImageTest {
 protected:
  static RenderSettings fast(double step, std::uint32_t spacing, double refine_half = 0.2, double refine_full = 0.2) {
    RenderSettings settings{.fast = FastSettings{step, spacing, refine_half, refine_full}};
    return settings;
  }
};

double rmse(const Image8& a, const Image8& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += (double(a.rgba[i]) - b.rgba[i]) * (double(a.rgba[i]) - b.rgba[i]);
  return std::sqrt(sum / double(a.rgba.size()));
}

GridPtr waves() {
  return make_grid({48, 40, 44}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.31 * p.x) * std::cos(0.27 * p.y + 0.2 * p.z); });
}

VolumeItem coloured(GridPtr grid, bool shade = false) {
  VolumeItem item = volume_item(std::move(grid), {{0, 0}, {0.3, 0}, {1, 0.2}});
  item.transfer.colors = {{0, 0.1, 0.1, 0.9}, {0.6, 0.9, 0.8, 0.1}, {1, 1, 0, 0}};
  item.is_shaded = shade;
  return item;
}

TEST_F(FastVolume, AHomogeneousBoxIsExactForAnyStep) {
  const auto grid = even_grid({20, 33, 12});
  FramePacket packet = make_packet({52, -41, 37}, {9.5, 16, 5.5}, 40);
  for (const double sigma : {0.02, 0.1, 1.0}) {
    packet.volumes = {volume_item(grid, {{0, sigma}, {1, sigma}}, {0.2f, 0.5f, 0.9f})};
    for (const double step : {0.5, 4.0}) {
      const Image8 rendered = draw(packet, fast(step, 1), step == 4 && sigma == 0.1 ? "box" : "");
      EXPECT_LE(worst_alpha(rendered, packet, even_depth(grid, sigma)), 1);
      EXPECT_GT(covered(rendered), 2500);
      for (const auto& [x, y] : pixels_of(rendered))
        if (rendered.pixel(x, y)[3] > 8) {
          ASSERT_NEAR(rendered.pixel(x, y)[0], 51, 1);
          ASSERT_NEAR(rendered.pixel(x, y)[2], 229.5, 1.5);
        }
    }
  }
}

/// A ray that ends early extrapolates the rest: a homogeneous body has the full alpha, without an edge where early termination starts.
TEST_F(FastVolume, AnEndedRayExtrapolatesTheRest) {
  const auto grid = even_grid({20, 33, 12});
  FramePacket packet = make_packet({52, -41, 37}, {9.5, 16, 5.5}, 40);
  for (const bool shade : {false, true})
    for (const double sigma : {0.2, 0.4, 1.0}) {
      packet.volumes = {volume_item(grid, {{0, sigma}, {1, sigma}}, {0.2f, 0.5f, 0.9f})};
      packet.volumes[0].is_shaded = shade;
      RenderSettings settings = fast(0.5, 1);
      settings.fast->termination = 1.0 / 16;
      const Image8 rendered = draw(packet, settings);
      EXPECT_LE(worst_alpha(rendered, packet, even_depth(grid, sigma)), 1) << sigma;
      EXPECT_LE(max_difference(draw(packet, fast(0.5, 1)), rendered), 2) << sigma;
    }
  // in an inhomogeneous volume the error is below a part of the remaining transmittance
  packet = make_packet({120, -90, 80}, {23.5, 19.5, 21.5}, 30);
  packet.volumes = {coloured(waves())};
  packet.volumes[0].transfer.extinctions = {{0, 0}, {0.3, 0}, {1, 0.6}};
  RenderSettings settings = fast(1, 1);
  const Image8 whole = draw(packet, settings);
  settings.fast->termination = 1.0 / 32;
  EXPECT_LT(measure_error(draw(packet, settings), whole).rmse, 255.0 / 32 / 4);
}

TEST_F(FastVolume, ABoxByCoarseRaysIsRefinedAtItsEdges) {
  const auto grid = even_grid({40, 33, 32});
  FramePacket packet = make_packet({92, -71, 67}, {19.5, 16, 15.5}, 35);
  packet.volumes = {volume_item(grid, {{0, 0.05}, {1, 0.05}})};
  const auto depth = even_depth(grid, 0.05);
  for (const std::uint32_t spacing : {2u, 4u}) {
    const Image8 rendered = draw(packet, fast(4, spacing, 0, 0), "box");
    EXPECT_LE(worst_alpha(rendered, packet, depth), 1);  // threshold 0: every block that is not uniform is marched
    const Image8 rough = draw(packet, fast(4, spacing, -1, -1), "unrefined");
    EXPECT_GT(worst_alpha(rough, packet, depth), 4);  // without refinement the error is larger
  }
}

TEST_F(FastVolume, LinearSigmaIsExact) {
  const auto grid = make_grid({17, 17, 17}, [](const Vec3& p) { return (p.x + 2 * p.y + 3 * p.z) / 96; });
  FramePacket packet = make_packet({40, -30, 35}, {8, 8, 8});
  packet.volumes = {volume_item(grid, {{0, 0}, {1, 0.2}})};
  for (const double step : {0.5, 2.0, 7.0}) EXPECT_LE(worst_alpha(draw(packet, fast(step, 1)), packet, linear_depth(grid)), 2) << step;
}

TEST_F(FastVolume, AGaussianMatchesItsIntegralAtEverySpacing) {
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
  for (const std::uint32_t spacing : {1u, 2u, 4u})
    EXPECT_LE(worst_alpha(draw(packet, fast(3, spacing), spacing == 4 ? "blob" : ""), packet, depth), 2) << spacing;
  EXPECT_LE(worst_alpha(draw(packet, fast(3, 4, -1, -1), "unrefined"), packet, depth), 3);
}

TEST_F(FastVolume, CameraInsideTheVolume) {
  const auto grid = even_grid({24, 24, 24});
  FramePacket packet = make_packet({11.3, 9.7, 12.1}, {20, 14, 9}, 90);
  packet.volumes = {volume_item(grid, {{0, 0.07}, {1, 0.07}})};
  const auto depth = even_depth(grid, 0.07);
  EXPECT_LE(worst_alpha(draw(packet, fast(2, 1)), packet, depth), 1);
  EXPECT_LE(worst_alpha(draw(packet, fast(2, 4), "box"), packet, depth), 2);
}

TEST_F(FastVolume, OrthographicOfARotatedAnisotropicGrid) {
  const Mat3 linear = turned(0.4, 0) * Mat3(0.5, 0, 0, 0, 1.25, 0, 0.3, 0, 3);
  const auto grid = make_grid(
      {30, 14, 9}, [](const Vec3&) { return 1.0; }, field::Mapping::from_linear(linear, {-820.5, 100, 77.25}));
  const Vec3 centre = grid->mapping().world_from_index({14.5, 6.5, 4});
  FramePacket packet = make_packet(centre + Vec3(31, -44, 25), centre, 35);
  set_orthographic(packet, 45);
  packet.volumes = {volume_item(grid, {{0, 0.08}, {1, 0.08}})};
  const Image8 rendered = draw(packet, fast(1, 1), "box");
  EXPECT_LE(worst_alpha(rendered, packet, even_depth(grid, 0.08)), 1);
  EXPECT_GT(covered(rendered), 2000);
}

TEST_F(FastVolume, MatchesTheExactRaycast) {
  FramePacket packet = make_packet({130, -100, 90}, {23.5, 19.5, 21.5});
  packet.background = {0.2f, 0.3f, 0.1f, 1};
  for (const bool shade : {false, true}) {
    packet.volumes = {coloured(waves(), shade)};
    const Image8 exact = draw(packet, reference_settings(), shade ? "shaded" : "plain");
    for (const std::uint32_t spacing : {1u, 2u, 4u}) {
      EXPECT_LT(rmse(draw(packet, fast(2, spacing), shade ? "shaded-fast" : "plain-fast"), exact), shade ? 1.3 : 0.6)
          << spacing << shade;  // shaded by the cell's gradient
      EXPECT_LT(rmse(draw(packet, fast(2, spacing, 0.3, -1)), exact), 1.5) << spacing << shade;
    }
  }
}

/// A headlight, and lights of the scene, of which one follows the camera.
const std::vector<LightItem> kLights[] = {{}, {{{1, 0.2, 0.7}, {0.9f, 0.8f, 0.7f}, false}, {{-1, 0.3, 0.2}, {0.1f, 0.3f, 0.6f}, true}}};

TEST_F(FastVolume, SmoothGradientsMatchTheExactShading) {
  FramePacket packet = make_packet({130, -100, 90}, {23.5, 19.5, 21.5});
  packet.background = {0, 0, 0, 1};
  RenderSettings settings = fast(1, 1);
  for (const auto& lights : kLights) {
    packet.lights = lights;
    packet.volumes = {coloured(waves(), true)};
    const Image8 exact = draw(packet, reference_settings());
    settings.fast->smooth_gradients = false;
    const double by_cell = rmse(draw(packet, settings), exact);
    settings.fast->smooth_gradients = true;
    const double smooth = rmse(draw(packet, settings, lights.empty() ? "smooth" : "smooth-lights"), exact);
    EXPECT_LT(smooth, 0.5);
    EXPECT_LT(smooth, 0.7 * by_cell);
  }
  // in homogeneous regions only the ambient light remains
  packet.volumes = {volume_item(even_grid({16, 16, 16}), {{0, 0.5}, {1, 0.5}})};
  packet.volumes[0].is_shaded = true;
  EXPECT_LE(max_difference(draw(packet, settings), draw(packet)), 1);
}

/// An opaque body with noise of one voxel, as in an MR scan, and in the other half faint noise about opaque thin tubes: the shading of
/// short steps converges to the exact raycast's.
TEST_F(FastVolume, ShadingOfOpaqueVolumesConvergesToTheExactRaycast) {
  const auto grain = [](const Vec3& p) {
    return std::fmod(std::fabs(std::sin(12.9898 * p.x + 78.233 * p.y + 37.719 * p.z) * 43758.5453), 1.0);
  };
  const auto head =
      make_grid({48, 48, 48}, [&](const Vec3& p) { return 1 / (1 + std::exp(norm(p - Vec3(23.5)) - 18)) + 0.15 * (grain(p) - 0.5); });
  const auto tubes = make_grid({48, 48, 48}, [&](const Vec3& p) {
    const double a = std::hypot(p.x - 15, p.y - 20), b = std::hypot(p.y - 30, p.z - 22);
    return std::exp(-a * a / 3) + std::exp(-b * b / 3) + 0.04 * grain(p);
  });
  for (const auto& [grid, lights] : {std::pair{head, kLights[0]}, {tubes, kLights[0]}, {head, kLights[1]}, {tubes, kLights[1]}}) {
    FramePacket packet = make_packet({110, -80, 70}, {23.5, 23.5, 23.5}, 28);
    packet.lights = lights;
    VolumeItem item = volume_item(grid, {{0, 0}, {0.35, 0}, {0.6, 0.8}});
    item.transfer.colors = {{0, 0.5, 0.3, 0.2}, {1, 1, 0.9, 0.8}};
    item.is_shaded = true;
    packet.volumes = {item};
    const Image8 truth = draw(packet, reference_settings());
    const auto error_at = [&](double step) {
      RenderSettings settings = fast(step, 1);
      settings.fast->smooth_gradients = true;
      return measure_error(draw(packet, settings), truth).rmse;
    };
    // long steps are refined at the first visible surface
    const double most = lights.empty() ? 0.4 : 0.8;  // gradients of faint noise have coarse directions
    EXPECT_LT(error_at(0.25), most);
    EXPECT_LT(error_at(1), 1.25 * most);
    EXPECT_LT(error_at(0.5), 0.75 * error_at(4));
  }
}

/// Steps of six times a wall's thickness do not skip the wall.
TEST_F(FastVolume, LongStepsFindThinWalls) {
  const auto shell = make_grid({48, 48, 48}, [](const Vec3& p) {
    const double off = norm(p - Vec3(23.5)) - 16;
    return std::exp(-off * off);
  });
  FramePacket packet = make_packet({110, -80, 70}, {23.5, 23.5, 23.5}, 28);
  packet.volumes = {volume_item(shell, {{0, 0}, {0.4, 0}, {0.6, 6}})};
  for (const bool shade : {false, true}) {
    packet.volumes[0].is_shaded = shade;
    const Image8 truth = draw(packet, reference_settings());
    RenderSettings settings = fast(6, 1);
    settings.fast->smooth_gradients = shade;
    EXPECT_LT(measure_error(draw(packet, settings), truth).rmse, 6) << shade;  // above 80 without the wall
  }
}

TEST_F(FastVolume, EmptySpaceSkippingChangesLittle) {
  const Vec3 c(20, 40, 30);
  const auto grid =
      make_grid({64, 56, 48}, [&](const Vec3& p) { return std::max(0.0, 1 - norm(p - c) / 11) + (p.x > 55 && p.z < 9 ? 0.7 : 0.0); });
  FramePacket packet = make_packet({110, -90, 80}, {31, 27, 23}, 28);
  packet.background = {0, 0, 0, 1};
  packet.volumes = {coloured(grid)};
  RenderSettings settings = fast(1, 1);
  const Image8 with = draw(packet, settings, "leaping");
  settings.fast->skip_empty = false;
  EXPECT_LT(rmse(with, draw(packet, settings)), 0.5);
  EXPECT_LT(rmse(with, draw(packet, reference_settings())), 0.6);
  EXPECT_GT(covered(with), 500);
}

TEST_F(FastVolume, RaysEndAtTheOpaqueDepth) {
  // a plane of value 20 inside a haze hides everything behind it, also in interpolated pixels
  const auto haze = even_grid({40, 40, 40});
  const auto plane = make_grid({40, 40, 40}, [](const Vec3& p) { return p.x > 12 && p.x < 27 ? p.y : 0.0; });
  FramePacket packet = make_packet({19.5, -70, 19.5}, {19.5, 19.5, 19.5});
  set_orthographic(packet, 50);
  packet.background = {0, 0, 0, 1};
  packet.volumes = {volume_item(haze, {{0, 0.04}, {1, 0.04}})};
  packet.isosurfaces = {{plane, 19.5, {0, 0, 0}, 1}};
  const Image8 exact = draw(packet, {}, "exact");
  for (const std::uint32_t spacing : {1u, 2u, 4u}) {
    EXPECT_LE(max_difference(draw(packet, fast(4, spacing, 0.2, 0.2), "fast"), exact), 2) << spacing;
    // also without refinement, around the plane; the box's outline is excluded
    const Image8 coarse = draw(packet, fast(4, spacing, -1, -1), "unrefined");
    for (std::uint32_t y = 22; y < 98; ++y)
      for (std::uint32_t x = 50; x < 110; ++x)
        ASSERT_NEAR(coarse.pixel(x, y)[0], exact.pixel(x, y)[0], 2) << spacing << " " << x << " " << y;
  }
}

TEST_F(FastVolume, UnsupportedVolumesAreDrawnByExactRays) {
  FramePacket packet = make_packet({55, -40, 35}, {10, 8, 8});
  const auto plain = even_grid({16, 16, 16});
  packet.volumes = {volume_item(plain, {{0, 0.2}, {1, 0.2}}), volume_item(plain, {{0, 0.1}, {1, 0.1}})};
  EXPECT_EQ(max_difference(draw(packet, fast(4, 4)), draw(packet)), 0);
}

TEST_F(FastVolume, PlateausBesideEdgesMatchTheExactShading) {
  // slopes of a thousandth of the edge's, of which shading uses only the direction
  const auto grid = make_grid({48, 48, 48}, [](const Vec3& p) {
    const double edge = std::sqrt((p.x - 24) * (p.x - 24) + (p.y - 24) * (p.y - 24) + (p.z - 24) * (p.z - 24)) - 17;
    return 0.8 / (1 + std::exp(4 * edge)) + 0.002 * std::sin(0.3 * p.x) * std::sin(0.35 * p.y + 0.2) * std::sin(0.25 * p.z + 1);
  });
  FramePacket packet = make_packet({110, -80, 70}, {23.5, 23.5, 23.5});
  packet.background = {0, 0, 0, 1};
  packet.volumes = {volume_item(grid, {{0, 0}, {0.75, 0}, {0.79, 0.1}, {1, 0.1}}, {0.9f, 0.7f, 0.4f})};
  packet.volumes[0].is_shaded = true;
  const Image8 exact = draw(packet, reference_settings(), "plateau");
  RenderSettings settings = fast(0.5, 1);
  settings.fast->smooth_gradients = true;
  EXPECT_LT(rmse(draw(packet, settings, "plateau-fast"), exact), 1);
}

TEST_F(FastVolume, VolumesBeyondTheMemoryAreDrawnByExactRaysWithANote) {
  FramePacket packet = make_packet({130, -100, 90}, {23.5, 19.5, 21.5});
  packet.volumes = {coloured(waves(), true)};
  const Image8 exact = draw(packet);
  RenderSettings settings = fast(4, 4);
  EXPECT_GT(max_difference(draw(packet, settings), exact), 0);
  EXPECT_TRUE(renderer_->stats().warnings.empty());
  settings.fast->max_bytes = 4 * 48 * 40 * 44 - 1;
  EXPECT_EQ(max_difference(draw(packet, settings), exact), 0);
  ASSERT_EQ(renderer_->stats().warnings.size(), 1u);
  EXPECT_NE(renderer_->stats().warnings[0].find("\"density\" is drawn by exact rays"), std::string::npos) << renderer_->stats().warnings[0];
  EXPECT_FALSE(renderer_->can_draw_fast(packet));
  // the volume fits without its gradients only
  settings.fast->max_bytes += 1;
  EXPECT_GT(max_difference(draw(packet, settings), exact), 0);
  EXPECT_TRUE(renderer_->stats().warnings.empty());
  EXPECT_TRUE(renderer_->can_draw_fast(packet));
  settings.fast->smooth_gradients = true;
  EXPECT_EQ(max_difference(draw(packet, settings), exact), 0);
  EXPECT_EQ(renderer_->stats().warnings.size(), 1u);
  draw(packet);  // exact rays were requested, so that there is no note
  EXPECT_TRUE(renderer_->stats().warnings.empty());
}

TEST_F(FastVolume, ShadedHomogeneousRegionsAreNotSkipped) {
  // constant colour and density, so that only the shading varies
  const auto grid =
      make_grid({40, 40, 40}, [](const Vec3& p) { return 0.5 + 0.3 * std::sin(0.5 * p.x) * std::sin(0.4 * p.y + 0.3 * p.z); });
  FramePacket packet = make_packet({100, -70, 60}, {19.5, 19.5, 19.5});
  packet.background = {0, 0, 0, 1};
  packet.volumes = {volume_item(grid, {{0, 0.05}, {1, 0.05}}, {0.9f, 0.7f, 0.4f})};
  packet.volumes[0].is_shaded = true;
  const Image8 exact = draw(packet, reference_settings(), "exact");
  EXPECT_LT(rmse(draw(packet, fast(1, 1), "fast"), exact), 1);
  EXPECT_LT(rmse(draw(packet, fast(2, 1)), exact), 1.2);
}

TEST_F(FastVolume, ShadingUsesTheDerivativeAlongTheRay) {
  // five codes per voxel along x: the shading of a ray is constant, the cosine of ray and x
  const auto grid = make_grid({52, 41, 41}, [](const Vec3& p) { return p.x / 51; });
  FramePacket packet = make_packet({95, -60, 40}, {25, 20, 20}, 35);
  packet.background = {0, 0, 0, 1};
  packet.volumes = {volume_item(grid, {{0, 0.5}, {1, 0.5}})};  // opaque
  packet.volumes[0].is_shaded = true;
  const Camera camera = make_camera(packet.view, packet.width, packet.height, {});
  for (const bool smooth : {false, true}) {
    RenderSettings settings = fast(3, 1);
    settings.fast->smooth_gradients = smooth;
    const Image8 rendered = draw(packet, settings, smooth ? "smooth" : "cell");
    for (std::uint32_t y = 40; y < 80; ++y)
      for (std::uint32_t x = 60; x < 100; ++x) {
        const double n = std::fabs(pixel_ray(camera, x + 0.5, y + 0.5).direction.x);
        const double light = 0.2 + 0.7 * n + 0.2 * std::pow(std::max(0.0, 2 * n * n - 1), 20);
        ASSERT_NEAR(rendered.pixel(x, y)[1], 255 * std::min(1.0, light), 2) << x << " " << y << smooth;
      }
  }
}

TEST_F(FastVolume, TransferFunctionsAndGridsMayChange) {
  FramePacket packet = make_packet({130, -100, 90}, {23.5, 19.5, 21.5});
  packet.background = {0, 0, 0, 1};
  packet.volumes = {coloured(waves())};
  const Image8 first = draw(packet, fast(2, 2));
  packet.volumes[0].transfer.extinctions = {{0, 0}, {0.7, 0}, {0.8, 0.5}, {0.9, 0}};
  EXPECT_GT(rmse(draw(packet, fast(2, 2), "shell"), first), 3);
  EXPECT_LT(rmse(draw(packet, fast(1, 2)), draw(packet, reference_settings())), 2);
  packet.volumes = {coloured(waves())};
  EXPECT_EQ(max_difference(draw(packet, fast(2, 2)), first), 0);
}

}  // namespace catena::test::fast_volume_test
