// SPDX-License-Identifier: MIT
/// Data submitted to the runtime besides images: depth, visibility mask, panel layer.
#include "render/vk/commands.h"
#include "tests/render/support/image_fixture.h"
#include "tests/render/xr/xr_fixture.h"

namespace catena::test::layers_test {

using namespace xr_rig;

class HeadsetLayers : public HeadsetFixture {
 protected:
  void SetUp() override {
    HeadsetFixture::SetUp();
    if (runtime_.found()) runtime_.script().capture_images = true;
  }
};

/// Depth of a submitted image in metres along the eye's axis; infinite for the background.
double metres_at(const xr_runtime::CapturedImage& image, int i, int j) {
  const double n = image.near_z, f = image.far_z, d = image.depth[std::size_t(j) * image.width + std::size_t(i)];
  return d >= 1 ? HUGE_VAL : n * f / (f - d * (f - n));
}

/// The submitted depth at the eye's centre is the nearest point of a ball, in metres.
TEST_F(HeadsetLayers, DepthsAreInMetresForAnyWorldUnit) {
  XrView& view = runtime_.script().views[0];
  view.pose = {{0, 0, 0, 1}, {0, 0, 0}};
  view.fov = {-0.5f, 0.5f, 0.5f, -0.5f};
  set_image_size(65, 65);
  ASSERT_TRUE(open());
  Placement placement;
  placement.meters_per_unit = 0.01;
  for (const double metres : {0.3, 1.0, 8.0}) {
    FramePacket packet = ball_packet({0.0, 0.0, -100.0 * metres}, 100 * 0.2 * metres);
    ASSERT_TRUE(run_frames(packet, placement, 3));
    ASSERT_GT(runtime_.record().depths, 0u);
    const xr_runtime::CapturedImage& image = runtime_.record().last_images[0];
    ASSERT_EQ(image.depth.size(), 65u * 65u);
    EXPECT_EQ(image.min_depth, 0.0f);
    EXPECT_EQ(image.max_depth, 1.0f);
    EXPECT_NEAR(metres_at(image, 32, 32) / (0.8 * metres), 1, 2e-3);
    EXPECT_EQ(image.depth[0], 1.0f);  // background
  }
}

/// A volume's depth is where alpha exceeds 0.5, by exact and by fast rays: from outside and inside, in front of and behind opaque objects;
/// if alpha stays below, the depth is that of the objects behind it.
TEST_F(HeadsetLayers, AVolumesDepthIsAtHalfAlpha) {
  constexpr int kSize = 64;
  constexpr double kScale = 0.05, kExtent = 16;  // metres per unit; size of the box in units
  for (XrView& view : runtime_.script().views) {
    view.pose = {{0, 0, 0, 1}, {0, 0, 0}};
    view.fov = {-0.4f, 0.4f, 0.4f, -0.4f};
  }
  set_image_size(kSize, kSize);
  ASSERT_TRUE(open());
  const auto even = make_grid({17, 17, 17}, [](const Vec3&) { return 1.0; });
  const auto ramp = make_grid({17, 17, 17}, [](const Vec3& at) { return at.z; });
  struct Case {
    const char* name;
    const GridPtr& grid;
    double sigma;    ///< extinction per unit and value; at the nearest face of the ramp 16 times that
    double front_m;  ///< distance of the box from the eye; < 0: the eye is inside
    double ball_m;   ///< distance of the nearest point of a ball on the axis; 0: no ball
    bool seen;       ///< true: alpha exceeds 0.5
  };
  const Case cases[] = {{"outside", even, 0.5, 0.6, 0, true},
                        {"within", even, 0.5, -0.3, 0, true},
                        {"thin", even, 0.01, 0.6, 0, false},
                        {"thin before a ball", even, 0.01, 0.6, 0.9, false},
                        {"thick before a ball", even, 0.5, 0.6, 0.9, true},
                        {"a ball before it", even, 0.5, 0.6, 0.4, true},
                        {"a ramp", ramp, 0.02, 0.6, 0, true}};
  for (const Case& due : cases)
    for (const bool fast : {false, true}) {
      SCOPED_TRACE(std::string(due.name) + (fast ? ", fast" : ", exact"));
      Placement placement;
      placement.meters_per_unit = kScale;
      placement.world_origin = {kExtent / 2, kExtent / 2, kExtent + due.front_m / kScale};
      FramePacket packet;
      if (due.ball_m > 0) packet = ball_packet(placement.to_world({0.0, 0.0, -due.ball_m - 0.02}), 0.02 / kScale);
      packet.volumes.push_back(volume_item(due.grid, {{0, 0}, {16, 16 * due.sigma}}));
      RenderSettings settings;
      if (fast) settings.fast = FastSettings{.step_voxels = 1};
      for (int k = 0; k < 3; ++k) show(begin_frame(), packet, settings, placement);
      const xr_runtime::CapturedImage& image = runtime_.record().last_images[0];
      ASSERT_EQ(image.depth.size(), std::size_t(kSize) * kSize);
      for (const int place : {24, 32, 40}) {  // pixels whose rays are marched
        const double tangent = (place + 0.5 - kSize / 2) / (kSize / 2) * std::tan(0.4), slant = std::hypot(1, tangent);
        // along the ray sigma l = ln 2; for the ramp sigma (16 l - l^2 / 2), with l along the axis, where a unit has length `slant`
        double l = std::log(2.0) / due.sigma / slant;
        if (due.grid == ramp) l = 16 - std::sqrt(256 - 2 * l);
        const double volume_m = std::max(0.0, due.front_m) + kScale * l;
        const bool ball = due.ball_m > 0 && place == 32;
        const double metres = metres_at(image, place, 32);
        if (ball && due.seen) {
          EXPECT_NEAR(metres, std::min(volume_m, due.ball_m), 0.01 * kScale * 16);
        } else if (ball) {
          EXPECT_NEAR(metres, due.ball_m, 0.01 * due.ball_m);
        } else if (due.seen) {
          EXPECT_NEAR(metres, volume_m, 0.01 * kScale * 16) << place;
        } else if (place != 32 && due.ball_m == 0) {
          EXPECT_EQ(metres, HUGE_VAL) << place;
        }
      }
    }
}

/// A projection's depth is unknown, and the depth of opaque objects behind it would be too large.
TEST_F(HeadsetLayers, AProjectionHasNoDepth) {
  ASSERT_TRUE(open());
  FramePacket packet = ball_packet({8.0, 8.0, 4.0}, 3);
  packet.volumes.push_back(volume_item(make_grid({17, 17, 17}, [](const Vec3& at) { return at.z; }), {{0, 0}, {16, 1}}));
  packet.volumes.back().projection = Projection::maximum;
  Placement placement;
  placement.meters_per_unit = 0.05;
  placement.world_origin = {8.0, 8.0, 30.0};
  ASSERT_TRUE(shows(packet, placement, 3));
  EXPECT_GT(runtime_.record().projection_frames, 0u);
  EXPECT_EQ(runtime_.record().depths, 0u);
}

TEST_F(HeadsetLayers, WithoutTheExtensionOrItsFormatThereAreNoDepths) {
  for (const bool by_format : {false, true}) {
    runtime_.reset();
    if (by_format) runtime_.script().formats.pop_back();
    if (!by_format) runtime_.script().unsupported.insert(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
    ASSERT_TRUE(open());
    FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.3);
    ASSERT_TRUE(run_frames(packet, {}, 3));
    EXPECT_EQ(runtime_.record().depths, 0u);
    EXPECT_GT(runtime_.record().projection_frames, 0u);
    close();
  }
}

/// The hidden corner is black; all other pixels are as without a mask.
TEST_F(HeadsetLayers, PixelsHiddenByTheLensesAreNotDrawn) {
  std::vector<std::vector<std::uint8_t>> images;
  for (const bool masked : {false, true}) {
    if (masked) runtime_.script().unsupported.clear();
    ASSERT_TRUE(open());
    FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.5);
    ASSERT_TRUE(run_frames(packet, {}, 3));
    images.push_back(runtime_.record().last_images[0].rgba);
    close();
  }
  ASSERT_EQ(images[0].size(), images[1].size());
  const int width = 96, height = 80;
  int hidden = 0, different = 0;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const auto* p = &images[1][4 * std::size_t(j * width + i)];
      const auto* q = &images[0][4 * std::size_t(j * width + i)];
      const bool black = p[0] == 0 && p[1] == 0 && p[2] == 0;
      const double x = (i + 0.5) / (0.3 * width), y = (height - j - 0.5) / (0.3 * height);
      if (std::abs(x + y - 1) < 0.1) continue;  // the edge
      EXPECT_EQ(black, x + y < 1) << i << " " << j;
      hidden += black;
      different += !black && (p[0] != q[0] || p[1] != q[1] || p[2] != q[2]);
    }
  EXPECT_NEAR(hidden, 0.045 * width * height, 0.01 * width * height);
  EXPECT_EQ(different, 0);
}

TEST_F(HeadsetLayers, APanelIsAQuadLayer) {
  ASSERT_TRUE(open());
  FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.3);
  ASSERT_TRUE(run_frames(packet, {}, 3));
  auto panel = xr::QuadLayer::create(headset_->session(), {96, 80});
  ASSERT_TRUE(panel) << panel.error().message;
  headset_->show_panel(panel->get());
  ASSERT_TRUE(run_frames(packet, {}, 1));
  EXPECT_EQ(runtime_.record().quads, 0u);  // the panel has no image yet
  (*panel)->set_quad({{{0.1, -0.2, -0.6}, kIdentityRotation}, 0.4, 0.3});
  ASSERT_TRUE((*panel)->submit_image(renderer_->output_image()));
  ASSERT_TRUE(run_frames(packet, {}, 1));
  ASSERT_EQ(runtime_.record().quads, 1u);
  EXPECT_EQ(runtime_.record().last_quad_images[0].rgba, runtime_.record().last_images[0].rgba);
  EXPECT_EQ(runtime_.record().last_quad_images[0].pose.position.z, -0.6f);
  headset_->show_panel(nullptr);
  panel->reset();
  ASSERT_TRUE(run_frames(packet, {}, 1));
  EXPECT_EQ(runtime_.record().quads, 1u);
}

}  // namespace catena::test::layers_test
