// SPDX-License-Identifier: MIT
/// A malformed runtime: NaN poses, views without an angle, zero sizes, clocks that stop or run backwards. The image is skipped or minimal,
/// every frame begun is ended, and the next valid one is shown.
#include <cmath>
#include <limits>

#include "tests/render/xr/xr_fixture.h"

namespace catena::test::malformed_runtime_test {

using namespace xr_rig;

class MalformedRuntime : public HeadsetFixture {
 protected:
  FramePacket packet_ = ball_packet({0.0, 0.0, -1.0}, 0.3);
};

TEST_F(MalformedRuntime, InvalidPosesAndAnglesAreNotShown) {
  set_image_size(16, 16);
  const std::vector<XrView> good = runtime_.script().views;
  ASSERT_TRUE(open());
  ASSERT_TRUE(run_frames(packet_, {}, 4));
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::function<void(XrView&)> lies[] = {
      [&](XrView& v) { v.pose.position.y = nan; },      [&](XrView& v) { v.pose.position.x = inf; },
      [&](XrView& v) { v.fov.angleLeft = nan; },        [&](XrView& v) { v.fov = {0, 0, 0, 0}; },
      [&](XrView& v) { v.fov = {0.5f, -0.5f, -1, 1}; }, [&](XrView& v) { v.fov.angleUp = inf; },
  };
  for (const auto& lie : lies) {
    for (const std::size_t k : {0u, 1u}) {
      runtime_.script().views = good;
      lie(runtime_.script().views[k]);
      const std::uint64_t before = runtime_.record().projection_frames, frames = runtime_.record().frames;
      ASSERT_TRUE(shows(packet_, {}, 2));
      EXPECT_EQ(runtime_.record().projection_frames, before);
      EXPECT_EQ(runtime_.record().frames, frames + 2) << "what was begun is ended";
    }
    runtime_.script().views = good;
    const std::uint64_t before = runtime_.record().projection_frames;
    ASSERT_TRUE(run_frames(packet_, {}, 1));
    EXPECT_EQ(runtime_.record().projection_frames, before + 1);
  }
  // extreme but valid: far away, 180 degrees wide, with a zero rotation
  const std::function<void(XrView&)> odd[] = {
      [&](XrView& v) { v.pose.position = {1e30f, -1e30f, 1e30f}; }, [&](XrView& v) { v.fov = {-1.5707f, 1.5707f, 1.5707f, -1.5707f}; },
      [&](XrView& v) { v.fov = {-1e-6f, 1e-6f, 1e-6f, -1e-6f}; },   [&](XrView& v) { v.pose.orientation = {0, 0, 0, 0}; },
      [&](XrView& v) { v.pose.orientation = {nan, 0, 0, 1}; },
  };
  for (const auto& one : odd) {
    runtime_.script().views = good;
    one(runtime_.script().views[1]);
    ASSERT_TRUE(shows(packet_, {}, 1));
  }
}

TEST_F(MalformedRuntime, AZeroImageSizeBecomesOnePixel) {
  set_image_size(0, 0);
  ASSERT_TRUE(open());
  for (const xr::ViewSize& size : headset_->instance().view_sizes()) {
    EXPECT_EQ(size.width, 1u);
    EXPECT_EQ(size.height, 1u);
  }
  ASSERT_TRUE(shows(packet_, {}, 4));
  EXPECT_GT(runtime_.record().projection_frames, 0u);
}

TEST_F(MalformedRuntime, ZeroOrTooManyViewsAreRefused) {
  for (const std::size_t count : {0u, 65u}) {
    runtime_.script().views.assign(count, XrView{});
    const Outcome opened = open();
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().message.find("views, expected"), std::string::npos) << opened.error().message;
  }
}

/// One eye, or a headset with four displays, and runtimes with a single swapchain image.
TEST_F(MalformedRuntime, AnyNumberOfViewsAndASingleImageAreSupported) {
  set_image_size(16, 16);
  runtime_.script().images = 1;
  const std::vector<XrView> two = runtime_.script().views;
  for (const std::size_t count : {1u, 4u}) {
    runtime_.script().views.assign(count, two[0]);
    runtime_.script().views.back() = two[1];
    ASSERT_TRUE(open());
    const std::uint64_t before = runtime_.record().projection_frames;
    ASSERT_TRUE(shows(packet_, {}, 8));
    EXPECT_GT(runtime_.record().projection_frames, before + 4) << count;
    close();
  }
}

/// The display period determines the rays' time budget.
TEST_F(MalformedRuntime, AnInvalidDisplayPeriodIsReplaced) {
  set_image_size(8, 8);
  ASSERT_TRUE(open());
  for (const std::int64_t period : {std::int64_t(0), std::int64_t(-5), std::numeric_limits<std::int64_t>::max() / 8}) {
    runtime_.script().on_frame = [&](std::uint64_t, xr_runtime::Script& script) { script.reported_period_ns = period; };
    for (int k = 0; k < 4; ++k) {
      ASSERT_TRUE(headset_->poll());
      if (!headset_->is_running()) continue;
      auto frame = headset_->begin();
      ASSERT_TRUE(frame) << frame.error().message;
      EXPECT_GE(frame->display_period_ns, 1'000'000);
      EXPECT_LE(frame->display_period_ns, 1'000'000'000);
      ASSERT_TRUE(headset_->skip(*frame));
    }
  }
}

}  // namespace catena::test::malformed_runtime_test
