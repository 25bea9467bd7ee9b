// SPDX-License-Identifier: MIT
/// `catena view --xr` with a session or a runtime that is lost, does not start, or does not respond.
#include "tests/engine/app/viewer_xr_fixture.h"

namespace catena::app::viewer_xr_loss_test {

class ViewerXrLoss : public viewer_xr_fixture::ViewerXr {};

/// The session is lost, then the whole runtime: each is reported once, the window continues, and the headset restarts with a new device.
TEST_F(ViewerXrLoss, ALostSessionAndRuntimeAreRestarted) {
  ASSERT_EQ(run_view("--seconds 5", "size=32x32 fail=xrEndFrame:4:-17 fail=xrWaitFrame:12:-13"), 0) << log();
  EXPECT_TRUE(test::has(log(), "XR_ERROR_SESSION_LOST"));
  EXPECT_TRUE(test::has(log(), "XR_ERROR_INSTANCE_LOST"));
  EXPECT_EQ(headset_error_count(), 2) << log();
  EXPECT_GT(runtime_count("pictures"), 12);
  expect_clean_runtime();
}

/// The runtime blocks a frame for three seconds: a note is printed, the window continues, and the headset continues afterwards.
TEST_F(ViewerXrLoss, AHangingRuntimeDoesNotBlockTheWindow) {
  ASSERT_EQ(run_view("--seconds 6", "size=16x16 period_ms=20 paced hang=10:3000"), 0) << log();
  EXPECT_NE(log().find("the window continues"), std::string::npos) << log();
  EXPECT_EQ(headset_error_count(), 0) << log();
  EXPECT_GT(runtime_count("pictures"), 40);
  expect_clean_runtime();
}

/// A window that is closed while the runtime hangs ends.
TEST_F(ViewerXrLoss, TheProgramEndsWhileTheRuntimeHangs) {
  ASSERT_EQ(run_view("--seconds 1.5", "size=16x16 period_ms=20 paced hang=10:3000"), 0) << log();
  expect_clean_runtime();
}

/// The headset is taken off, or the session ends or fails to end: the program ends normally.
TEST_F(ViewerXrLoss, AStoppedSessionDoesNotPreventTheProgramsEnd) {
  for (const char* script :
       {"size=16x16 period_ms=20 paced state=10:STOPPING", "size=16x16 period_ms=20 paced state=10:STOPPING state=11:EXITING",
        "size=16x16 period_ms=20 paced state=10:STOPPING fail=xrEndSession:1:-17"})
    expect_legal_view("--seconds 1.5", script);
}

/// A restarted runtime that creates no device: the window continues with a device of its own, and retries the runtime.
TEST_F(ViewerXrLoss, ARestartedRuntimeWithoutADeviceIsRetried) {
  constexpr int kBefore = 5;  // frames before the sixth xrEndFrame fails
  for (const char* call : {"xrCreateVulkanDeviceKHR", "xrCreateVulkanInstanceKHR"}) {
    expect_legal_view("--seconds 4", std::string("size=16x16 fail=xrEndFrame:6:-13 fail=") + call + ":2:-2");
    EXPECT_NE(log().find("restarted without a graphics device"), std::string::npos) << log();
    EXPECT_GT(runtime_count("pictures"), kBefore) << call << ": it never came back";
  }
}

/// A session that is lost repeatedly is retried every second, and reported once.
TEST_F(ViewerXrLoss, ARepeatedLossIsReportedOnce) {
  ASSERT_EQ(run_view("--seconds 3.5", "size=16x16 paced period_ms=11 state=5:LOSS_PENDING"), 0) << log();
  EXPECT_EQ(headset_error_count(), 1) << log();
}

/// A runtime that never returns does not prevent the end of the program.
TEST_F(ViewerXrLoss, TheProgramEndsIfTheRuntimeNeverReturns) {
  expect_legal_view("--seconds 1", "size=16x16 period_ms=20 paced hang=10:3600000");
}

}  // namespace catena::app::viewer_xr_loss_test
