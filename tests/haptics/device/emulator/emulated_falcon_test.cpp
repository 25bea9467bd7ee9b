// SPDX-License-Identifier: MIT
/// The emulated Falcon byte by byte, without libusb: the protocol's golden vectors, the boot ROM, homing, faults.
#include "haptics/device/emulator/emulated_falcon.h"

#include <gtest/gtest.h>

#include "tests/haptics/device/emulator/boot_image.h"

namespace catena::haptics::emulated_falcon_test {

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

struct Rig {
  explicit Rig(const EmulatedFalconOptions& options = {}) : device(options) { device.control({0x40, 3, kBaudRunning, 0}); }
  void send(const std::vector<std::uint8_t>& bytes) { device.bulk_out(bytes); }
  void send(const std::string& text) { send(bytes_of(text)); }
  /// Payload of the next packet.
  std::string receive() {
    std::uint8_t packet[64];
    const std::size_t n = device.bulk_in(packet);
    EXPECT_EQ(packet[0], 0x01);
    return {packet + 2, packet + n};
  }
  /// Payload of the packet that answers a command; empty if there is none.
  std::string reply_to(const std::string& command) {
    send(command);
    return device.has_payload() ? receive() : "";
  }
  void reset_processor() {
    device.control({0x40, 3, kBaud9600, 0});
    device.control({0x40, 1, 0x0100, 0});
    device.control({0x40, 1, 0x0101, 0});
  }
  void wake() {
    reset_processor();
    EXPECT_EQ(reply_to("\x0A\x43\x0D"), "\x0A\x44\x2C\x0D");
    device.control({0x40, 1, 0x0100, 0});
    device.control({0x40, 3, kBaudBoot, 0});
    EXPECT_EQ(reply_to("A"), "A");
  }
  EmulatedFalcon device;
};

const std::string kRest = "<AAAAAAAAAAAAAA>";
const EmulatedFalconOptions kCold{.firmware = false};

TEST(EmulatedFalcon, EncodersAreSentLowNibbleFirst) {
  // at rest at z = 0.11 the encoders are near -516
  const int near = static_cast<int>(std::lround(angles_to_counts(solve_delta_legs({0, 0, 0.11})->theta).x));
  Rig exact({.power_on_offset = {-1447 - near, -near, 1 - near}});
  EXPECT_EQ(exact.reply_to(kRest), "<JFKPAAAABAAAAA>");
  EXPECT_EQ(exact.device.last_exchange().encoders, (EmulatedMechanism::Counts{-1447, 0, 1}));
}

TEST(EmulatedFalcon, MotorCountsAndLightsAreDecodedAndGiveAForce) {
  Rig rig;
  rig.device.mechanism().hold({0, 0, 0.11});
  // 0xFF0E = -242 is the nibbles E 0 F F; control 0x04: blue
  rig.send("<OAPPOAPPOAPPEAA>");  // one byte too many: not a frame
  rig.send("<OAPPOAPPOAPPEA>");
  EXPECT_EQ(rig.device.frames(), 1u);
  EXPECT_EQ(rig.device.last_exchange().motors, (EmulatedMechanism::Counts{-242, -242, -242}));
  EXPECT_EQ(rig.device.last_exchange().control, 4u);
  EXPECT_NEAR(rig.device.last_exchange().force_n.z, 1.0, 1e-2);
  EXPECT_EQ(rig.device.bad_bytes(), 17u);
}

TEST(EmulatedFalcon, AFrameMayArriveInPiecesAndAfterNoise) {
  Rig rig;
  rig.send("xx<AAA");
  rig.send(kRest.substr(4));
  EXPECT_EQ(rig.device.frames(), 1u);
  rig.send("<AAA" + kRest + kRest);
  EXPECT_EQ(rig.device.frames(), 3u);
  EXPECT_EQ(rig.device.bad_bytes(), 2u + 4u);
}

TEST(EmulatedFalcon, AtAWrongBaudRateCommandsAreIgnored) {
  Rig rig;
  rig.device.control({0x40, 3, kBaud9600, 0});
  EXPECT_EQ(rig.reply_to(kRest), "");
  EXPECT_EQ(rig.device.frames(), 0u);
  rig.device.faults().garbage_at_wrong_baud = true;
  EXPECT_NE(rig.reply_to(kRest), "");
  EXPECT_EQ(rig.device.frames(), 0u);
}

TEST(EmulatedFalcon, UnknownRequestsAreRefused) {
  Rig rig;
  EXPECT_TRUE(rig.device.control({0x40, 9, 1, 0}));
  EXPECT_EQ(rig.device.latency_ms(), 1);
  EXPECT_FALSE(rig.device.control({0x40, 9, 0, 0}));
  EXPECT_FALSE(rig.device.control({0x40, 77, 0, 0}));
  EXPECT_FALSE(rig.device.control({0xC0, 9, 1, 0}));
  EXPECT_FALSE(rig.device.control({0x40, 3, 7, 0}));
  EXPECT_FALSE(rig.device.control({0x40, 9, 1, 1}));
}

TEST(EmulatedFalcon, BootsAWholeImageAndStartsIt) {
  Rig rig(kCold);
  rig.send(kRest);
  EXPECT_EQ(rig.device.frames(), 0u);
  rig.wake();
  const auto image = tests::boot_image({100, 7});
  for (std::size_t at = 0; at < image.size(); at += 62) {
    const std::vector<std::uint8_t> chunk(image.begin() + static_cast<std::ptrdiff_t>(at),
                                          image.begin() + static_cast<std::ptrdiff_t>(std::min(at + 62, image.size())));
    EXPECT_FALSE(rig.device.running());
    EXPECT_EQ(bytes_of(rig.reply_to({chunk.begin(), chunk.end()})), chunk);
  }
  EXPECT_EQ(rig.device.boot_rom().image_bytes(), image.size());
  EXPECT_TRUE(rig.device.running());
  rig.device.control({0x40, 3, kBaudRunning, 0});
  rig.send(kRest);
  EXPECT_EQ(rig.device.frames(), 1u);
}

TEST(EmulatedFalcon, ADamagedOrWrongImageNeverStarts) {
  const auto image = tests::boot_image({20});
  Rig rig(kCold);
  rig.device.boot_rom().faults().echo_errors = {30};
  rig.wake();
  rig.send(image);
  std::string echo;
  while (rig.device.has_payload()) echo += rig.receive();
  ASSERT_EQ(echo.size(), image.size());
  EXPECT_NE(static_cast<std::uint8_t>(echo[30]), image[30]);
  EXPECT_FALSE(rig.device.running());
  // a complete image after a reset
  rig.wake();
  rig.send(image);
  EXPECT_TRUE(rig.device.running());
  EXPECT_EQ(rig.device.boot_rom().attempts(), 2);

  Rig other(kCold);
  other.wake();
  auto wrong = image;
  wrong[0] = 0xAB;
  other.send(wrong);
  EXPECT_FALSE(other.device.running());
}

TEST(EmulatedFalcon, HandshakesMayBeIgnoredOrStartWithAZero) {
  Rig rig(kCold);
  rig.device.boot_rom().faults() = {.ignored_handshakes = 2, .leading_zero = true, .echo_errors = {}};
  rig.reset_processor();
  for (int i = 0; i < 2; ++i) EXPECT_EQ(rig.reply_to("\x0A\x43\x0D"), "");
  EXPECT_EQ(rig.reply_to("\x0A\x43\x0D"), std::string("\0\x0A\x44\x2C\x0D", 5));
}

TEST(EmulatedFalcon, AnAxisHomesOnItsReturnAndItsOriginJumps) {
  Rig rig;
  const auto at = [&](double z, const std::string& frame) {
    EXPECT_TRUE(rig.device.mechanism().hold({0, 0, z}));
    rig.reply_to(frame);
    return rig.device.last_exchange();
  };
  const std::string homing = "<AAAAAAAAAAAABA>";
  EXPECT_EQ(at(0.11, homing).homed, 0u);
  EXPECT_EQ(at(0.175, homing).homed, 0u);
  EXPECT_EQ(at(0.15, kRest).homed, 0u);  // homing was not requested
  at(0.175, homing);
  const auto homed = at(0.15, homing);
  EXPECT_EQ(homed.homed, 7u);
  EXPECT_EQ(homed.encoders, (EmulatedMechanism::Counts{336, 336, 336}));
  EXPECT_EQ(at(0.11, kRest).homed, 7u);
  // after a loss of power the origin is lost
  rig.device.unplug();
  rig.device.plug(false);
  EXPECT_EQ(rig.device.mechanism().homed_bits(), 0u);
  EXPECT_FALSE(rig.device.running());
}

TEST(EmulatedFalcon, ButtonsAndHomedBitsShareAByte) {
  Rig rig({.homed = true});
  rig.device.mechanism().hold_buttons(15);
  EXPECT_EQ(static_cast<std::uint8_t>(rig.reply_to(kRest)[13]), 0x41 + 0x7F);
}

TEST(EmulatedFalcon, ReplyFaultsSplitJoinTruncateDropAndAddGarbage) {
  using Kind = ReplyFault::Kind;
  Rig rig;
  rig.device.faults().replies = {{Kind::split, 5},    {Kind::join, 0}, {Kind::none, 0},
                                 {Kind::truncate, 9}, {Kind::drop, 0}, {Kind::garbage, 4}};
  rig.send(kRest);
  const std::string head = rig.receive(), tail = rig.receive();
  EXPECT_EQ(head.size(), 5u);
  EXPECT_EQ(tail.size(), 11u);
  EXPECT_EQ(rig.reply_to(kRest), "");
  EXPECT_EQ(rig.reply_to(kRest), head + tail + head + tail);
  EXPECT_EQ(rig.reply_to(kRest), (head + tail).substr(0, 9));
  EXPECT_EQ(rig.reply_to(kRest), "");
  EXPECT_EQ(rig.reply_to(kRest).substr(4), head + tail);
  rig.device.faults().silent = true;
  EXPECT_EQ(rig.reply_to(kRest), "");
}

TEST(EmulatedFalcon, AHostThatDoesNotReadLosesReplies) {
  Rig rig;
  for (int i = 0; i < 20; ++i) rig.send(kRest);
  EXPECT_EQ(rig.device.overruns(), 4u);  // 256 bytes hold 16
  rig.device.control({0x40, 0, 1, 0});
  EXPECT_FALSE(rig.device.has_payload());
}

TEST(EmulatedFalcon, UnplugsAfterTheGivenNumberOfBytes) {
  Rig rig;
  rig.device.faults().unplug_after_out_bytes = 20;
  rig.send(kRest);
  EXPECT_TRUE(rig.device.plugged());
  rig.send(kRest);
  EXPECT_FALSE(rig.device.plugged());
  EXPECT_EQ(rig.device.frames(), 1u);
}

TEST(EmulatedFalcon, AnEmulatedHandMovesTheGripAndYieldsToTheMotors) {
  EmulatedUser hand;
  hand.path = {{0, {0, 0, 0.11}, 0}, {0.1, {0.01, 0, 0.11}, 1}};
  Rig free, pushed;
  free.device.mechanism().attach_user(hand);
  pushed.device.mechanism().attach_user(hand);
  for (int i = 0; i < 1000; ++i) {
    free.reply_to(kRest);
    pushed.reply_to("<OAPPOAPPOAPPAA>");  // about +1 N along z
  }
  EXPECT_NEAR(free.device.mechanism().position_m().x, 0.01, 1e-6);
  EXPECT_EQ(free.device.mechanism().buttons(), 1u);
  EXPECT_NEAR(pushed.device.mechanism().position_m().z, 0.11 + 1.0 / hand.stiffness_n_per_m, 1e-4);
}

}  // namespace catena::haptics::emulated_falcon_test
