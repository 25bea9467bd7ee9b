// SPDX-License-Identifier: MIT
/// What goes to the runtime beside the pictures: depth, what the lenses hide, a panel.
#include <gtest/gtest.h>

#include "render/vk/commands.h"
#include "tests/render/support/image_fixture.h"
#include "tests/render/xr/xr_fixture.h"

namespace catena::test {
namespace layers_test {

using namespace xr_rig;

class HeadsetLayers : public HeadsetFixture {
 protected:
  void SetUp() override {
    HeadsetFixture::SetUp();
    if (runtime_.found()) runtime_.script().capture_images = true;
  }
};

/// The nearest point of a ball before the middle of the eye, in metres, out of what was submitted.
TEST_F(HeadsetLayers, DepthsAreMetresWhateverTheWorldsUnit) {
  XrView& view = runtime_.script().views[0];
  view.pose = {{0, 0, 0, 1}, {0, 0, 0}};
  view.fov = {-0.5f, 0.5f, 0.5f, -0.5f};
  runtime_.script().width = runtime_.script().height = 65;
  ASSERT_TRUE(open());
  Placement placement;
  placement.meters_per_unit = 0.01;
  for (const double metres : {0.3, 1.0, 8.0}) {
    FramePacket packet = ball_packet({0.0, 0.0, -100.0 * metres}, 100 * 0.2 * metres);
    ASSERT_TRUE(run_frames(packet, placement, 3));
    ASSERT_GT(runtime_.record().depths, 0u);
    const xr_runtime::CapturedImage& picture = runtime_.record().last_images[0];
    ASSERT_EQ(picture.depth.size(), 65u * 65u);
    const double n = picture.near_z, f = picture.far_z, d = picture.depth[32 * 65 + 32];
    EXPECT_EQ(picture.min_depth, 0.0f);
    EXPECT_EQ(picture.max_depth, 1.0f);
    const double z = n * f / (f - d * (f - n));
    EXPECT_NEAR(z / (0.8 * metres), 1, 2e-3);
    EXPECT_EQ(picture.depth[0], 1.0f);  // nothing there
  }
}

/// Of a submitted picture, metres along the eye's axis; infinite where nothing is.
double metres_at(const xr_runtime::CapturedImage& picture, int i, int j) {
  const double n = picture.near_z, f = picture.far_z, d = picture.depth[std::size_t(j) * picture.width + std::size_t(i)];
  return d >= 1 ? HUGE_VAL : n * f / (f - d * (f - n));
}

/// A volume has the depth where alpha passes 0.5, by exact rays and by fast ones: from outside, from within, before and behind something
/// opaque; where alpha stays below that, what is behind it.
TEST_F(HeadsetLayers, AVolumeIsAsDeepAsHalfItsAlpha) {
  constexpr int kSize = 64;
  constexpr double kScale = 0.05, kExtent = 16;  // metres a unit; of the box, units
  for (XrView& view : runtime_.script().views) {
    view.pose = {{0, 0, 0, 1}, {0, 0, 0}};
    view.fov = {-0.4f, 0.4f, 0.4f, -0.4f};
  }
  runtime_.script().width = runtime_.script().height = kSize;
  ASSERT_TRUE(open());
  const auto even = make_grid({17, 17, 17}, [](const Vec3&) { return 1.0; });
  const auto ramp = make_grid({17, 17, 17}, [](const Vec3& at) { return at.z; });
  struct Case {
    const char* name;
    const GridPtr& grid;
    double sigma;    ///< a unit, times the value; of the ramp at its nearest face 16 times that
    double front_m;  ///< of the box, from the eye; < 0: the eye is within
    double ball_m;   ///< the nearest point of a ball on the axis; 0: none
    bool seen;       ///< alpha passes 0.5
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
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(headset_->poll());
        const auto frame = headset_->begin();
        ASSERT_TRUE(frame);
        const Outcome shown = headset_->show(*frame, *renderer_, packet, settings, placement);
        ASSERT_TRUE(shown) << shown.error().message;
      }
      const xr_runtime::CapturedImage& picture = runtime_.record().last_images[0];
      ASSERT_EQ(picture.depth.size(), std::size_t(kSize) * kSize);
      for (const int place : {24, 32, 40}) {  // of rays that were marched
        const double tangent = (place + 0.5 - kSize / 2) / (kSize / 2) * std::tan(0.4), slant = std::hypot(1, tangent);
        // along the ray: sigma l = ln 2; of the ramp sigma (16 l - l^2 / 2), l along the axis, where each unit is `slant` long
        double l = std::log(2.0) / due.sigma / slant;
        if (due.grid == ramp) l = 16 - std::sqrt(256 - 2 * l);
        const double volume_m = std::max(0.0, due.front_m) + kScale * l;
        const bool ball = due.ball_m > 0 && place == 32;
        const double metres = metres_at(picture, place, 32);
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

/// Its depth is not known, and what is opaque behind it would lie too deep.
TEST_F(HeadsetLayers, AProjectionHasNoDepth) {
  ASSERT_TRUE(open());
  FramePacket packet = ball_packet({8.0, 8.0, 4.0}, 3);
  packet.volumes.push_back(volume_item(make_grid({17, 17, 17}, [](const Vec3& at) { return at.z; }), {{0, 0}, {16, 1}}));
  packet.volumes.back().projection = Projection::maximum;
  Placement placement;
  placement.meters_per_unit = 0.05;
  placement.world_origin = {8.0, 8.0, 30.0};
  const Outcome turned = run_frames(packet, placement, 3);
  ASSERT_TRUE(turned) << turned.error().message;
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
    headset_->stop();
    renderer_.reset();
    headset_.reset();
  }
}

/// The hidden corner is black, all else is as without a mask.
TEST_F(HeadsetLayers, WhatTheLensesHideIsNotDrawn) {
  std::vector<std::vector<std::uint8_t>> pictures;
  for (const bool masked : {false, true}) {
    if (masked) runtime_.script().unsupported.clear();
    ASSERT_TRUE(open());
    FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.5);
    ASSERT_TRUE(run_frames(packet, {}, 3));
    pictures.push_back(runtime_.record().last_images[0].rgba);
    headset_->stop();
    renderer_.reset();
    headset_.reset();
  }
  ASSERT_EQ(pictures[0].size(), pictures[1].size());
  const int width = 96, height = 80;
  int hidden = 0, different = 0;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const auto* p = &pictures[1][4 * std::size_t(j * width + i)];
      const auto* q = &pictures[0][4 * std::size_t(j * width + i)];
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

TEST_F(HeadsetLayers, APanelIsAQuadOverThePicture) {
  ASSERT_TRUE(open());
  FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.3);
  ASSERT_TRUE(run_frames(packet, {}, 3));
  auto panel = xr::QuadLayer::create(headset_->session(), {96, 80});
  ASSERT_TRUE(panel) << panel.error().message;
  headset_->show_panel(panel->get());
  ASSERT_TRUE(run_frames(packet, {}, 1));
  EXPECT_EQ(runtime_.record().quads, 0u);  // it has no picture yet
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

}  // namespace layers_test
}  // namespace catena::test
