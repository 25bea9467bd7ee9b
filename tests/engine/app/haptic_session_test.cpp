// SPDX-License-Identifier: MIT
// The haptic session of the window, without a window: programs, devices and recordings change while the servo runs.
#include "engine/app/viewer/input/haptic_session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "engine/app/cli/command.h"
#include "engine/app/haptics/log_replay.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "tests/engine/app/open_scene_model.h"
#include "tests/support/support.h"

namespace catena::app {
namespace haptic_session_test {

constexpr const char* kScene = R"({
  "fields": {"ball": {"analytic": "sphere"}},
  "chain": [{"name": "lag", "type": "drag", "threshold": 0.3},
            {"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
  "workspace": {"metres_per_unit": 0.05}
})";

struct Rig {
  explicit Rig(HapticSession::Options options = {}, const std::string& text = kScene) : hand(quiet(std::move(options))) {
    test::open_scene(folder, text, host);
    bounds.extend(Vec3(-1.0));
    bounds.extend(Vec3(1.0));
  }
  static HapticSession::Options quiet(HapticSession::Options options) {
    options.realtime = {.fifo = false, .lock_memory = false, .cpu = haptics::RealtimeOptions::kUnbound};
    return options;
  }
  void start() {
    const Outcome opened = hand.open_device(host->scene());
    ASSERT_TRUE(opened) << opened.error().message;
    const Outcome prepared = hand.prepare(host->scene(), bounds, recorded());
    ASSERT_TRUE(prepared) << prepared.error().message;
    host->set_validator([this](scene::Scene& scene) { return hand.validate(scene); });
    EXPECT_TRUE(hand.start());
  }
  RecordedScene recorded() const { return {host->document().path(), host->document().text(), {}, scene_input_files(host->scene())}; }
  /// Applies an edit as the window does.
  void edit(const std::string& pointer, const std::string& value) {
    const Outcome done = host->set(pointer, value, "edit");
    ASSERT_TRUE(done) << done.error().message;
    const Outcome published = hand.publish(host->scene(), host->document().text());
    ASSERT_TRUE(published) << published.error().message;
  }
  bool until(const std::function<bool()>& true_now) {
    for (int k = 0; k < 20000; ++k) {
      hand.pull_state(host->scene());
      if (true_now()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  bool has_run() {
    return until([&] { return hand.latest_state().program_epoch == hand.program()->epoch; });
  }
  bool runs_on(std::uint64_t ticks) {
    const std::uint64_t from = hand.latest_state().tick;
    return until([&] { return hand.latest_state().tick >= from + ticks; });
  }

  test::TemporaryFolder folder;
  Bounds bounds;
  std::optional<SceneModel> host;
  HapticSession hand;
};

HapticSession::Options asking_for(const std::string& device) {
  HapticSession::Options options;
  options.device = device;
  return options;
}

TEST(HapticSession, AnEditKeepsTheStateOfTheOtherLinks) {
  Rig rig;
  rig.start();
  rig.hand.move_mouse(rig.host->scene(), Vec3(1, 0.5, 0.5), 0);
  ASSERT_TRUE(rig.until([&] { return norm(rig.hand.latest_state().probe - Vec3(1, 0.5, 0.5)) < 1e-12; }));
  ASSERT_TRUE(rig.runs_on(5));
  const Vec3 lag = rig.hand.latest_state().links[0].proxy;
  ASSERT_GT(norm(lag - rig.hand.latest_state().probe), 0.2) << "it is dragged behind";

  rig.edit("/chain/1/point", "[0, 0, 0.2]");
  ASSERT_TRUE(rig.has_run());
  EXPECT_NEAR(norm(rig.hand.latest_state().links[0].proxy - lag), 0, 1e-12);
  EXPECT_NEAR(rig.hand.latest_state().links[1].proxy.z, 0.2, 1e-9);

  // A disabled link follows the probe; the other link keeps its state.
  rig.edit("/chain/1/enabled", "false");
  ASSERT_TRUE(rig.has_run());
  EXPECT_NEAR(norm(rig.hand.latest_state().links[0].proxy - lag), 0, 1e-12);
  EXPECT_EQ(rig.hand.latest_state().links[1].status, LinkStatus::free);
  EXPECT_FALSE(rig.hand.latest_state().links[1].active);

  // An edit of a link's own keys resets the link at the hand.
  rig.edit("/chain/0/threshold", "0.31");
  ASSERT_TRUE(rig.has_run());
  EXPECT_LT(norm(rig.hand.latest_state().links[0].proxy - rig.hand.latest_state().probe), 0.1);

  EXPECT_FALSE(rig.host->set("/chain/0/threshold", "-1", "edit"));
  EXPECT_FALSE(rig.host->set("/chain/0/enabled", "3", "edit"));
}

TEST(HapticSession, ARecordingWithEditsReplaysBitExactly) {
  Rig rig;
  rig.start();
  rig.hand.move_mouse(rig.host->scene(), Vec3(1, 0.5, 0.5), 0);
  ASSERT_TRUE(rig.runs_on(80));
  const std::string path = rig.folder / "a.catlog";
  EXPECT_FALSE(rig.hand.record(rig.folder / "scene.json", rig.recorded())) << "not over an input";
  EXPECT_FALSE(rig.hand.recording().is_recording());
  rig.edit("/chain/1/normal", "[0, 1, 1]");  // an edit before the recording is in the document's text only
  const Outcome began = rig.hand.record(path, rig.recorded());
  ASSERT_TRUE(began) << began.error().message;
  ASSERT_TRUE(rig.runs_on(60));
  rig.hand.move_mouse(rig.host->scene(), Vec3(-1, 0.2, 0.1), 1);
  rig.edit("/chain/1/point", "[0, 0, 0.25]");
  ASSERT_TRUE(rig.runs_on(40));
  rig.edit("/chain/0/enabled", "false");
  ASSERT_TRUE(rig.runs_on(40));
  rig.edit("/chain/0/enabled", "true");
  rig.edit("/coupling/stiffness", "300");
  rig.edit("/chain/-", R"({"name": "skin", "type": "isosurface", "field": "ball", "level": 0.8})");
  ASSERT_TRUE(rig.runs_on(60));
  const Outcome ended = rig.hand.stop_recording();
  ASSERT_TRUE(ended) << ended.error().message;
  EXPECT_FALSE(rig.hand.recording().is_recording());
  ASSERT_TRUE(rig.runs_on(5)) << "the servo goes on";
  rig.hand.stop();

  ReplayOptions replay;
  replay.log = path;
  replay.stats = rig.folder / "stats.json";
  try {
    const Outcome same = replay_log_file(replay);
    ASSERT_TRUE(same) << same.error().message;
  } catch (const std::exception& failure) {
    FAIL() << failure.what();
  }
  EXPECT_EQ(test::read_file(replay.stats).find("\"ticks\": 0"), std::string::npos);
}

TEST(HapticSession, AFailedDeviceSwitchKeepsTheOldDevice) {
  Rig rig;
  rig.start();
  rig.hand.move_mouse(rig.host->scene(), Vec3(1, 0.5, 0.5), 0);
  ASSERT_TRUE(rig.runs_on(80));
  const double before = rig.host->scene().workspace.meters_per_unit;
  const Outcome none = rig.hand.switch_device(rig.host->scene(), "falcon:7", rig.bounds);
  EXPECT_FALSE(none);
  EXPECT_TRUE(rig.hand.is_mouse());
  ASSERT_TRUE(rig.runs_on(5));
  const std::uint64_t ticks = rig.hand.latest_state().tick;

  const Outcome done = rig.hand.switch_device(rig.host->scene(), "simulated", rig.bounds);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_FALSE(rig.hand.is_mouse());
  EXPECT_EQ(rig.hand.device_name(), "simulated");
  EXPECT_FALSE(rig.hand.forces_enabled()) << "off until the person turns them on";
  EXPECT_EQ(rig.host->scene().workspace.meters_per_unit, before) << "stated by the scene";
  ASSERT_TRUE(rig.has_run());
  EXPECT_GT(rig.hand.latest_state().tick, ticks) << "the chain goes on";
  EXPECT_EQ(norm(rig.hand.latest_state().force_n), 0);

  ASSERT_TRUE(rig.hand.switch_device(rig.host->scene(), "mouse", rig.bounds));
  EXPECT_TRUE(rig.hand.is_mouse());
  rig.hand.move_mouse(rig.host->scene(), Vec3(0.5, 0.5, 0.5), 0);
  EXPECT_TRUE(rig.until([&] { return norm(rig.hand.latest_state().probe - Vec3(0.5)) < 1e-9; }));
}

/// While the world moves, the force is zero even if forces are enabled, and stays zero until the servo runs the new program.
TEST(HapticSession, SuspendedForcesAreZeroAndRampUpWhenResumed) {
  Rig mouse;
  mouse.start();
  EXPECT_TRUE(mouse.hand.suspend_forces(true)) << "what cannot push is off already";
  mouse.hand.stop();

  test::TemporaryFolder folder;
  test::write_file(folder / "pressed.csv", "t,x,y,z,buttons\n0,0,0,-0.02,0\n");
  Rig rig(asking_for("simulated:" + (folder / "pressed.csv")));
  rig.start();
  HapticSession& hand = rig.hand;
  const auto pushes = [&] { return hand.latest_state().force_state == ForceState::on && norm(hand.latest_state().force_n) > 0.1; };
  hand.set_forces_enabled(true);
  ASSERT_TRUE(rig.until(pushes));
  const double pressed_n = norm(hand.latest_state().force_n);

  EXPECT_FALSE(hand.suspend_forces(true)) << "there is force still: the world must not move yet";
  EXPECT_TRUE(hand.forces_enabled()) << "what is wished stays";
  ASSERT_TRUE(rig.until([&] { return hand.suspend_forces(true); }));
  EXPECT_EQ(norm(hand.latest_state().force_n), 0);
  hand.set_forces_enabled(false);
  hand.set_forces_enabled(true);
  EXPECT_FALSE(hand.servo().forces_enabled()) << "a wish does not end it";
  ASSERT_TRUE(rig.runs_on(50));
  EXPECT_EQ(norm(hand.latest_state().force_n), 0);

  // The world has moved, and the servo does not report the new program yet.
  rig.edit("/chain/1/point", "[0, 0, 0.1]");
  EXPECT_FALSE(hand.suspend_forces(false));
  EXPECT_FALSE(hand.servo().forces_enabled());
  ASSERT_TRUE(rig.has_run());
  EXPECT_TRUE(hand.suspend_forces(false));
  EXPECT_TRUE(hand.servo().forces_enabled());
  double first_n = 0;
  ASSERT_TRUE(rig.until([&] {
    if (first_n == 0) first_n = norm(hand.latest_state().force_n);
    return pushes();
  }));
  EXPECT_LT(first_n, 0.8 * pressed_n) << "it rises";
}

TEST(HapticSession, ADeviceSwitchCompletesTheRecording) {
  Rig rig;
  rig.start();
  ASSERT_TRUE(rig.runs_on(20));
  const std::string path = rig.folder / "a.catlog";
  ASSERT_TRUE(rig.hand.record(path, rig.recorded()));
  ASSERT_TRUE(rig.runs_on(20));
  ASSERT_TRUE(rig.hand.switch_device(rig.host->scene(), "null", rig.bounds));
  EXPECT_FALSE(rig.hand.recording().is_recording());
  ReplayOptions replay;
  replay.log = path;
  EXPECT_NO_THROW(EXPECT_TRUE(replay_log_file(replay)));
}

TEST(HapticSession, AnAbsentDeviceLeavesTheMouseAndANotice) {
  Rig rig(asking_for("falcon:7"));
  rig.start();
  EXPECT_TRUE(rig.hand.is_mouse());
  EXPECT_NE(rig.hand.open_notice().find("the mouse moves the probe"), std::string::npos) << rig.hand.open_notice();
  Rig unknown(asking_for("sextant"));
  EXPECT_FALSE(unknown.hand.open_device(unknown.host->scene()));
  Rig file(asking_for("recorded:none.csv"));
  EXPECT_FALSE(file.hand.open_device(file.host->scene())) << "a file that is not there is no device that is not plugged in";
}

TEST(HapticSession, TheScenesDeviceIsTheDefault) {
  Rig named({}, R"({"device": {"type": "simulated"}})");
  named.start();
  EXPECT_TRUE(named.hand.is_mouse()) << "what is simulated would keep the hand off the probe";
  Rig wrong({}, R"({"device": {"type": "simulated", "max_force": "much"}})");
  EXPECT_FALSE(wrong.hand.open_device(wrong.host->scene()));
}

}  // namespace haptic_session_test
}  // namespace catena::app
