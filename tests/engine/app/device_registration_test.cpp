// SPDX-License-Identifier: MIT
// Registration of a haptic device on the desk to a headset's room: known touches, the known answer, and the effects of recentering.
#include "engine/app/viewer/xr/device_registration.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "engine/app/haptics/device_file.h"
#include "engine/base/json.h"
#include "tests/engine/app/open_scene_model.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::app::device_registration_test {

using test::fails;
using test::value_of;

const std::array<Vec3, 3> kTouched{Vec3(0.02, -0.03, 0.01), Vec3(-0.05, 0.01, 0.04), Vec3(0.01, 0.05, 0.02)};
const Quat kTurn = rotation_from_vector({0.2, -1.4, 0.5});
const Vec3 kOrigin(0.3, 0.8, -0.5);  // the device's origin in stage space
const StageSpace kStage{{0.1, -1.5, 0.7}, rotation_from_vector({0.0, 0.6, 0.0}), true, 0};
const std::string kScene = R"({ "fields": {"ball": {"analytic": "sphere"}},
  "chain": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
  "device": {"type": "simulated", "friction": 0, "encoder_step": 0},
  "workspace": {"metres_per_unit": 0.05, "origin": [1, 2, 3]} })";

/// A rig whose simulated hand touches the points, half a second each.
struct Rig {
  explicit Rig(const std::string& device, const std::string& text = kScene) {
    std::string path = "t,x,y,z,buttons\n";
    double at_s = 0;
    for (const Vec3& p : kTouched)
      for (const int buttons : {0, 1, 0}) {
        path += fmt::format("{},{},{},{},{}\n", at_s, p.x, p.y, p.z, buttons);
        at_s += buttons == 1 ? 0.5 : 0.3;
      }
    test::write_file(folder / "path.csv", path);
    test::open_scene(folder, text, host);
    hand.emplace(test::quiet_session(device == "simulated" ? "simulated:" + (folder / "path.csv") : device));
    EXPECT_TRUE(hand->open_device(host->scene()));
    EXPECT_TRUE(hand->prepare(host->scene(), test::cube_bounds(), RecordedScene{folder / "scene.json", text, {}, {}}));
    EXPECT_TRUE(hand->start());
  }
  /// Steps the session, some milliseconds apart, until the condition holds.
  bool until(const std::function<bool()>& true_now, const StageSpace& space, const std::function<XrHand()>& right) {
    for (int k = 0; k < 5000; ++k) {
      hand->pull_state(host->scene());
      desk.step(t += 0.02, *hand, {XrHand{}, right()}, space);
      for (const DeviceRegistration::Message& news : desk.take_messages()) messages.push_back(news.text);
      if (true_now()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }
  /// Touches with the controller the points that the device will touch.
  void touch_with_controller(const StageSpace& space) {
    for (const Vec3& p : kTouched) {
      const Vec3 stage = kOrigin + rotate(kTurn, p);
      XrHand right;
      right.is_tracked = true;
      right.position_m = space.position_m + rotate(space.orientation, stage);
      int steps = 0;
      EXPECT_TRUE(until([&] { return ++steps > 20; }, space,
                        [&] {
                          right.select = steps > 2 && steps < 15 ? 1 : 0;
                          return right;
                        }));
    }
  }
  bool finds(const StageSpace& space) {
    touch_with_controller(space);
    return until([&] { return hand->room().has_value(); }, space, [] { return XrHand{}; });
  }
  void step_once(const StageSpace& space) {
    EXPECT_TRUE(until([] { return true; }, space, [] { return XrHand{}; }));
  }

  test::TemporaryFolder folder;
  std::optional<SceneModel> host;
  std::optional<HapticSession> hand;
  DeviceRegistration desk;
  double t = 5;
  std::vector<std::string> messages;
};

TEST(DeviceRegistration, FindsThePoseFromTheTouchedPoints) {
  Rig rig("simulated");
  ASSERT_TRUE(rig.finds(kStage)) << (rig.messages.empty() ? "" : rig.messages.back());
  ASSERT_EQ(rig.messages.size(), 8u);
  EXPECT_TRUE(test::has(rig.messages.front(), "Touch three points"));
  EXPECT_TRUE(test::has(rig.messages.back(), "is registered"));
  const DeviceRegistration::Room room = *rig.hand->room();
  EXPECT_LT(norm(room.origin_m - kOrigin), 5e-4);
  EXPECT_LT(norm(room.room_from_workspace * Vec3(0, 0, 1) - rotate(kTurn, {0, 0, 1})), 5e-3);
  EXPECT_FALSE(rig.desk.is_active());
  EXPECT_EQ(rig.desk.take_registration().value().origin_m, room.origin_m);
  EXPECT_FALSE(rig.desk.take_registration());

  // The device's workspace in the world follows the placement of the world in the room.
  Placement placement;
  placement.world_from_room = glm::mat3_cast(rotation_from_vector({0.0, 0.9, 0.0}));
  placement.world_origin = Vec3(3, -1, 2);
  placement.meters_per_unit = 0.2;
  const auto workspace = [&] { return rig.desk.workspace(*rig.hand, placement).value(); };
  const auto first = workspace();
  const Vec3 world = first.origin + first.rotation * kTouched[1] / first.meters_per_unit;
  const Vec3 in_room = kStage.position_m + rotate(kStage.orientation, kOrigin + rotate(kTurn, kTouched[1]));
  EXPECT_LT(norm(world - placement.to_world(in_room)), 1e-3 / 0.2);

  // After recentering, the stage has another pose in local space, and the device moves with it.
  StageSpace moved = kStage;
  moved.position_m += Vec3(0.5, 0, 0);
  moved.recenter_count = 1;
  rig.step_once(moved);
  EXPECT_LT(norm(workspace().origin - first.origin - placement.world_from_room * Vec3(0.5, 0, 0) / 0.2), 1e-9);
  EXPECT_TRUE(rig.hand->room());
  // Jitter of the stage does not move the device.
  const Vec3 before = workspace().origin;
  moved.position_m += Vec3(0, 5e-4, 0);
  rig.step_once(moved);
  EXPECT_EQ(workspace().origin, before);
}

TEST(DeviceRegistration, WithoutAStageItIsValidUntilRecentring) {
  Rig rig("simulated");
  const StageSpace local;
  ASSERT_TRUE(rig.finds(local)) << (rig.messages.empty() ? "" : rig.messages.back());
  EXPECT_FALSE(rig.desk.take_registration());
  StageSpace recentred = local;
  recentred.recenter_count = 1;
  rig.step_once(recentred);
  EXPECT_FALSE(rig.hand->room());
  EXPECT_TRUE(rig.desk.is_active());
}

TEST(DeviceRegistration, OnlyDevicesWithAFixedPositionCanBeRegistered) {
  const auto refused = [](const std::string& device, const std::string& text, const char* words) {
    Rig rig(device, text);
    EXPECT_TRUE(fails(rig.desk.begin(*rig.hand), words));
  };
  refused("null", kScene, "null has no fixed position in the room");
  std::string scaled = kScene;
  scaled.replace(scaled.find("\"friction\""), 0, "\"scale\": 2, ");
  refused("simulated", scaled, "a device with \"scale\" cannot be registered");
}

TEST(DeviceRegistration, IsStoredInTheDeviceFile) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "arm.json";
  scene::Scene scene;
  EXPECT_TRUE(apply_device_file(file, scene));  // the file does not exist yet
  EXPECT_FALSE(scene.device);
  test::write_file(file, "// mine\n{\n  \"type\": \"simulated\",\n  \"mass\": 0.2\n}\n");
  ASSERT_TRUE(write_device_file(file, {{"/room_origin", "[0.3, 0.8, -0.5]"}, {"/room_rotation", "[[0, -1, 0], [1, 0, 0], [0, 0, 1]]"}}));
  EXPECT_TRUE(test::read_file(file).starts_with("// mine\n"));
  ASSERT_TRUE(apply_device_file(file, scene));
  const auto settings = value_of(haptics::read_device_settings(*scene.device, file));
  EXPECT_EQ(settings.mass_kg, 0.2);
  ASSERT_TRUE(settings.room_registration);
  EXPECT_EQ(settings.room_registration->origin_m, Vec3(0.3, 0.8, -0.5));
  EXPECT_EQ(settings.room_registration->room_from_workspace * Vec3(1, 0, 0), Vec3(0, 1, 0));

  const auto bad = [&](const std::string& text, const std::string& words) {
    test::write_file(file, text);
    EXPECT_TRUE(fails(apply_device_file(file, scene), words)) << text;
  };
  bad(R"({"type": "simulated", "room_origin": [0, 0, 0]})", "arm.json:1: \"room_origin\" and \"room_rotation\" go together");
  bad(R"({"type": "simulated", "room_origin": [0, 1e9, 0], "room_rotation": [1,0,0,0,1,0,0,0,1]})", "up to 1000");
  bad(R"({"type": "simulated", "room_origin": [0, 0, 0], "room_rotation": [1,0,0,0,1,0,0,0,2]})", "orthonormal");
  bad(R"({"type": "sim", "mass": 1})", "there is no device type \"sim\"");
  bad(R"([1, 2])", "expected");
}

}  // namespace catena::app::device_registration_test
