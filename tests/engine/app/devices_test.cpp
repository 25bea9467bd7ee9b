// SPDX-License-Identifier: MIT
/// The self-test of devices (device_check.h) on correct and faulty devices, and the command `catena devices`.
#include "engine/app/haptics/device_check.h"
#include "engine/base/json.h"
#include "haptics/device/device.h"
#include "haptics/device/registry.h"
#include "tests/engine/app/program_in_folder.h"
#include "tests/haptics/device/emulator/boot_image.h"

namespace catena::devices_test {

using namespace catena::app;
using haptics::DeviceInput;
using haptics::DeviceOutput;
using haptics::DeviceStatus;

/// A device with a force of at most 5 N.
struct CheckedDevice : haptics::Device {
  CheckedDevice() { able_.max_force_n = 5; }
  const haptics::DeviceCapabilities& capabilities() const override { return able_; }
  void write(const DeviceOutput&) noexcept override {}
  int reads = 0;

 private:
  haptics::DeviceCapabilities able_;
};

/// A device whose position is the compliance times the force; its faults begin at stated numbers of reads.
struct Springy final : CheckedDevice {
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
  int starts = 0, lost = 1 << 30, broken = 1 << 30;
  Vec3 force{0.0}, last{0.0};
  double strongest = 0, steepest = 0;
};

DeviceCheckResult check(haptics::Device& device, bool forces, double seconds = 0.5, std::vector<std::string>* prompts = nullptr) {
  DeviceCheckOptions options;
  options.seconds = seconds;
  options.forces = forces;
  if (prompts != nullptr) options.prompt = [&](const std::string& text) { prompts->push_back(text); };
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
struct Homing final : CheckedDevice {
  DeviceInput read() noexcept override {
    DeviceInput in;
    if (++reads <= 400) in.status = DeviceStatus::starting;
    return in;
  }
  std::string status_text() const override { return reads < 200 ? "pull it out" : reads < 400 ? "push it in" : ""; }
};

TEST(DeviceCheck, PromptsWithTheStatusOfADeviceThatIsNotReady) {
  Homing device;
  std::vector<std::string> prompts;
  EXPECT_EQ(check(device, false, 0.1, &prompts).failure, "");
  EXPECT_EQ(prompts, (std::vector<std::string>{"pull it out", "push it in"}));
}

// A device that enables forces late and whose hand moves until `rests`.
struct Arming final : CheckedDevice {
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
  int arms = 1500, rests = 2500, first_push = 0;
};

TEST(DeviceCheck, PushesOnlyOnceForcesAreEnabledAndTheGripRests) {
  std::vector<std::string> prompts;
  Arming device;
  EXPECT_EQ(check(device, true, 0.1, &prompts).failure, "");
  EXPECT_GE(device.first_push, 2500 - 20 + 500);  // 2 mm of rest are 20 ticks of this hand
  EXPECT_LE(device.first_push, 2510 + 500);
  ASSERT_EQ(prompts.size(), 2u);
  EXPECT_EQ(prompts[0], "pull it out once");
  EXPECT_NE(prompts[1].find("hold the grip still"), std::string::npos);

  Arming never, restless;
  never.arms = restless.rests = 1 << 30;
  EXPECT_NE(check(never, true, 0.1, &prompts).failure.find("has not enabled its forces after 20 s; pull it out once"), std::string::npos);
  EXPECT_NE(check(restless, true, 0.1, &prompts).failure.find("did not rest"), std::string::npos);
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

class Devices : public test::ProgramInFolder {
 protected:
  /// Tests a device. On a loaded machine the emulated Falcon may answer too late and count as lost: then it is tested again, twice at most.
  test::ProgramResult tested(const std::string& more) {
    const std::string line = "devices test --seconds 0.05 " + more;
    test::ProgramResult result = run(line);
    for (int k = 0; k < 2 && result.err.find("the device was lost") != std::string::npos; ++k) result = run(line);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  }
  /// The displacement in mm that the check reports under a force of 1 N along x.
  static double pushed_mm(const test::ProgramResult& run) {
    const std::string prefix = "force        +1.00 +0.00 +0.00 N moved the hand +";
    const auto at = run.out.find(prefix);
    EXPECT_NE(at, std::string::npos) << run.out;
    return at == std::string::npos ? 0 : std::stod(run.out.substr(at + prefix.size()));
  }
};

TEST_F(Devices, ListsTheDevices) {
  test::expect_parts(succeed("devices").out, {"simulated-6dof", "orientation, force up to"});
  const auto read = json::parse(run("devices --json").out, "out");
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

TEST_F(Devices, TestsTheSimulatedDevicesAndARecordedPath) {
  write("p.csv", "t,x,y,z,buttons\n-1,0,2,3,0\n0,1,2,3,0\n0.001,1.5,2,3,2\n");
  for (const char* name : {"null", "simulated", "recorded:{p.csv}"}) test::expect_parts(tested(name).out, {"pass (without forces"});
  test::expect_parts(tested("recorded:{p.csv}").out, {"x 1.00000 .. 1.50000", "buttons      2"});
}

TEST_F(Devices, PushesTheSimulatedHand) {
  const test::ProgramResult run = tested("simulated-6dof --forces");
  EXPECT_NEAR(pushed_mm(run), 2, 0.5) << run.out;  // mm: 1 N against a hand of 500 N/m
  test::expect_parts(run.out, {"\npass\n"});
}

TEST_F(Devices, PushesTheEmulatedFalconInAStillHand) {
  const test::ProgramResult run = tested("emulated-falcon:still --forces");
  test::expect_parts(run.err, {"pull the grip fully out"});
  EXPECT_NEAR(pushed_mm(run), 1000.0 / 300, 0.5) << run.out;  // mm: 1 N against a hand of 300 N/m
}

TEST_F(Devices, TheEmulatedFalconBootsAStatedFirmware) {
  const auto image = haptics::tests::boot_image({40, 3});
  const std::string bytes(image.begin(), image.end());
  write("good.bin", bytes);
  test::expect_parts(tested("emulated-falcon --firmware {good.bin}").err, {"firmware is being sent"});
  for (std::size_t size = 0; size < image.size(); size += 7) {
    write("bad.bin", bytes.substr(0, size));
    const test::ProgramResult bad = run("devices test emulated-falcon --seconds 0.05 --firmware {bad.bin}");
    EXPECT_NE(bad.exit_code, 0) << size;
    test::expect_parts(bad.err, {"bad.bin"});
    test::expect_one_line(bad.err);
  }
}

TEST_F(Devices, FailuresAreOneLine) {
  const struct {
    const char* line;
    int exit_code;
    const char* part;
  } kFailures[] = {{"sextant", 2, "simulated-6dof"},
                   {"null --seconds 0", 2, "--seconds"},
                   {"null --seconds 0.05 --forces", 1, "no force output"},
                   {"recorded", 1, "recorded:PATH.csv"},
                   {"mouse", 1, "catena view"},
                   {"simulated:", 1, "no detail after the colon"},
                   {"null:1", 1, "\"null\" was expected"},
                   {"emulated-falcon:stil", 1, "emulated-falcon:still"}};
  for (const auto& failure : kFailures) {
    SCOPED_TRACE(failure.line);
    const test::ProgramResult done = run("devices test " + std::string(failure.line));
    EXPECT_EQ(done.exit_code, failure.exit_code) << done.err;
    test::expect_parts(done.err, {failure.part});
    test::expect_one_line(done.err);
  }
}

}  // namespace catena::devices_test
