// SPDX-License-Identifier: MIT
/// The self-test of devices (device_check.h) on correct and faulty devices, and the command `catena devices`.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/app/haptics/device_check.h"
#include "engine/base/json.h"
#include "haptics/device/device.h"
#include "haptics/device/registry.h"
#include "tests/haptics/device/emulator/boot_image.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace devices_test {

using namespace catena;
using namespace catena::app;
using haptics::DeviceInput;
using haptics::DeviceOutput;
using haptics::DeviceStatus;

/// A device whose position is the compliance times the force; its faults begin at stated numbers of reads.
class Springy final : public haptics::Device {
 public:
  Springy() { able_.max_force_n = 5; }
  const haptics::DeviceCapabilities& capabilities() const override { return able_; }
  DeviceInput read() noexcept override {
    ++reads;
    DeviceInput in;
    in.position_m = {0.01 + compliance * force.x, compliance * force.y, compliance * force.z};
    if (noise > 0) in.position_m.y += reads % 2 == 0 ? noise : -noise;
    if (reads <= starts) in.status = DeviceStatus::starting;
    if (reads >= lost) in.status = DeviceStatus::lost;
    if (reads >= broken) in.position_m.x = std::nan("");
    in.buttons = reads > 20 && reads < 30 ? 5 : 0;
    in.age_s = 0.002;
    return in;
  }
  void write(const DeviceOutput& out) noexcept override {
    force = out.force_n;
    strongest = std::max(strongest, norm(force));
    steepest = std::max(steepest, norm(force - last));
    last = force;
  }

  double compliance = 0.002, noise = 0;
  int starts = 0, lost = 1 << 30, broken = 1 << 30, reads = 0;
  Vec3 force{0.0}, last{0.0};
  double strongest = 0, steepest = 0;

 private:
  haptics::DeviceCapabilities able_;
};

DeviceCheckResult check(haptics::Device& device, bool forces, double seconds = 0.5) {
  DeviceCheckOptions options;
  options.seconds = seconds;
  options.forces = forces;
  return check_device(device, options, make_immediate_schedule(options.rate_hz));
}

TEST(DeviceCheck, WithoutForcesItOnlyReads) {
  Springy device;
  device.noise = 1e-5;
  device.starts = 100;
  const DeviceCheckResult out = check(device, false);
  EXPECT_EQ(out.failure, "");
  EXPECT_EQ(device.strongest, 0);
  EXPECT_NEAR(out.ready_after_s, 0.1, 1e-12);
  EXPECT_EQ(out.read_count, 500u);
  EXPECT_NEAR(out.rate_hz(), 1000, 1e-6);
  EXPECT_NEAR(out.jitter_m, 2e-5 / std::sqrt(1.5), 1e-9);  // x_k - mean of neighbours = 2 a
  EXPECT_NEAR(out.max_m.y - out.min_m.y, 2e-5, 1e-12);
  EXPECT_NEAR(out.mean_age_s, 0.002, 1e-12);
  EXPECT_EQ(out.buttons, 0u);
  Springy other;
  EXPECT_EQ(check(other, false).buttons, 5u);
}

TEST(DeviceCheck, PushesAreSmallRampedAndReported) {
  Springy device;
  const DeviceCheckResult out = check(device, true);
  ASSERT_EQ(out.failure, "");
  ASSERT_EQ(out.pushes.size(), 6u);
  EXPECT_NEAR(device.strongest, 1, 1e-12);
  EXPECT_LE(device.steepest, 1.0 / 200 + 1e-12);
  for (const PushResult& push : out.pushes) EXPECT_LE(norm(push.displacement_m - 0.002 * push.requested_n), 1e-12);
  EXPECT_EQ(device.force, Vec3(0.0));
}

TEST(DeviceCheck, AHandThatMovesTooFarEndsTheCheckAtOnce) {
  Springy device;
  device.compliance = 0.05;
  const DeviceCheckResult out = check(device, true);
  EXPECT_NE(out.failure.find("under a force of"), std::string::npos) << out.failure;
  EXPECT_NE(out.failure.find("+x"), std::string::npos) << out.failure;
  EXPECT_LE(device.strongest, 0.41);  // 0.02 m at 0.4 N
  EXPECT_EQ(device.force, Vec3(0.0));
  EXPECT_TRUE(out.pushes.empty());
}

TEST(DeviceCheck, AForceInTheWrongDirectionIsFound) {
  Springy device;
  device.compliance = -0.002;
  EXPECT_NE(check(device, true).failure.find("axes or signs"), std::string::npos);
}

TEST(DeviceCheck, LossAndInvalidPositionsAreFailuresWithZeroForce) {
  for (const int when : {50, 900, 1300}) {
    Springy lost, broken, fallen;
    lost.lost = broken.broken = when;
    const DeviceCheckResult a = check(lost, true), b = check(broken, true);
    EXPECT_NE(a.failure.find("lost"), std::string::npos) << a.failure;
    EXPECT_NE(b.failure.find("the pose is not finite"), std::string::npos) << b.failure;
    EXPECT_EQ(lost.force, Vec3(0.0));
    EXPECT_EQ(broken.force, Vec3(0.0));
    EXPECT_LE(lost.reads, when);
  }
}

TEST(DeviceCheck, TheWaitForAReadyDeviceIsLimited) {
  Springy device;
  device.starts = 1 << 30;
  const DeviceCheckResult out = check(device, false);
  EXPECT_NE(out.failure.find("not ready after 20 s"), std::string::npos) << out.failure;
  EXPECT_EQ(out.read_count, 0u);
}

// A device that is not ready for a while and states the reason.
class Homing final : public haptics::Device {
 public:
  const haptics::DeviceCapabilities& capabilities() const override { return able_; }
  DeviceInput read() noexcept override {
    DeviceInput in;
    if (++reads <= 400) in.status = DeviceStatus::starting;
    return in;
  }
  void write(const DeviceOutput&) noexcept override {}
  std::string status_text() const override { return reads < 200 ? "pull it out" : reads < 400 ? "push it in" : ""; }
  int reads = 0;

 private:
  haptics::DeviceCapabilities able_;
};

TEST(DeviceCheck, PromptsWithTheStatusOfADeviceThatIsNotReady) {
  Homing device;
  std::vector<std::string> prompts;
  DeviceCheckOptions options;
  options.seconds = 0.1;
  options.prompt = [&](const std::string& text) { prompts.push_back(text); };
  EXPECT_EQ(check_device(device, options, make_immediate_schedule(options.rate_hz)).failure, "");
  EXPECT_EQ(prompts, (std::vector<std::string>{"pull it out", "push it in"}));
}

// A device that enables forces late and whose hand moves until `rests`.
class Arming final : public haptics::Device {
 public:
  Arming() { able_.max_force_n = 5; }
  const haptics::DeviceCapabilities& capabilities() const override { return able_; }
  DeviceInput read() noexcept override {
    DeviceInput in;
    in.position_m.z = 1e-4 * std::min(++reads, rests);
    in.forces_on = reads > arms;
    return in;
  }
  void write(const DeviceOutput& out) noexcept override {
    if (norm(out.force_n) > 0 && first_push == 0) first_push = reads;
  }
  std::string status_text() const override { return reads > arms ? "" : "pull it out once"; }
  int reads = 0, arms = 1500, rests = 2500, first_push = 0;

 private:
  haptics::DeviceCapabilities able_;
};

TEST(DeviceCheck, PushesOnlyOnceForcesAreEnabledAndTheGripRests) {
  const auto run = [](Arming& device, std::vector<std::string>& prompts) {
    DeviceCheckOptions options;
    options.seconds = 0.1;
    options.forces = true;
    options.prompt = [&](const std::string& text) { prompts.push_back(text); };
    return check_device(device, options, make_immediate_schedule(options.rate_hz));
  };
  std::vector<std::string> prompts;
  Arming device;
  EXPECT_EQ(run(device, prompts).failure, "");
  EXPECT_GE(device.first_push, 2500 - 20 + 500);  // 2 mm of rest are 20 ticks of this hand
  EXPECT_LE(device.first_push, 2510 + 500);
  ASSERT_EQ(prompts.size(), 2u);
  EXPECT_EQ(prompts[0], "pull it out once");
  EXPECT_NE(prompts[1].find("hold the grip still"), std::string::npos);

  Arming never, restless;
  never.arms = restless.rests = 1 << 30;
  EXPECT_NE(run(never, prompts).failure.find("has not enabled its forces after 20 s; pull it out once"), std::string::npos);
  EXPECT_NE(run(restless, prompts).failure.find("did not rest"), std::string::npos);
  EXPECT_EQ(never.first_push + restless.first_push, 0);
}

TEST(DeviceCheck, StopsWhenAsked) {
  Springy device;
  std::atomic<bool> stop{false};
  DeviceCheckOptions options;
  options.forces = true;
  options.stop = &stop;
  const DeviceCheckResult out = check_device(device, options, [&](std::uint64_t k) {
    if (k == 2800) stop = true;
    return 1e-3 * static_cast<double>(k);
  });
  EXPECT_EQ(out.failure, "stopped by the user");
  EXPECT_EQ(device.force, Vec3(0.0));
  EXPECT_LE(device.reads, 2801);
  EXPECT_GT(device.strongest, 0) << "it was pushing";
}

TEST(DeviceCheck, ADeviceWithoutForceCannotPush) {
  haptics::NullDevice device;
  EXPECT_EQ(check(device, false).failure, "");
  EXPECT_NE(check(device, true).failure.find("no force output"), std::string::npos);
}

test::ProgramResult devices(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "devices");
  return test::run_catena(arguments);
}

TEST(Devices, ListsTheDevices) {
  const test::ProgramResult plain = devices({}), json = devices({"--json"});
  EXPECT_EQ(plain.exit_code, 0);
  EXPECT_NE(plain.out.find("simulated-6dof"), std::string::npos);
  EXPECT_NE(plain.out.find("orientation, force up to"), std::string::npos);
  const auto read = json::parse(json.out, "out");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_GE(read->items.size(), 6u);
  bool found = false;
  for (const json::Node& item : read->items) {
    for (const char* key : {"name", "present", "detail", "position", "orientation", "max_force_n", "max_torque_nm", "buttons", "open"})
      EXPECT_NE(item.find(key), nullptr) << key;
    found = found || (item.find("name")->string == "simulated-6dof" && item.find("orientation")->boolean);
  }
  EXPECT_TRUE(found);
}

TEST(Devices, TestsTheSimulatedDevicesAndARecordedPath) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "p.csv", "t,x,y,z,buttons\n-1,0,2,3,0\n0,1,2,3,0\n0.001,1.5,2,3,2\n");
  for (const std::string& name : {std::string("null"), std::string("simulated"), "recorded:" + (folder / "p.csv")}) {
    const test::ProgramResult run = devices({"test", name, "--seconds", "0.05"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("pass (without forces"), std::string::npos) << run.out;
  }
  const test::ProgramResult recorded = devices({"test", "recorded:" + (folder / "p.csv"), "--seconds", "0.05"});
  EXPECT_NE(recorded.out.find("x 1.00000 .. 1.50000"), std::string::npos) << recorded.out;
  EXPECT_NE(recorded.out.find("buttons      2"), std::string::npos) << recorded.out;
}

TEST(Devices, PushesTheSimulatedHand) {
  const test::ProgramResult run = devices({"test", "simulated-6dof", "--seconds", "0.05", "--forces"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::string prefix = "force        +1.00 +0.00 +0.00 N moved the hand +";
  const auto at = run.out.find(prefix);
  ASSERT_NE(at, std::string::npos) << run.out;
  EXPECT_NEAR(std::stod(run.out.substr(at + prefix.size())), 2, 0.5) << run.out;  // mm: 1 N against a hand of 500 N/m
  EXPECT_NE(run.out.find("\npass\n"), std::string::npos) << run.out;
}

TEST(Devices, PushesTheEmulatedFalconInAStillHand) {
  const test::ProgramResult run = devices({"test", "emulated-falcon:still", "--seconds", "0.05", "--forces"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("pull the grip fully out"), std::string::npos) << run.err;
  const std::string prefix = "force        +1.00 +0.00 +0.00 N moved the hand +";
  const auto at = run.out.find(prefix);
  ASSERT_NE(at, std::string::npos) << run.out;
  EXPECT_NEAR(std::stod(run.out.substr(at + prefix.size())), 1000.0 / 300, 0.5) << run.out;  // mm: 1 N against a hand of 300 N/m
}

TEST(Devices, TheEmulatedFalconBootsAStatedFirmware) {
  const test::TemporaryFolder folder;
  const auto image = haptics::tests::boot_image({40, 3});
  test::write_file(folder / "good.bin", std::string(image.begin(), image.end()));
  const test::ProgramResult good = devices({"test", "emulated-falcon", "--seconds", "0.05", "--firmware", folder / "good.bin"});
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_NE(good.err.find("firmware is being sent"), std::string::npos) << good.err;
  for (std::size_t size = 0; size < image.size(); size += 7) {
    test::write_file(folder / "bad.bin", std::string(image.begin(), image.begin() + static_cast<std::ptrdiff_t>(size)));
    const test::ProgramResult bad = devices({"test", "emulated-falcon", "--seconds", "0.05", "--firmware", folder / "bad.bin"});
    EXPECT_NE(bad.exit_code, 0) << size;
    EXPECT_NE(bad.err.find("bad.bin"), std::string::npos) << bad.err;
    EXPECT_EQ(std::count(bad.err.begin(), bad.err.end(), '\n'), 1) << bad.err;
  }
}

TEST(Devices, FailuresAreOneLine) {
  const auto expect = [](const test::ProgramResult& run, int code, const char* part) {
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  };
  expect(devices({"test", "sextant"}), 2, "simulated-6dof");
  expect(devices({"test", "null", "--seconds", "0"}), 2, "--seconds");
  expect(devices({"test", "null", "--seconds", "0.05", "--forces"}), 1, "no force output");
  expect(devices({"test", "recorded"}), 1, "recorded:PATH.csv");
  expect(devices({"test", "mouse"}), 1, "catena view");
  expect(devices({"test", "simulated:"}), 1, "no detail after the colon");
  expect(devices({"test", "null:1"}), 1, "\"null\" was expected");
  expect(devices({"test", "emulated-falcon:stil"}), 1, "emulated-falcon:still");
}

}  // namespace devices_test
