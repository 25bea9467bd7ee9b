// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "render/extract/extract_internal.h"
#include "render/frame/camera.h"

namespace catena::render::stereo_test {

FramePacket packet() {
  FramePacket p;
  p.view.position = {0.0, -9.0, 0.0};
  p.width = 400;
  p.height = 300;
  return p;
}

/// Offset of an eye to the right of the view.
double side(const FramePacket& p, std::size_t k) { return p.eyes.at(k).position.x; }

scene::Stereo mode(scene::StereoMode m) {
  scene::Stereo stereo;
  stereo.mode = m;
  stereo.separation = 0.5;
  return stereo;
}

TEST(StereoCameras, LeftAndRightAreOneEyeOfThePair) {
  using scene::StereoMode;
  FramePacket p = packet();
  update_eyes(p, mode(StereoMode::mono));
  EXPECT_TRUE(p.eyes.empty());
  update_eyes(p, mode(StereoMode::left));
  ASSERT_EQ(p.eyes.size(), 1u);
  EXPECT_NEAR(side(p, 0), -0.25, 1e-12);
  update_eyes(p, mode(StereoMode::right));
  ASSERT_EQ(p.eyes.size(), 1u);
  EXPECT_NEAR(side(p, 0), 0.25, 1e-12);
  EXPECT_EQ(p.packing, Packing::single);
}

TEST(StereoCameras, CrossEyedAndSwappedExchangeTheEyes) {
  using scene::StereoMode;
  for (const StereoMode m : {StereoMode::side_by_side, StereoMode::cross_eyed})
    for (const bool swap : {false, true}) {
      FramePacket p = packet();
      scene::Stereo stereo = mode(m);
      stereo.swap_eyes = swap;
      update_eyes(p, stereo);
      ASSERT_EQ(p.eyes.size(), 2u);
      const bool crossed = swap != (m == StereoMode::cross_eyed);
      EXPECT_NEAR(side(p, 0), crossed ? 0.25 : -0.25, 1e-12);
      EXPECT_NEAR(side(p, 1), crossed ? -0.25 : 0.25, 1e-12);
      EXPECT_EQ(p.packing, Packing::side_by_side);
    }
}

TEST(StereoCameras, TheViewCountAppliesToModesWithManyViews) {
  using scene::StereoMode;
  for (int i = 0; i < scene::kStereoModeCount; ++i) {
    scene::Stereo stereo = mode(static_cast<StereoMode>(i));
    stereo.view_count = 5;
    FramePacket p = packet();
    update_eyes(p, stereo);
    EXPECT_EQ(std::max<std::size_t>(1, p.eyes.size()), stereo_view_count(stereo)) << scene::to_string(stereo.mode);
    const bool many = i != 0 && !scene::needs_two_views(stereo.mode);
    EXPECT_EQ(p.eyes.size() == 5, many) << scene::to_string(stereo.mode);
  }
}

TEST(StereoCameras, ThePackedEyesFillTheWindow) {
  for (const Packing packing : {Packing::single, Packing::side_by_side, Packing::top_bottom, Packing::anaglyph, Packing::rows}) {
    const PackedSize eye = view_size(packing, 2, 800, 600);
    const PackedSize whole = packed_size(packing, 2, std::uint32_t(eye.width), std::uint32_t(eye.height));
    EXPECT_EQ(whole.width, 800u);
    EXPECT_EQ(whole.height, 600u);
  }
}

}  // namespace catena::render::stereo_test
