// SPDX-License-Identifier: MIT
/// The headset's frame wait on its own thread: results arrive in order and once each, waiting times out, a late result is not lost, and
/// destruction waits for a pending call.
#include "render/xr/frame_waiter.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace catena::test::frame_wait_test {

using namespace std::chrono_literals;
using render::xr::FrameWaiter;

std::atomic<int> calls = 0, under_way = 0;
std::atomic<bool> held = false;

/// A runtime call that returns its call number when released.
XRAPI_ATTR XrResult XRAPI_CALL wait_frame(XrSession, const XrFrameWaitInfo*, XrFrameState* state) {
  ++under_way;
  while (held) std::this_thread::sleep_for(1ms);
  state->predictedDisplayTime = ++calls;
  --under_way;
  return XR_SUCCESS;
}

class FrameWaits : public ::testing::Test {
 protected:
  void SetUp() override {
    calls = 0;
    held = false;
  }
};

TEST_F(FrameWaits, ResultsArriveInOrderOnceEach) {
  FrameWaiter wait(wait_frame, XR_NULL_HANDLE);
  for (int k = 1; k <= 200; ++k) {
    const auto answer = wait.wait_for(std::nullopt);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->result, XR_SUCCESS);
    EXPECT_EQ(answer->state.predictedDisplayTime, k);
  }
}

TEST_F(FrameWaits, ALateResultIsKeptAndNotRequestedTwice) {
  FrameWaiter wait(wait_frame, XR_NULL_HANDLE);
  held = true;
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(wait.wait_for(1ms));
  held = false;
  const auto answer = wait.wait_for(std::nullopt);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->state.predictedDisplayTime, 1);
  EXPECT_EQ(calls, 1);
}

TEST_F(FrameWaits, DestructionWaitsForAPendingCall) {
  held = true;
  std::thread release;
  {
    FrameWaiter wait(wait_frame, XR_NULL_HANDLE);
    EXPECT_FALSE(wait.wait_for(0ms));
    while (under_way == 0) std::this_thread::yield();
    release = std::thread([] {
      std::this_thread::sleep_for(20ms);
      held = false;
    });
  }
  EXPECT_EQ(under_way, 0);
  EXPECT_EQ(calls, 1);
  release.join();
}

TEST_F(FrameWaits, ACallThatNeverReturnsIsAbandoned) {
  held = true;
  {
    FrameWaiter wait(wait_frame, XR_NULL_HANDLE);
    EXPECT_FALSE(wait.wait_for(0ms));
    while (under_way == 0) std::this_thread::yield();
    EXPECT_FALSE(wait.stop(5ms));
  }
  EXPECT_EQ(under_way, 1);
  // the call may return after the waiter is destroyed
  held = false;
  while (under_way != 0) std::this_thread::yield();
}

TEST_F(FrameWaits, ACallThatReturnsInTimeEndsItsThread) {
  FrameWaiter wait(wait_frame, XR_NULL_HANDLE);
  ASSERT_TRUE(wait.wait_for(std::nullopt));
  EXPECT_TRUE(wait.stop(10s));
  EXPECT_EQ(calls, 1);
}

TEST_F(FrameWaits, WithoutARequestThereIsNoCall) {
  { FrameWaiter wait(wait_frame, XR_NULL_HANDLE); }
  EXPECT_EQ(calls, 0);
}

}  // namespace catena::test::frame_wait_test
