// SPDX-License-Identifier: MIT
/// What happens to `catena view --xr` where the session or the runtime goes, does not come, or does not answer.
#include "tests/engine/app/viewer_xr_fixture.h"

namespace catena::app {
namespace viewer_headset_loss_test {

class ViewerXrLoss : public viewer_xr_fixture::ViewerXr {};

/// The session is lost, then the whole runtime: said once each, the window goes on, and the headset comes back with a new device.
TEST_F(ViewerXrLoss, WhatIsLostComesBack) {
  ASSERT_EQ(run_view("--seconds 5", "size=32x32 fail=xrEndFrame:4:-17 fail=xrWaitFrame:12:-13"), 0) << log();
  EXPECT_NE(log().find("XR_ERROR_SESSION_LOST"), std::string::npos) << log();
  EXPECT_NE(log().find("XR_ERROR_INSTANCE_LOST"), std::string::npos) << log();
  EXPECT_EQ(headset_error_count(), 2) << log();
  EXPECT_GT(runtime_count("pictures"), 12);
  EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
  EXPECT_EQ(runtime_count("objects"), 0);
}

/// The runtime keeps a frame for three seconds: that is said, the window goes on, and so does the headset afterwards.
TEST_F(ViewerXrLoss, ARuntimeThatHangsDoesNotHoldTheWindow) {
  ASSERT_EQ(run_view("--seconds 6", "size=16x16 period_ms=20 paced hang=10:3000"), 0) << log();
  EXPECT_NE(log().find("the window goes on meanwhile"), std::string::npos) << log();
  EXPECT_EQ(headset_error_count(), 0) << log();
  EXPECT_GT(runtime_count("pictures"), 40);
  EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
  EXPECT_EQ(runtime_count("objects"), 0);
}

/// Closed meanwhile, it ends.
TEST_F(ViewerXrLoss, ItEndsWhileTheRuntimeHangs) {
  ASSERT_EQ(run_view("--seconds 1.5", "size=16x16 period_ms=20 paced hang=10:3000"), 0) << log();
  EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
  EXPECT_EQ(runtime_count("objects"), 0);
}

/// The headset is taken off, its session ends, it never begins: the program ends like any other.
TEST_F(ViewerXrLoss, ASessionThatDoesNotRunEndsWithTheProgram) {
  for (const char* script :
       {"size=16x16 period_ms=20 paced state=10:STOPPING", "size=16x16 period_ms=20 paced state=10:STOPPING state=11:EXITING",
        "size=16x16 period_ms=20 paced state=10:STOPPING fail=xrEndSession:1:-17"}) {
    EXPECT_EQ(run_view("--seconds 1.5", script), 0) << script << log();
    EXPECT_EQ(runtime_count("illegal"), 0) << script << test::read_file(folder_ / "record");
  }
}

/// A runtime that is back but makes no device: the window goes on with its own, and the runtime is tried again.
TEST_F(ViewerXrLoss, ARuntimeThatComesBackWithoutADeviceLeavesTheWindow) {
  constexpr int kBefore = 5;  // pictures before the sixth xrEndFrame fails
  for (const char* call : {"xrCreateVulkanDeviceKHR", "xrCreateVulkanInstanceKHR"}) {
    EXPECT_EQ(run_view("--seconds 4", std::string("size=16x16 fail=xrEndFrame:6:-13 fail=") + call + ":2:-2"), 0) << call << log();
    EXPECT_NE(log().find("is back without a device"), std::string::npos) << log();
    EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
    EXPECT_GT(runtime_count("pictures"), kBefore) << call << ": it never came back";
  }
}

/// What is lost again and again is tried every second, and said once.
TEST_F(ViewerXrLoss, ALossThatRepeatsIsSaidOnce) {
  ASSERT_EQ(run_view("--seconds 3.5", "size=16x16 paced period_ms=11 state=5:LOSS_PENDING"), 0) << log();
  EXPECT_EQ(headset_error_count(), 1) << log();
}

/// One that never comes back is left behind.
TEST_F(ViewerXrLoss, ItEndsWhereTheRuntimeNeverAnswers) {
  ASSERT_EQ(run_view("--seconds 1", "size=16x16 period_ms=20 paced hang=10:3600000"), 0) << log();
  EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
}

}  // namespace viewer_headset_loss_test
}  // namespace catena::app
