// SPDX-License-Identifier: MIT
/// Controllers: poses and buttons by interaction profile, vibration, tracking loss and recovery.
#include "tests/render/xr/xr_fixture.h"

namespace catena::test::controllers_test {

using namespace xr_rig;

class HeadsetControllers : public HeadsetFixture {
 protected:
  void SetUp() override {
    HeadsetFixture::SetUp();
    if (!runtime_.found()) return;
    set_image_size(16, 16);
    auto& right = runtime_.script().hands[1];
    right.grip = {{0.0f, 0.0f, 0.70710678f, 0.70710678f}, {0.2f, -0.1f, -0.4f}};
    right.aim = {{0, 0, 0, 1}, {0.2f, -0.1f, -0.45f}};
    right.select = 0.25f;
    right.squeeze = 1;
    right.stick = {-0.5f, 0.75f};
    right.menu = true;
  }
  xr::ControllerState hand(std::size_t which) {
    EXPECT_TRUE(headset_->actions().sync());
    auto state = headset_->actions().controller(which, *xr::to_xr_time(headset_->instance(), 5'000'000'000));
    EXPECT_TRUE(state) << state.error().message;
    return state ? *state : xr::ControllerState{};
  }
  FramePacket packet_ = ball_packet({0.0, 0.0, -1.0}, 0.3);
};

TEST_F(HeadsetControllers, EveryKnownControllerIsBound) {
  for (const std::string name : {"khr/simple", "oculus/touch", "valve/index", "htc/vive", "microsoft/motion"}) {
    SCOPED_TRACE(name);
    const std::string profile_path = "/interaction_profiles/" + name + "_controller";
    const bool is_simple = name == "khr/simple";  // it has only a click
    runtime_.script().profile = profile_path;
    ASSERT_TRUE(open());
    ASSERT_TRUE(run_frames(packet_, {}, 3));
    const xr::ControllerState state = hand(1);
    EXPECT_TRUE(state.is_tracked && state.has_aim && state.is_focused);
    EXPECT_NEAR(norm(state.grip.position - Vec3(0.2, -0.1, -0.4)), 0, 1e-7);
    EXPECT_NEAR(norm(rotate(state.grip.orientation, Vec3(1.0, 0.0, 0.0)) - Vec3(0.0, 1.0, 0.0)), 0, 1e-6);
    EXPECT_NEAR(state.aim.position.z, -0.45, 1e-7);
    EXPECT_EQ(state.select, 0.25);
    EXPECT_EQ(state.grab, is_simple ? 0 : 1);
    EXPECT_EQ(state.stick_x, is_simple ? 0 : -0.5);
    EXPECT_TRUE(state.menu);
    const auto profile = headset_->actions().interaction_profile(1);
    ASSERT_TRUE(profile);
    EXPECT_EQ(*profile, profile_path);
    close();
  }
}

TEST_F(HeadsetControllers, ALostHandIsAbsent) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(run_frames(packet_, {}, 3));
  EXPECT_TRUE(hand(1).is_tracked);
  runtime_.script().hands[1].active = false;
  EXPECT_FALSE(hand(1).is_tracked);
  EXPECT_TRUE(hand(0).is_tracked);
  runtime_.script().hands[1].active = true;
  runtime_.script().tracked = false;
  EXPECT_FALSE(hand(1).is_tracked);
  runtime_.script().tracked = true;
  EXPECT_TRUE(hand(1).is_tracked);
  // without focus there are no hands
  runtime_.script().states.emplace(runtime_.record().calls.at("xrWaitFrame"), XR_SESSION_STATE_VISIBLE);
  ASSERT_TRUE(run_frames(packet_, {}, 2));
  EXPECT_FALSE(hand(1).is_tracked);
}

TEST_F(HeadsetControllers, VibrationsReachTheRuntimeAndNoneWithoutFocus) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(run_frames(packet_, {}, 3));
  xr::Actions& actions = headset_->actions();
  ASSERT_TRUE(actions.vibrate(0, 0.25, 160, 30'000'000));
  ASSERT_TRUE(actions.vibrate(1, 7, -3, 0));  // clamped; the runtime's default frequency and shortest pulse
  ASSERT_TRUE(actions.stop_vibration(0));
  const auto& vibrations_received = runtime_.record().vibrations;
  ASSERT_EQ(vibrations_received.size(), 3u);
  const auto expect_vibration = [](const xr_runtime::Vibration& v, int hand, float amplitude, float frequency, std::int64_t duration) {
    EXPECT_EQ(v.hand, hand);
    EXPECT_EQ(v.amplitude, amplitude);
    EXPECT_EQ(v.frequency, frequency);
    EXPECT_EQ(v.duration, duration);
  };
  expect_vibration(vibrations_received[0], 0, 0.25f, 160.0f, 30'000'000);
  expect_vibration(vibrations_received[1], 1, 1.0f, 0.0f, std::int64_t(XR_MIN_HAPTIC_DURATION));
  EXPECT_TRUE(vibrations_received[2].stop);
  runtime_.script().states.emplace(runtime_.record().calls.at("xrWaitFrame"), XR_SESSION_STATE_VISIBLE);
  ASSERT_TRUE(run_frames(packet_, {}, 2));
  ASSERT_TRUE(actions.vibrate(0, 1, 0, 1'000'000));
  EXPECT_EQ(vibrations_received.size(), 3u);
}

/// The gaze is a pose; headsets without eye tracking or without the extension report none.
TEST_F(HeadsetControllers, TheGazeIsThePoseOfTheEyes) {
  const float s = std::sin(0.1f), c = std::cos(0.1f);
  for (const int lack : {0, 1, 2}) {
    SCOPED_TRACE(lack);
    runtime_.reset();
    set_image_size(16, 16);
    runtime_.script().gaze = XrPosef{{0, s, 0, c}, {0.01f, 0.02f, 0.03f}};
    if (lack == 1) runtime_.script().unsupported.insert(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME);
    if (lack == 2) runtime_.script().supports_gaze = false;
    ASSERT_TRUE(open());
    ASSERT_TRUE(run_frames(packet_, {}, 3));
    ASSERT_TRUE(headset_->actions().sync());
    const auto gaze = headset_->actions().gaze(5'000'000'000);
    ASSERT_TRUE(gaze) << gaze.error().message;
    EXPECT_EQ(gaze->has_value(), lack == 0);
    if (*gaze) {
      EXPECT_NEAR((*gaze)->position.y, 0.02, 1e-7);
      EXPECT_NEAR(norm(rotate((*gaze)->orientation, Vec3(0.0, 0.0, -1.0)) - Vec3(-std::sin(0.2), 0.0, -std::cos(0.2))), 0, 1e-6);
      runtime_.script().gaze.reset();  // the eyes are closed
      const auto shut = headset_->actions().gaze(5'000'000'000);
      ASSERT_TRUE(shut);
      EXPECT_FALSE(shut->has_value());
    }
    close();
  }
}

TEST_F(HeadsetControllers, SteadyClockTimesConvertToXrTimes) {
  ASSERT_TRUE(open());
  EXPECT_EQ(xr::to_xr_time(headset_->instance(), 12'345'678'901), std::optional<XrTime>(12'345'678'901));
  close();
  runtime_.script().unsupported.insert(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  ASSERT_TRUE(open());
  EXPECT_FALSE(xr::to_xr_time(headset_->instance(), 12'345'678'901));
}

}  // namespace catena::test::controllers_test
