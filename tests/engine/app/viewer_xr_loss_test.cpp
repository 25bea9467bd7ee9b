// SPDX-License-Identifier: MIT
/// `catena view --xr` with a session or a runtime that is lost, does not start, or does not respond.
#include "tests/engine/app/viewer_xr_fixture.h"

namespace catena::app {
namespace viewer_xr_loss_test {

class ViewerXrLoss : public viewer_xr_fixture::ViewerXr {};

/// The session is lost, then the whole runtime: each is reported once, the window continues, and the headset restarts with a new device.
TEST_F(ViewerXrLoss, ALostSessionAndRuntimeAreRestarted) {
  ASSERT_EQ(run_view("--seconds 5", "size=32x32 fail=xrEndFrame:4:-17 fail=xrWaitFrame:12:-13"), 0) << log();
  EXPECT_NE(log().find("XR_ERROR_SESSION_LOST"), std::string::npos) << log();
  EXPECT_NE(log().find("XR_ERROR_INSTANCE_LOST"), std::string::npos) << log();
  EXPECT_EQ(headset_error_count(), 2) << log();
  EXPECT_GT(runtime_count("pictures"), 12);
  EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
  EXPECT_EQ(runtime_count("objects"), 0);
}

/// The runtime blocks a frame for three seconds: a note is printed, the window continues, and the headset continues afterwards.
TEST_F(ViewerXrLoss, AHangingRuntimeDoesNotBlockTheWindow) {
  ASSERT_EQ(run_view("--seconds 6", "size=16x16 period_ms=20 paced hang=10:3000"), 0) << log();
  EXPECT_NE(log().find("the window continues"), std::string::npos) << log();
  EXPECT_EQ(headset_error_count(), 0) << log();
  EXPECT_GT(runtime_count("pictures"), 40);
  EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
  EXPECT_EQ(runtime_count("objects"), 0);
}

/// A window that is closed while the runtime hangs ends.
TEST_F(ViewerXrLoss, TheProgramEndsWhileTheRuntimeHangs) {
  ASSERT_EQ(run_view("--seconds 1.5", "size=16x16 period_ms=20 paced hang=10:3000"), 0) << log();
  EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
  EXPECT_EQ(runtime_count("objects"), 0);
}

/// The headset is taken off, or the session ends or fails to end: the program ends normally.
TEST_F(ViewerXrLoss, AStoppedSessionDoesNotPreventTheProgramsEnd) {
  for (const char* script :
       {"size=16x16 period_ms=20 paced state=10:STOPPING", "size=16x16 period_ms=20 paced state=10:STOPPING state=11:EXITING",
        "size=16x16 period_ms=20 paced state=10:STOPPING fail=xrEndSession:1:-17"}) {
    EXPECT_EQ(run_view("--seconds 1.5", script), 0) << script << log();
    EXPECT_EQ(runtime_count("illegal"), 0) << script << test::read_file(folder_ / "record");
  }
}

/// A restarted runtime that creates no device: the window continues with a device of its own, and retries the runtime.
TEST_F(ViewerXrLoss, ARestartedRuntimeWithoutADeviceIsRetried) {
  constexpr int kBefore = 5;  // frames before the sixth xrEndFrame fails
  for (const char* call : {"xrCreateVulkanDeviceKHR", "xrCreateVulkanInstanceKHR"}) {
    EXPECT_EQ(run_view("--seconds 4", std::string("size=16x16 fail=xrEndFrame:6:-13 fail=") + call + ":2:-2"), 0) << call << log();
    EXPECT_NE(log().find("restarted without a graphics device"), std::string::npos) << log();
    EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
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
  ASSERT_EQ(run_view("--seconds 1", "size=16x16 period_ms=20 paced hang=10:3600000"), 0) << log();
  EXPECT_EQ(runtime_count("illegal"), 0) << test::read_file(folder_ / "record");
}

}  // namespace viewer_xr_loss_test
}  // namespace catena::app
