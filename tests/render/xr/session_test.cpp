// SPDX-License-Identifier: MIT
/// Life cycle of a session: every edge of the state graph, a failure of every call, many frames, and OpenXR's validation layer.
#include <array>
#include <chrono>
#include <cstdio>
#include <set>
#include <thread>

#include "tests/render/xr/xr_fixture.h"
#include "tests/support/resident.h"

namespace catena::test::session_test {

using namespace xr_rig;

constexpr XrSessionState kUnknown = XR_SESSION_STATE_UNKNOWN, kIdle = XR_SESSION_STATE_IDLE, kReady = XR_SESSION_STATE_READY,
                         kSynchronized = XR_SESSION_STATE_SYNCHRONIZED, kVisible = XR_SESSION_STATE_VISIBLE,
                         kFocused = XR_SESSION_STATE_FOCUSED, kStopping = XR_SESSION_STATE_STOPPING, kLoss = XR_SESSION_STATE_LOSS_PENDING,
                         kExiting = XR_SESSION_STATE_EXITING;

TEST(SessionStates, TheGraphHasTheEdgesOfTheSpecification) {
  const std::set<std::pair<int, int>> edges{
      {kUnknown, kIdle},         {kIdle, kReady},           {kIdle, kExiting},          {kReady, kSynchronized},
      {kReady, kStopping},       {kSynchronized, kVisible}, {kSynchronized, kStopping}, {kVisible, kFocused},
      {kVisible, kSynchronized}, {kFocused, kVisible},      {kStopping, kIdle},         {kIdle, kLoss},
      {kReady, kLoss},           {kSynchronized, kLoss},    {kVisible, kLoss},          {kFocused, kLoss},
      {kStopping, kLoss}};
  for (int from = kUnknown; from <= kExiting; ++from)
    for (int to = kUnknown; to <= kExiting; ++to)
      EXPECT_EQ(xr::is_valid_transition(XrSessionState(from), XrSessionState(to)), edges.contains({from, to})) << from << " to " << to;
}

class HeadsetSession : public HeadsetFixture {
 protected:
  void play(const std::vector<std::pair<std::uint64_t, XrSessionState>>& states) {
    for (const auto& [frame, state] : states) runtime_.script().states.emplace(frame, state);
  }
  /// Everything that the program does with a headset.
  Outcome use() {
    CATENA_CHECK(run_frames(packet_, {}, 4));
    xr::Actions& actions = headset_->actions();
    for (std::size_t hand = 0; hand < xr::kControllers; ++hand) {
      CATENA_CHECK(actions.sync());
      const auto now = xr::to_xr_time(headset_->instance(), 1'000'000'000);
      CATENA_TRY([[maybe_unused]] const xr::ControllerState state, actions.controller(hand, now.value_or(1)));
      CATENA_CHECK(actions.vibrate(hand, 0.5, 100, 20'000'000));
      CATENA_CHECK(actions.stop_vibration(hand));
      CATENA_TRY([[maybe_unused]] const auto gaze, actions.gaze(now.value_or(1)));
      CATENA_TRY([[maybe_unused]] const std::string profile, actions.interaction_profile(hand));
    }
    CATENA_CHECK(run_frames(packet_, {}, 2));
    CATENA_CHECK(headset_->session().request_exit());
    return run_frames(packet_, {}, 3);
  }
  FramePacket packet_ = ball_packet({0.0, 0.0, -1.0}, 0.3);
};

TEST_F(HeadsetSession, FollowsEveryEdgeUntilTheUserExits) {
  set_image_size(16, 16);
  play({{4, kVisible}, {6, kSynchronized}, {9, kVisible}, {11, kFocused}, {13, kVisible}, {14, kSynchronized}, {15, kStopping}});
  runtime_.script().after_end = {kReady};
  ASSERT_TRUE(open());
  ASSERT_TRUE(run_frames(packet_, {}, 17));
  // between frames 6 and 9, and before the first end, the session is not visible
  EXPECT_EQ(headset_->counts().frames, 17u);
  EXPECT_LT(headset_->counts().rendered, headset_->counts().frames - 4);
  EXPECT_EQ(headset_->counts().rendered, runtime_.record().projection_frames);
  EXPECT_EQ(headset_->session().invalid_transitions(), 0u);
  const auto& seen = headset_->session().state_history();
  EXPECT_NE(std::ranges::find(seen, kStopping), seen.end());
  // the session begins again and is ended by the user
  const auto before = headset_->counts().rendered;
  ASSERT_TRUE(run_frames(packet_, {}, 4));
  EXPECT_GT(headset_->counts().rendered, before);
  ASSERT_TRUE(headset_->session().request_exit());
  ASSERT_TRUE(run_frames(packet_, {}, 4));
  EXPECT_TRUE(headset_->session().has_exited());
  EXPECT_FALSE(headset_->is_running());
  EXPECT_EQ(headset_->session().invalid_transitions(), 0u);
}

TEST_F(HeadsetSession, ARepeatedStopEndsTheSessionOnce) {
  set_image_size(16, 16);
  play({{4, kStopping}, {4, kStopping}});
  ASSERT_TRUE(open());
  ASSERT_TRUE(run_frames(packet_, {}, 8));
  EXPECT_FALSE(headset_->is_running());
  EXPECT_EQ(runtime_.record().illegal.size(), 0u);
}

TEST_F(HeadsetSession, ALossIsDetectedInEveryState) {
  set_image_size(16, 16);
  ASSERT_TRUE(open());
  for (const XrSessionState state : {kSynchronized, kVisible, kFocused}) {
    ASSERT_TRUE(headset_->start(renderer_->device()));
    ASSERT_TRUE(run_frames(packet_, {}, 4));
    const std::uint64_t now = runtime_.record().calls.at("xrWaitFrame");
    ASSERT_GT(now, 0u);
    runtime_.script().states.clear();
    runtime_.script().on_frame = [state, done = false](std::uint64_t frame, xr_runtime::Script& script) mutable {
      if (std::exchange(done, true)) return;
      if (state != kFocused) script.states.emplace(frame, kVisible);
      if (state == kSynchronized) script.states.emplace(frame, kSynchronized);
      script.states.emplace(frame, kLoss);
    };
    const Outcome lost = run_frames(packet_, {}, 2);
    ASSERT_FALSE(lost);
    EXPECT_EQ(headset_->loss(), xr::Loss::session);
    EXPECT_FALSE(headset_->is_running());
    runtime_.script().on_frame = {};
  }
  // a new session works
  runtime_.script().states.clear();
  ASSERT_TRUE(headset_->start(renderer_->device()));
  EXPECT_EQ(headset_->loss(), xr::Loss::none);
  ASSERT_TRUE(run_frames(packet_, {}, 4));
}

TEST_F(HeadsetSession, WithoutTrackingNothingIsShown) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(run_frames(packet_, {}, 3));
  const std::uint64_t before = runtime_.record().projection_frames;
  runtime_.script().tracked = false;
  ASSERT_TRUE(run_frames(packet_, {}, 3));
  EXPECT_EQ(runtime_.record().projection_frames, before);
  EXPECT_EQ(runtime_.record().frames, headset_->counts().frames);
  runtime_.script().tracked = true;
  ASSERT_TRUE(run_frames(packet_, {}, 1));
  EXPECT_EQ(runtime_.record().projection_frames, before + 1);
}

TEST_F(HeadsetSession, RecentringAndNewVisibilityMasksAreCounted) {
  runtime_.script().unsupported.clear();
  ASSERT_TRUE(open());
  XrEventDataBuffer space{}, mask{};
  space.type = XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING;
  mask.type = XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR;
  runtime_.script().events.emplace(2, space);
  runtime_.script().events.emplace(3, mask);
  const auto asked = runtime_.record().calls.at("xrGetVisibilityMaskKHR");
  ASSERT_TRUE(run_frames(packet_, {}, 6));
  EXPECT_EQ(headset_->session().recenter_count(), 1u);
  EXPECT_EQ(headset_->session().mask_change_count(), 1u);
  EXPECT_EQ(runtime_.record().calls.at("xrGetVisibilityMaskKHR"), 2 * asked);  // fetched again, once
}

/// Each call fails in turn, the first and the third time, with its possible errors: earlier resources are freed, the error is one line,
/// and the next attempt works.
TEST_F(HeadsetSession, EveryCallsFailureIsReportedAndRecoveredFrom) {
  Runtime& r = runtime_;
  r.script().width = r.script().height = 16;
  r.script().unsupported.clear();
  validation_ = false;
  ASSERT_TRUE(open());
  ASSERT_TRUE(use());
  close();
  std::vector<std::string> functions;
  for (const auto& [name, calls] : r.record().calls) functions.push_back(name);
  EXPECT_GE(functions.size(), 40u);
  constexpr XrResult kCodes[] = {XR_ERROR_SESSION_LOST, XR_ERROR_INSTANCE_LOST, XR_ERROR_RUNTIME_FAILURE, XR_ERROR_OUT_OF_MEMORY};
  std::size_t turns = 0, failed = 0;
  for (const std::string& function : functions)
    for (const int at : {1, 3}) {
      SCOPED_TRACE(function + " " + std::to_string(at));
      r.reset();
      r.script().width = r.script().height = 16;
      r.script().unsupported.clear();
      r.script().failures[function] = {at, kCodes[turns++ % std::size(kCodes)]};
      Outcome outcome = open();
      if (outcome) outcome = use();
      const bool lost = headset_ && headset_->loss() != xr::Loss::none;
      if (!outcome) {
        ++failed;
        EXPECT_EQ(outcome.error().message.find('\n'), std::string::npos);
        EXPECT_TRUE(outcome.error().message.find("headset") != std::string::npos || outcome.error().message.starts_with("Vulkan could not"))
            << outcome.error().message;
      }
      // errors of the session: retry on the same device; other errors: restart everything
      if (!outcome && lost && headset_->loss() == xr::Loss::session && renderer_) {
        const Outcome again = headset_->start(renderer_->device());
        ASSERT_TRUE(again) << again.error().message;
        ASSERT_TRUE(shows(packet_, {}, 5));
        EXPECT_GT(r.record().projection_frames, 0u);
      }
      close();
      EXPECT_EQ(r.record().objects, 0u);
      EXPECT_TRUE(r.record().illegal.empty()) << r.record().illegal.front();
    }
  EXPECT_GT(failed, functions.size());
}

/// Memory does not grow over frames. CATENA_XR_FRAMES=100000 for a long run.
TEST_F(HeadsetSession, ManyFramesTakeNoMoreMemory) {
  const char* asked = std::getenv("CATENA_XR_FRAMES");
  const int frames = asked ? std::atoi(asked) : 300;
  set_image_size(8, 8);
  runtime_.script().period_ns = 1'000'000;
  validation_ = asked != nullptr;  // validation takes most of the time
  ASSERT_TRUE(open());
  ASSERT_TRUE(run_frames(packet_, {}, frames / 3));
  const std::uint64_t device = renderer_->stats().gpu_bytes, before = resident_bytes();
  ASSERT_TRUE(run_frames(packet_, {}, frames - frames / 3));
  EXPECT_EQ(renderer_->stats().gpu_bytes, device);
  const double grown = double(resident_bytes()) - double(before);
  EXPECT_LT(kResidentIsReliable ? grown : 0, 2e6 + 1.0 * frames);  // one byte per frame for the fixture's own records
  EXPECT_EQ(runtime_.record().frames, std::uint64_t(frames));
  EXPECT_EQ(runtime_.record().moved_poses, 0u);
  RecordProperty("grown_bytes", std::to_string(grown));
  if (asked) std::printf("%d frames, %.0f bytes more after the first third\n", frames, grown);
}

/// XR_RUNTIME_JSON=/somewhere/openxr.json build/release/test_render_xr --gtest_filter='*AnyNamedRuntime*' tests a real runtime.
TEST_F(HeadsetSession, AnyNamedRuntimeShowsImages) {
  if (original_runtime().empty()) GTEST_SKIP() << "XR_RUNTIME_JSON names no runtime";
  ::setenv("XR_RUNTIME_JSON", original_runtime().c_str(), 1);
  const Outcome opened = open();
  if (!opened) GTEST_SKIP() << opened.error().message;
  for (int i = 0; i < 2000 && headset_->counts().rendered < 60; ++i) {
    if (!headset_->is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(shows(packet_, {}, 1));
  }
  EXPECT_GE(headset_->counts().rendered, 60u);
  ASSERT_TRUE(headset_->session().request_exit());
  for (int i = 0; i < 2000 && !headset_->session().has_exited(); ++i) {
    if (!headset_->is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(shows(packet_, {}, 1));
  }
  EXPECT_TRUE(headset_->session().has_exited());
  EXPECT_EQ(headset_->session().invalid_transitions(), 0u);
  std::printf("%s:", headset_->instance().name().c_str());
  for (const XrSessionState state : headset_->session().state_history()) std::printf(" %s", xr::state_name(state));
  std::printf("; %llu frames, %llu pictures\n", (unsigned long long)headset_->counts().frames,
              (unsigned long long)headset_->counts().rendered);
}

/// Debian's validation layer between program and runtime, which writes its findings to a file.
TEST_F(HeadsetSession, TheOpenXrValidationLayerFindsNoError) {
  if (!exists("/usr/share/openxr/1/api_layers/explicit.d/XrApiLayer_core_validation.x86_64-linux-gnu.json"))
    GTEST_SKIP() << "the package openxr-layer-corevalidation is not installed";
  TemporaryFolder folder;
  const std::string file = folder / "found.txt";
  ::setenv("XR_ENABLE_API_LAYERS", "XR_APILAYER_LUNARG_core_validation", 1);
  ::setenv("XR_CORE_VALIDATION_EXPORT_TYPE", "text", 1);
  ::setenv("XR_CORE_VALIDATION_FILE_NAME", file.c_str(), 1);
  runtime_.script().unsupported.clear();
  ASSERT_TRUE(opens());
  const Outcome used = use();
  EXPECT_TRUE(used) << used.error().message;
  headset_->stop();
  renderer_.reset();
  const bool silent = !exists(file);
  EXPECT_TRUE(silent) << (silent ? "" : read_file(file));
  // negative control: the layer reports an error
  XrSystemGetInfo wrong{};
  wrong.type = XR_TYPE_SYSTEM_GET_INFO;
  wrong.formFactor = XrFormFactor(77);
  XrSystemId system = 0;
  EXPECT_TRUE(XR_FAILED(headset_->instance().dispatch().GetSystem(headset_->instance().handle(), &wrong, &system)));
  headset_.reset();
  ::unsetenv("XR_ENABLE_API_LAYERS");
  EXPECT_TRUE(exists(file) && read_file(file).find("VUID") != std::string::npos);
}

}  // namespace catena::test::session_test
