// SPDX-License-Identifier: MIT
/// The SpaceMouse through the real libspnav, against an emulated daemon.
#include "haptics/device/spacemouse.h"

#include <gtest/gtest.h>
#include <spnav.h>

#include <future>

#include "haptics/device/registry.h"
#include "tests/haptics/device/spacemouse_daemon.h"
#include "tests/haptics/device/wait_until.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::haptics::spacemouse_test {
using test::SpaceMouseDaemon;

/// Reads until `seen` returns true.
template <class F>
bool eventually(Device& device, const F& seen) {
  return test::wait_until([&] { return seen(device.read()); });
}

struct Rig {
  test::TemporaryFolder folder;
  std::unique_ptr<SpaceMouseDaemon> daemon = std::make_unique<SpaceMouseDaemon>(folder / "spnav.sock");
  std::unique_ptr<Device> device;
  explicit Rig(bool newer = true) {
    auto greeted = std::async(std::launch::async, [&] { return daemon->accept_client(newer); });
    auto opened = open_device("spacemouse", {});
    EXPECT_TRUE(greeted.get());
    device = test::value_of(std::move(opened));
  }
};

TEST(SpaceMouse, RatesHaveADeadZoneAndEndAtFullDeflection) {
  const SpaceMouseParameters parameters{.dead_zone_counts = 50};
  SpaceMouseCounts counts;
  counts.axes = {50, -200, 350, -50, 51, -9999};
  const SpaceMouseRates rates = compute_spacemouse_rates(counts, parameters);
  EXPECT_EQ(rates.velocity_m_per_s.x, 0);
  EXPECT_DOUBLE_EQ(rates.velocity_m_per_s.y, -0.5 * parameters.speed_m_per_s);
  EXPECT_DOUBLE_EQ(rates.velocity_m_per_s.z, -parameters.speed_m_per_s);
  EXPECT_EQ(rates.turn_rad_per_s.x, 0);
  EXPECT_DOUBLE_EQ(rates.turn_rad_per_s.y, parameters.turn_rad_per_s / 300);
  EXPECT_DOUBLE_EQ(rates.turn_rad_per_s.z, parameters.turn_rad_per_s);  // clamped, and converted to right-handed axes
}

TEST(SpaceMouse, AxesMatchTheLibrarysObjectMotion) {
  const SpaceMouseParameters parameters{.dead_zone_counts = 0};
  for (int axis = 0; axis < 6; ++axis) {
    spnav_event event{};
    event.type = SPNAV_EVENT_MOTION;
    event.motion.data = &event.motion.x;
    event.motion.data[axis] = 100;
    spnav_posrot library{};
    spnav_posrot_init(&library);
    spnav_posrot_moveobj(&library, &event.motion);
    SpaceMouseCounts counts;
    counts.axes[static_cast<std::size_t>(axis)] = 100;
    const SpaceMouseRates rates = compute_spacemouse_rates(counts, parameters);
    const Vec3 moved(library.pos[0], library.pos[1], library.pos[2]);
    const Vec3 turned = rotation_vector(Quat(library.rot[3], library.rot[0], library.rot[1], library.rot[2]));
    EXPECT_LE(norm(direction(rates.velocity_m_per_s) - direction(moved)), 1e-6) << axis;
    EXPECT_LE(norm(direction(rates.turn_rad_per_s) - direction(turned)), 1e-6) << axis;
  }
}

TEST(SpaceMouse, WithoutADaemonTheErrorNamesTheRemedy) {
  unsetenv("SPNAV_SOCKET");
  if (SpaceMouse::is_daemon_available()) GTEST_SKIP() << "a spacenavd runs on this machine";
  EXPECT_EQ(test::message_of(open_device("spacemouse", {})), "spacenavd is not running: install and start it (apt install spacenavd)");
}

TEST(SpaceMouse, ControlsRatesThroughTheLibrary) {
  for (const bool newer : {true, false}) {
    Rig rig(newer);
    EXPECT_EQ(rig.device->read().position_m, Vec3(0.0));
    ASSERT_TRUE(rig.daemon->send_packet({SpaceMouseDaemon::motion, 350, 0, 0, 0, 0, 350, 16}));
    ASSERT_TRUE(rig.daemon->send_packet({SpaceMouseDaemon::press, 1, 0, 0, 0, 0, 0, 0}));
    ASSERT_TRUE(eventually(*rig.device, [](const DeviceInput& in) { return in.buttons == 2; }));
    // full deflection: 0.1 m/s and -1.5 rad/s about z, per tick
    const DeviceInput a = rig.device->read(), b = rig.device->read();
    EXPECT_NEAR(b.position_m.x - a.position_m.x, 1e-4, 1e-15);
    const Vec3 turn = rotation_vector(b.orientation * glm::conjugate(a.orientation));
    EXPECT_NEAR(turn.z, -1.5e-3, 1e-12);
    // the position is clamped to the workspace
    for (int k = 0; k < 3000; ++k) rig.device->read();
    EXPECT_EQ(rig.device->read().position_m, Vec3(0.1, 0, 0));
    ASSERT_TRUE(rig.daemon->send_packet({SpaceMouseDaemon::motion, 0, 0, 0, 0, 0, 0, 16}));
    ASSERT_TRUE(rig.daemon->send_packet({SpaceMouseDaemon::release, 1, 0, 0, 0, 0, 0, 0}));
    ASSERT_TRUE(eventually(*rig.device, [](const DeviceInput& in) { return in.buttons == 0; }));
    const Quat rest = rig.device->read().orientation;
    EXPECT_EQ(rig.device->read().orientation, rest);
  }
}

TEST(SpaceMouse, ASplitPacketIsReassembledAndAnUnknownOneIgnored) {
  Rig rig;
  ASSERT_TRUE(rig.daemon->send_packet({77, 1, 2, 3, 4, 5, 6, 7}));
  const std::array<std::int32_t, 8> right = {SpaceMouseDaemon::motion, 350, 0, 0, 0, 0, 0, 16};
  ASSERT_TRUE(rig.daemon->send_packet(right, 0, 9));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(rig.device->read().position_m, Vec3(0.0));
  ASSERT_TRUE(rig.daemon->send_packet(right, 9, 23));
  EXPECT_TRUE(eventually(*rig.device, [](const DeviceInput& in) { return in.position_m.x > 1e-4; }));
  // the device is unplugged from the daemon: its last deflection is reset
  ASSERT_TRUE(rig.daemon->send_packet({SpaceMouseDaemon::device, 1, 0, 0, 0, 0, 0, 0}));
  double last = -1;
  EXPECT_TRUE(eventually(*rig.device, [&](const DeviceInput& in) { return std::exchange(last, in.position_m.x) == in.position_m.x; }));
}

TEST(SpaceMouse, ALostDaemonIsReportedAndReconnected) {
  Rig rig;
  ASSERT_TRUE(rig.daemon->send_packet({SpaceMouseDaemon::motion, 350, 0, 0, 0, 0, 0, 16}));
  ASSERT_TRUE(eventually(*rig.device, [](const DeviceInput& in) { return in.position_m.x > 0.01; }));
  const std::string path = rig.folder / "spnav.sock";
  rig.daemon.reset();
  ASSERT_TRUE(eventually(*rig.device, [](const DeviceInput& in) { return in.status == DeviceStatus::lost; }));
  const Vec3 rest = rig.device->read().position_m;
  EXPECT_EQ(rig.device->read().position_m, rest);

  rig.daemon = std::make_unique<SpaceMouseDaemon>(path);
  ASSERT_TRUE(rig.daemon->is_listening());
  ASSERT_TRUE(rig.daemon->accept_client(true));
  ASSERT_TRUE(eventually(*rig.device, [](const DeviceInput& in) { return in.status == DeviceStatus::ready; }));
  EXPECT_EQ(rig.device->read().position_m, rest);  // the last deflection is reset
  ASSERT_TRUE(rig.daemon->send_packet({SpaceMouseDaemon::motion, -350, 0, 0, 0, 0, 0, 16}));
  EXPECT_TRUE(eventually(*rig.device, [&](const DeviceInput& in) { return in.position_m.x < rest.x; }));
}

TEST(SpaceMouse, ASecondDeviceIsRefused) {
  Rig rig;
  EXPECT_NE(open_device("spacemouse", {}).error().message.find("already in use"), std::string::npos);
}

}  // namespace catena::haptics::spacemouse_test
