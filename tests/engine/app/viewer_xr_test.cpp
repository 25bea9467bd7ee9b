// SPDX-License-Identifier: MIT
// `catena view --xr` with the scripted runtime (tests/xr_runtime) on a virtual display; and controllers without a display.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "engine/app/haptics/device_file.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/xr/xr_controllers.h"
#include "engine/app/viewer/xr/xr_session.h"
#include "engine/base/clock.h"
#include "haptics/device/device_settings.h"
#include "tests/engine/app/open_scene_model.h"
#include "tests/engine/app/viewer_xr_fixture.h"
#include "tests/support/results.h"
#if __has_include(<openxr/openxr.h>)
#include "tests/render/xr/xr_fixture.h"
#endif

namespace catena::app::viewer_xr_test {

using test::has;
using viewer_xr_fixture::kScene;

class ViewerXr : public viewer_xr_fixture::ViewerXr {
 protected:
  /// The screenshot of the first eye: the sphere is straight ahead, and orange.
  void expect_orange_sphere() const {
    const render::Image8 eye = picture("eye.png");
    EXPECT_EQ(eye.width * 80, eye.height * 96);
    std::size_t orange = 0;
    for (std::size_t i = 0; i < eye.rgba.size(); i += 4) orange += eye.rgba[i] > eye.rgba[i + 2] + 40;
    EXPECT_GT(orange, eye.rgba.size() / 4 / 100);
  }
};

TEST_F(ViewerXr, BothEyesAreDrawnAndTheFirstIsMirroredInTheWindow) {
  ASSERT_EQ(run_view("--frames 8 --screenshot " + (folder_ / "eye.png"), "size=96x80"), 0) << log();
  EXPECT_GE(runtime_count("pictures"), 7);
  EXPECT_EQ(runtime_count("moved"), 0);
  expect_clean_runtime();
  EXPECT_TRUE(has(log(), "headset: "));
  EXPECT_EQ(headset_error_count(), 0) << log();
  expect_orange_sphere();
}

/// The world is placed in front of the head's position in the first frame, for any origin of the runtime's space.
TEST_F(ViewerXr, TheWorldIsPlacedInFrontOfTheHead) {
  ASSERT_EQ(run_view("--frames 4 --screenshot " + (folder_ / "eye.png"), "size=96x80 head=3:0.5:-2"), 0) << log();
  expect_orange_sphere();
}

TEST_F(ViewerXr, AMissingRuntimeIsOneErrorLine) {
  EXPECT_EQ(run_view("--frames 2", "", "/nowhere/runtime.json"), 1) << log();
  EXPECT_EQ(headset_error_count(), 1) << log();
  EXPECT_TRUE(has(log(), "expected an OpenXR runtime"));
}

/// The gaze is part of a recording, like the poses of head and hands.
TEST_F(ViewerXr, TheGazeIsRecorded) {
  const std::string log = folder_ / "hand.catlog", table = folder_ / "poses.csv";
  ASSERT_EQ(run_view("--frames 12 --record " + log, "size=32x32 gaze=0.25:-0.1"), 0) << this->log();
  test::run_ok({"export", log, "-o", folder_ / "ticks.csv", "--poses", table});
  const test::Table poses = test::Table::read(table);
  const auto value = [&](const char* name) { return poses.number(poses.rows() - 1, name); };
  const Vec3 ahead = rotate(Quat(value("gaze_qw"), value("gaze_qx"), value("gaze_qy"), value("gaze_qz")), Vec3(0.0, 0.0, -1.0));
  EXPECT_NEAR(ahead.x / -ahead.z, 0.25, 1e-4);
  EXPECT_NEAR(ahead.y / -ahead.z, -0.1, 1e-4);
}

/// The menu button shows the window in the room, as a quad layer.
TEST_F(ViewerXr, TheMenuButtonShowsTheWindowInTheRoom) {
  ASSERT_EQ(run_view("--frames 24", "size=48x40 menu=5:8"), 0) << log();
  EXPECT_GT(runtime_count("quads"), 0);
  expect_clean_runtime();
}

/// A running session that is not visible: --frames counts the window's frames.
TEST_F(ViewerXr, FramesAreCountedInAnInvisibleSession) {
  expect_legal_view("--frames 12", "size=32x32 state=4:VISIBLE state=4:SYNCHRONIZED");
  EXPECT_LE(runtime_count("pictures"), 4);
}

/// Invalid periods and sizes of a display, and options of flat images.
TEST_F(ViewerXr, InvalidDisplaysAndFlatImageOptionsDoNotBlock) {
  for (const char* words : {"size=32x32 period_ms=0", "size=0x0", "size=0x0 period_ms=0"}) {
    expect_legal_view("--frames 12", words);
    EXPECT_GE(runtime_count("pictures"), 11) << words;
    EXPECT_EQ(headset_error_count(), 0) << words << log();
  }
  std::string scene = kScene;
  scene.insert(scene.rfind('}'), R"(, "screens": [{"name": "front", "lower_left": [-2, 0, -1], "lower_right": [2, 0, -1],
                                                "upper_left": [-2, 0, 1]}])");
  test::write_file(folder_ / "scene.json", scene);
  for (const char* options : {"--frames 12 --screen front", "--frames 12 --stereo side-by-side"}) {
    expect_legal_view(options, "size=32x32");
    EXPECT_GE(runtime_count("pictures"), 11) << options;
  }
}

/// An unregistered device is requested on the terminal and on the panel in the room; the menu button dismisses the request.
TEST_F(ViewerXr, RegistrationOfADeskDeviceIsRequested) {
  ASSERT_EQ(run_view("--device simulated --frames 24", "size=48x40"), 0) << log();
  EXPECT_TRUE(has(log(), "Touch three points, not on one line, with the handle of simulated"));
  EXPECT_GT(runtime_count("quads"), 0);
  EXPECT_EQ(log().find("is not registered"), std::string::npos) << log();
  expect_legal_view("--device simulated --frames 24", "size=48x40 menu=6:8");
  EXPECT_TRUE(has(log(), "catena: simulated is not registered; press G, or use the panel Device"));
}

/// The controller and the simulated hand touch the same three points; the device file stores the registration and can be read again.
/// The device has the stage's orientation and its origin at (0.2, 0.1, -0.5) in stage space.
TEST_F(ViewerXr, TheRegistrationIsStoredInTheDeviceFile) {
  const std::array<Vec3, 3> touched{Vec3(0, 0, 0), Vec3(0.05, 0, 0), Vec3(0, 0.05, 0.01)};
  const Vec3 origin(0.2, 0.1, -0.5), stage(0.1, -1, 0.3);
  std::string path = "t,x,y,z,buttons\n", words = "size=16x16 stage=0.1:-1:0.3";
  for (std::size_t k = 0; k < touched.size(); ++k) {
    const Vec3 &p = touched[k], room = stage + origin + p;
    const double t = 1.5 + 0.8 * double(k);
    path += fmt::format("{0},{3},{4},{5},0\n{1},{3},{4},{5},1\n{2},{3},{4},{5},0\n", k == 0 ? 0 : t - 0.2, t, t + 0.4, p.x, p.y, p.z);
    words += fmt::format(" grip={}:{}:{}:{} select={}:{}", 10 + 40 * k, room.x, room.y, room.z, 15 + 40 * k, 35 + 40 * k);
  }
  test::write_file(folder_ / "path.csv", path);
  test::write_file(folder_ / "arm.json", "{\n  \"type\": \"simulated\",  // mine\n  \"friction\": 0\n}\n");
  const std::string device = "--device simulated:" + (folder_ / "path.csv") + " --device-file " + (folder_ / "arm.json");
  ASSERT_EQ(run_view(device + " --seconds 4.5", words), 0) << log();
  EXPECT_TRUE(has(log(), "is registered: the residual is 0."));
  EXPECT_TRUE(has(log(), "the registration was written to"));
  const std::string device_text = test::read_file(folder_ / "arm.json");
  EXPECT_TRUE(has(device_text, "// mine"));
  scene::Scene scene;
  ASSERT_TRUE(apply_device_file(folder_ / "arm.json", scene)) << device_text;
  const auto settings = haptics::read_device_settings(*scene.device, folder_ / "arm.json");
  ASSERT_TRUE(settings && settings->room_registration) << device_text;
  EXPECT_LT(norm(settings->room_registration->origin_m - origin), 1e-3) << device_text;
  for (int axis = 0; axis < 3; ++axis) EXPECT_GT(settings->room_registration->room_from_workspace[axis][axis], 0.999) << device_text;
  // With the device file, no registration is requested.
  ASSERT_EQ(run_view(device + " --frames 6", "size=16x16 stage=0.1:-1:0.3"), 0) << log();
  EXPECT_EQ(log().find("Touch three points"), std::string::npos) << log();
}

/// The device file states the registration: the device's origin is 0.2 m to the right of the stage's origin and 0.5 m in front.
TEST_F(ViewerXr, ARegisteredDeviceHasItsPositionInTheRoom) {
  test::write_file(folder_ / "arm.json", R"({"type": "simulated", "friction": 0, "room_origin": [0.2, 0, -0.5],
    "room_rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]})");
  ASSERT_EQ(run_view("--device simulated --device-file " + (folder_ / "arm.json") + " --seconds 2", "size=48x40 stage=0.1:-1:0.3"), 0)
      << log();
  EXPECT_EQ(log().find("Touch three points"), std::string::npos) << log();
  // The head, 2 cm above the room's origin and 1 cm behind, is at the camera; the room's z is the horizontal back of the view.
  const Vec3 camera(0, -6, 3), up(0, 0, 1), back = direction(Vec3(0, -6, 0)), right = cross(up, back);
  const double metres_per_unit = 0.7 / norm(camera);
  const Vec3 room(0.1 + 0.2, -1 - 0.02, 0.3 - 0.5 - 0.01);
  const Vec3 expected = camera + (right * room.x + up * room.y + back * room.z) / metres_per_unit;
  Vec3 probe(0.0);
  const std::string text = log();
  const std::size_t at = text.find("probe ");
  ASSERT_NE(at, std::string::npos) << text;
  ASSERT_EQ(std::sscanf(text.c_str() + at, "probe %lf %lf %lf", &probe.x, &probe.y, &probe.z), 3);
  EXPECT_LT(norm(probe - expected), 0.02) << text;
}

constexpr double kDt = 1.0 / 90;
const Vec3 kHead(0.0, 1.6, 0.0);

XrHand hand_at(const Vec3& position, double grab = 0) {
  XrHand hand;
  hand.is_tracked = true;
  hand.position_m = position;
  hand.squeeze = grab;
  return hand;
}

TEST(XrControllers, AGrabbedWorldFollowsTheHandAndTheProbeIsUntracked) {
  XrControllers hands;
  Placement placement;
  placement.meters_per_unit = 0.1;
  const Vec3 from(0.2, 1.0, -0.5), to(0.4, 1.1, -0.3);
  const Vec3 held = placement.to_world(from);
  hands.update({XrHand{}, hand_at(from)}, kHead, kDt, placement);
  EXPECT_TRUE(hands.make_controller_pose(hand_at(from), 1).tracked);
  hands.update({XrHand{}, hand_at(from, 1)}, kHead, kDt, placement);
  EXPECT_TRUE(hands.is_grabbing_world());
  EXPECT_FALSE(hands.make_controller_pose(hand_at(from, 1), 2).tracked);
  hands.update({XrHand{}, hand_at(to, 0.5)}, kHead, kDt, placement);  // between the thresholds of grab and release: still grabbed
  EXPECT_LT(norm(placement.to_room(held) - to), 1e-12);
  EXPECT_GT(hands.vignette_strength(), 0);
  hands.update({XrHand{}, hand_at(to, 0.3)}, kHead, kDt, placement);
  EXPECT_FALSE(hands.is_grabbing_world());
  EXPECT_TRUE(hands.make_controller_pose(hand_at(to), 3).tracked);
  hands.update({XrHand{}, hand_at(from)}, kHead, kDt, placement);
  EXPECT_LT(norm(placement.to_room(held) - to), 1e-12);  // the world was released
}

TEST(XrControllers, ALostHandDoesNotMoveTheGrabbedWorld) {
  XrControllers hands;
  Placement placement;
  placement.meters_per_unit = 0.1;
  const Vec3 left(-0.2, 1.0, -0.5), right(0.2, 1.0, -0.5), middle = placement.to_world((left + right) / 2.0);
  const auto stays = [&] { return norm(placement.to_room(middle) - (left + right) / 2.0) < 1e-12 && placement.meters_per_unit == 0.1; };
  for (int k = 0; k < 3; ++k) hands.update({hand_at(left, 1), hand_at(right, 1)}, kHead, kDt, placement);
  // The state of an untracked hand: an invalid pose, and the last button.
  XrHand lost = hand_at(Vec3(std::nan("")), 1);
  lost.orientation = Quat(std::nan(""), 0.0, 0.0, 0.0);
  lost.is_tracked = false;
  hands.update({lost, hand_at(right, 1)}, kHead, kDt, placement);
  EXPECT_TRUE(stays());
  EXPECT_TRUE(hands.is_grabbing_world());
  hands.update({lost, lost}, kHead, kDt, placement);
  EXPECT_TRUE(stays());
  EXPECT_FALSE(hands.is_grabbing_world());
  EXPECT_FALSE(hands.grab_center({lost, lost}));
  EXPECT_FALSE(hands.make_controller_pose(lost, 1).tracked);
  // A hand that is tracked again elsewhere and still squeezes grabs there.
  hands.update({hand_at(left + Vec3(1, 1, 1), 1), lost}, kHead, kDt, placement);
  EXPECT_TRUE(stays());
  EXPECT_TRUE(hands.is_grabbing_world());
}

TEST(XrControllers, TheStickTurnsTheWorldInTheOppositeDirection) {
  XrControllers hands;
  Placement placement;
  const Vec3 ahead = placement.to_world(kHead + Vec3(0.0, 0.0, -1.0));
  XrHand right = hand_at({0.2, 1.0, -0.3});
  right.stick_x = -1;  // to the left
  hands.update({XrHand{}, right}, kHead, kDt, placement);
  const Vec3 now = placement.to_room(ahead) - kHead;
  EXPECT_GT(now.x, 0.1);  // the point ahead is now to the right
  EXPECT_NEAR(now.y, 0, 1e-12);
  EXPECT_EQ(hands.vignette_strength(), 0);  // a snap turn is no continuous motion
}

TEST(XrControllers, AVibrationStopsWhenFocusIsLost) {
  XrControllers hands;
  haptics::PeakDetector peaks;
  const XrHand hand = hand_at({0.0, 1.0, -0.3});
  using What = haptics::VibrationSender::Action;
  std::int64_t now = 1'000'000;
  const auto push = [&](double n) {
    haptics::ForceSample tick;
    tick.requested_force_n = {n, 0.0, 0.0};
    peaks.add(tick);
  };
  (void)hands.next_vibration(peaks, now, true, hand);
  push(0);
  push(1.5);
  const auto sent = hands.next_vibration(peaks, now += 11'000'000, true, hand);
  EXPECT_EQ(sent.action, What::vibrate);
  EXPECT_GT(sent.vibration.amplitude, 0.5);
  push(0);
  EXPECT_EQ(hands.next_vibration(peaks, now += 11'000'000, false, hand).action, What::stop);
  push(1.5);
  EXPECT_EQ(hands.next_vibration(peaks, now += 11'000'000, false, hand).action, What::nothing);
}

#if __has_include(<openxr/openxr.h>)

/// A scripted clock in milliseconds, and a hand that moves one unit per millisecond, so that its position states its time. The runtime's
/// wait and the creation of a packet take scripted times; the window's loop samples the hand before both.
struct LateHand {
  double now_ms = 0;
  double wait_ms(std::uint64_t frame) const { return 4 + double(frame % 6); }
  double packet_ms() const { return 1.5; }
  Vec3 place() const { return Vec3(now_ms, 0, 0); }
};

class LateLatching : public test::WindowTest {};

/// The child process of TheProbeIsNewerByTheWaitAndThePacket, on a display of its own.
TEST_F(LateLatching, DISABLED_Child) {
  const std::string result = test::child_variable("CATENA_LATCHING");
  if (result.empty()) GTEST_SKIP() << "it is run by the case after it";
  test::xr_rig::Runtime runtime;
  ASSERT_TRUE(runtime.found());
  runtime.script().width = runtime.script().height = 16;
  LateHand hand;
  runtime.script().on_frame = [&](std::uint64_t frame, test::xr_runtime::Script&) { hand.now_ms += hand.wait_ms(frame); };
  auto window = test::value_of(Window::create(64, 64, "latching"));
  auto headset = test::value_of(HeadsetSession::open());
  Presenter::Options options;
  headset->configure(options);
  auto screen = test::value_of(Presenter::open(*window, options));
  std::optional<SceneModel> host;
  test::open_scene(folder_, kScene, host);
  HapticSession holder(HapticSession::Options{});
  ASSERT_TRUE(holder.open_device(host->scene()));

  Vec3 looked_at(0.0);
  std::vector<double> late_ms, early_ms;  // age of the drawn hand per eye, with and without late latching
  HeadsetSession::FrameCallbacks content;
  content.make_packet = [&]() -> Result<render::FramePacket> {
    render::FramePacket packet = test::xr_rig::ball_packet({0.0, 0.0, -1.0}, 0.3);
    render::CursorItem& cursor = packet.cursors.emplace_back();
    cursor.probe = looked_at;
    cursor.radius = 0.1;
    hand.now_ms += hand.packet_ms();
    return packet;
  };
  content.late_latch = [&](render::FramePacket& packet) { packet.cursors[0].probe = hand.place(); };
  content.apply_view = [&](const render::View&, render::FramePacket& packet) {
    late_ms.push_back(hand.now_ms - packet.cursors[0].probe.x);
    early_ms.push_back(hand.now_ms - looked_at.x);
  };
  content.classify_rays = [](const render::FramePacket&) { return render::QualityLevelOptions{}; };
  for (int k = 0; k < 200 && late_ms.size() < 120; ++k) {
    looked_at = hand.place();
    ASSERT_TRUE(headset->poll(*screen, now_ns(), [](const std::string&) {}));
    if (!headset->is_running()) continue;
    const auto drawn = headset->draw(*screen, holder, content);
    ASSERT_TRUE(drawn) << drawn.error().message;
  }
  ASSERT_EQ(late_ms.size(), 120u) << "two eyes, sixty pictures";
  EXPECT_EQ(*std::ranges::max_element(late_ms), 0) << "each eye shows the hand as it is when its picture is drawn";
  double gain = 0;
  for (std::size_t k = 0; k < late_ms.size(); ++k) gain += (early_ms[k] - late_ms[k]) / double(late_ms.size());
  test::write_file(result, fmt::format("{}", gain));
  headset->request_exit();
}

/// The drawn hand is newer by the wait for the frame (4 to 9 ms) and the creation of the packet (1.5 ms).
TEST_F(LateLatching, TheProbeIsNewerByTheWaitAndThePacket) {
  if (!test::exists(test::binary_dir() + "/libcatena_xr_runtime.so")) GTEST_SKIP() << "the scripted runtime was not built";
  if (!test::can_drive_windows()) GTEST_SKIP() << "there is no virtual display";
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  ASSERT_EQ(run_logged("env -u GTEST_TOTAL_SHARDS -u GTEST_SHARD_INDEX HOME=" + folder_.path() + " CATENA_LATCHING=" + (folder_ / "gain") +
                       " timeout 60 " + test::on_display("320x240") + self +
                       " --gtest_filter=LateLatching.DISABLED_Child --gtest_also_run_disabled_tests"),
            0)
      << log();
  EXPECT_NEAR(std::stod(test::read_file(folder_ / "gain")), 6.5 + 1.5, 0.1) << "milliseconds";
}

#endif

}  // namespace catena::app::viewer_xr_test
