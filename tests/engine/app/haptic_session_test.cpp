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
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::app::haptic_session_test {

using test::value_of;

constexpr const char* kScene = R"({
  "fields": {"ball": {"analytic": "sphere"}},
  "chain": [{"name": "lag", "type": "drag", "threshold": 0.3},
            {"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
  "workspace": {"metres_per_unit": 0.05}
})";

struct Rig {
  explicit Rig(const std::string& device = "", const std::string& text = kScene) : hand(test::quiet_session(device)) {
    test::open_scene(folder, text, host);
  }
  void start() {
    value_of(hand.open_device(host->scene()));
    value_of(hand.prepare(host->scene(), bounds, recorded()));
    host->set_validator([this](scene::Scene& scene) { return hand.validate(scene); });
    EXPECT_TRUE(hand.start());
  }
  RecordedScene recorded() const { return {host->document().path(), host->document().text(), {}, scene_input_files(host->scene())}; }
  /// Applies an edit as the window does.
  void edit(const std::string& pointer, const std::string& value) {
    value_of(host->set(pointer, value, "edit"));
    value_of(hand.publish(host->scene(), host->document().text()));
  }
  void move_to(const Vec3& probe, unsigned buttons = 0) { hand.move_mouse(host->scene(), probe, buttons); }
  bool probe_is_at(const Vec3& probe) {
    return until([&] { return norm(hand.latest_state().probe - probe) < 1e-12; });
  }
  Outcome switch_device(const std::string& name) { return hand.switch_device(host->scene(), name, bounds); }
  double force_n() const { return norm(hand.latest_state().force_n); }
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
  Bounds bounds = test::cube_bounds();
  std::optional<SceneModel> host;
  HapticSession hand;
};

/// Replays the recording; each tick must be bit-identical.
void expect_replays(const std::string& log, const std::string& stats = "") {
  ReplayOptions replay;
  replay.log = log;
  replay.stats = stats;
  value_of(replay_log_file(replay));
}

TEST(HapticSession, AnEditKeepsTheStateOfTheOtherLinks) {
  Rig rig;
  rig.start();
  rig.move_to(Vec3(1, 0.5, 0.5));
  ASSERT_TRUE(rig.probe_is_at(Vec3(1, 0.5, 0.5)));
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
  rig.move_to(Vec3(1, 0.5, 0.5));
  ASSERT_TRUE(rig.runs_on(80));
  const std::string path = rig.folder / "a.catlog";
  EXPECT_FALSE(rig.hand.record(rig.folder / "scene.json", rig.recorded())) << "not over an input";
  EXPECT_FALSE(rig.hand.recording().is_recording());
  rig.edit("/chain/1/normal", "[0, 1, 1]");  // an edit before the recording is in the document's text only
  value_of(rig.hand.record(path, rig.recorded()));
  ASSERT_TRUE(rig.runs_on(60));
  rig.move_to(Vec3(-1, 0.2, 0.1), 1);
  rig.edit("/chain/1/point", "[0, 0, 0.25]");
  ASSERT_TRUE(rig.runs_on(40));
  rig.edit("/chain/0/enabled", "false");
  ASSERT_TRUE(rig.runs_on(40));
  rig.edit("/chain/0/enabled", "true");
  rig.edit("/coupling/stiffness", "300");
  rig.edit("/chain/-", R"({"name": "skin", "type": "isosurface", "field": "ball", "level": 0.8})");
  ASSERT_TRUE(rig.runs_on(60));
  value_of(rig.hand.stop_recording());
  EXPECT_FALSE(rig.hand.recording().is_recording());
  ASSERT_TRUE(rig.runs_on(5)) << "the servo goes on";
  rig.hand.stop();

  expect_replays(path, rig.folder / "stats.json");
  EXPECT_EQ(test::read_file(rig.folder / "stats.json").find("\"ticks\": 0"), std::string::npos);
}

TEST(HapticSession, AFailedDeviceSwitchKeepsTheOldDevice) {
  Rig rig;
  rig.start();
  rig.move_to(Vec3(1, 0.5, 0.5));
  ASSERT_TRUE(rig.runs_on(80));
  const double before = rig.host->scene().workspace.meters_per_unit;
  EXPECT_FALSE(rig.switch_device("falcon:7"));
  EXPECT_TRUE(rig.hand.is_mouse());
  ASSERT_TRUE(rig.runs_on(5));
  const std::uint64_t ticks = rig.hand.latest_state().tick;

  value_of(rig.switch_device("simulated"));
  EXPECT_FALSE(rig.hand.is_mouse());
  EXPECT_EQ(rig.hand.device_name(), "simulated");
  EXPECT_FALSE(rig.hand.forces_enabled()) << "off until the person turns them on";
  EXPECT_EQ(rig.host->scene().workspace.meters_per_unit, before) << "stated by the scene";
  ASSERT_TRUE(rig.has_run());
  EXPECT_GT(rig.hand.latest_state().tick, ticks) << "the chain goes on";
  EXPECT_EQ(rig.force_n(), 0);

  value_of(rig.switch_device("mouse"));
  EXPECT_TRUE(rig.hand.is_mouse());
  rig.move_to(Vec3(0.5, 0.5, 0.5));
  EXPECT_TRUE(rig.probe_is_at(Vec3(0.5)));
}

/// While the world moves, the force is zero even if forces are enabled, and stays zero until the servo runs the new program.
TEST(HapticSession, SuspendedForcesAreZeroAndRampUpWhenResumed) {
  Rig mouse;
  mouse.start();
  EXPECT_TRUE(mouse.hand.suspend_forces(true)) << "what cannot push is off already";
  mouse.hand.stop();

  test::TemporaryFolder folder;
  test::write_file(folder / "pressed.csv", "t,x,y,z,buttons\n0,0,0,-0.02,0\n");
  Rig rig("simulated:" + (folder / "pressed.csv"));
  rig.start();
  HapticSession& hand = rig.hand;
  const auto pushes = [&] { return hand.latest_state().force_state == ForceState::on && rig.force_n() > 0.1; };
  hand.set_forces_enabled(true);
  ASSERT_TRUE(rig.until(pushes));
  const double pressed_n = rig.force_n();

  EXPECT_FALSE(hand.suspend_forces(true)) << "there is force still: the world must not move yet";
  EXPECT_TRUE(hand.forces_enabled()) << "what is wished stays";
  ASSERT_TRUE(rig.until([&] { return hand.suspend_forces(true); }));
  EXPECT_EQ(rig.force_n(), 0);
  hand.set_forces_enabled(false);
  hand.set_forces_enabled(true);
  EXPECT_FALSE(hand.servo().forces_enabled()) << "a wish does not end it";
  ASSERT_TRUE(rig.runs_on(50));
  EXPECT_EQ(rig.force_n(), 0);

  // The world has moved, and the servo does not report the new program yet.
  rig.edit("/chain/1/point", "[0, 0, 0.1]");
  EXPECT_FALSE(hand.suspend_forces(false));
  EXPECT_FALSE(hand.servo().forces_enabled());
  ASSERT_TRUE(rig.has_run());
  EXPECT_TRUE(hand.suspend_forces(false));
  EXPECT_TRUE(hand.servo().forces_enabled());
  double first_n = 0;
  ASSERT_TRUE(rig.until([&] {
    if (first_n == 0) first_n = rig.force_n();
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
  value_of(rig.switch_device("null"));
  EXPECT_FALSE(rig.hand.recording().is_recording());
  expect_replays(path);
}

TEST(HapticSession, AnAbsentDeviceLeavesTheMouseAndANotice) {
  Rig rig("falcon:7");
  rig.start();
  EXPECT_TRUE(rig.hand.is_mouse());
  EXPECT_TRUE(test::has(rig.hand.open_notice(), "the mouse moves the probe"));
  Rig unknown("sextant");
  EXPECT_FALSE(unknown.hand.open_device(unknown.host->scene()));
  Rig file("recorded:none.csv");
  EXPECT_FALSE(file.hand.open_device(file.host->scene())) << "a file that is not there is no device that is not plugged in";
}

TEST(HapticSession, TheScenesDeviceIsTheDefault) {
  Rig named("", R"({"device": {"type": "simulated"}})");
  named.start();
  EXPECT_TRUE(named.hand.is_mouse()) << "what is simulated would keep the hand off the probe";
  Rig wrong("", R"({"device": {"type": "simulated", "max_force": "much"}})");
  EXPECT_FALSE(wrong.hand.open_device(wrong.host->scene()));
}

}  // namespace catena::app::haptic_session_test
