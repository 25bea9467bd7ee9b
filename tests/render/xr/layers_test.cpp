/// What goes to the runtime beside the pictures: depth, what the lenses hide, a panel.
#include <gtest/gtest.h>

#include "render/vk/commands.h"
#include "tests/render/xr/rig.h"

namespace catena::test {
namespace layers_test {

using namespace xr_rig;

class HeadsetLayers : public HeadsetFixture {
 protected:
  void SetUp() override {
    HeadsetFixture::SetUp();
    if (runtime_.found()) runtime_.script().keep_pictures = true;
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
  placement.metres_per_unit = 0.01;
  for (const double metres : {0.3, 1.0, 8.0}) {
    FramePacket packet = ball_packet({0.0, 0.0, -100.0 * metres}, 100 * 0.2 * metres);
    ASSERT_TRUE(turn(packet, placement, 3));
    ASSERT_GT(runtime_.record().depths, 0u);
    const xr_runtime::KeptPicture& picture = runtime_.record().last[0];
    ASSERT_EQ(picture.depth.size(), 65u * 65u);
    const double n = picture.near_z, f = picture.far_z, d = picture.depth[32 * 65 + 32];
    EXPECT_EQ(picture.min_depth, 0.0f);
    EXPECT_EQ(picture.max_depth, 1.0f);
    const double z = n * f / (f - d * (f - n));
    EXPECT_NEAR(z / (0.8 * metres), 1, 2e-3);
    EXPECT_EQ(picture.depth[0], 1.0f);  // nothing there
  }
}

TEST_F(HeadsetLayers, WithoutTheExtensionOrItsFormatThereAreNoDepths) {
  for (const bool by_format : {false, true}) {
    runtime_.reset();
    if (by_format) runtime_.script().formats.pop_back();
    if (!by_format) runtime_.script().without.insert(XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME);
    ASSERT_TRUE(open());
    FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.3);
    ASSERT_TRUE(turn(packet, {}, 3));
    EXPECT_EQ(runtime_.record().depths, 0u);
    EXPECT_GT(runtime_.record().pictures, 0u);
    headset_->stop();
    renderer_.reset();
    headset_.reset();
  }
}

/// The hidden corner is black, all else is as without a mask.
TEST_F(HeadsetLayers, WhatTheLensesHideIsNotDrawn) {
  std::vector<std::vector<std::uint8_t>> pictures;
  for (const bool masked : {false, true}) {
    if (masked) runtime_.script().without.clear();
    ASSERT_TRUE(open());
    FramePacket packet = ball_packet({0.0, 0.0, -1.0}, 0.5);
    ASSERT_TRUE(turn(packet, {}, 3));
    pictures.push_back(runtime_.record().last[0].rgba);
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
  ASSERT_TRUE(turn(packet, {}, 3));
  auto panel = xr::QuadLayer::create(headset_->session(), {96, 80});
  ASSERT_TRUE(panel) << panel.error().message;
  headset_->show_panel(panel->get());
  ASSERT_TRUE(turn(packet, {}, 1));
  EXPECT_EQ(runtime_.record().quads, 0u);  // it has no picture yet
  (*panel)->place({{{0.1, -0.2, -0.6}, kNoRotation}, 0.4, 0.3});
  ASSERT_TRUE((*panel)->take(renderer_->picture()));
  ASSERT_TRUE(turn(packet, {}, 1));
  ASSERT_EQ(runtime_.record().quads, 1u);
  EXPECT_EQ(runtime_.record().last_quads[0].rgba, runtime_.record().last[0].rgba);
  EXPECT_EQ(runtime_.record().last_quads[0].pose.position.z, -0.6f);
  headset_->show_panel(nullptr);
  panel->reset();
  ASSERT_TRUE(turn(packet, {}, 1));
  EXPECT_EQ(runtime_.record().quads, 1u);
}

}  // namespace layers_test
}  // namespace catena::test
