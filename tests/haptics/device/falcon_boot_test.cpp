// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_boot.h"

#include <gtest/gtest.h>

#include "tests/haptics/device/fake_falcon.h"
#include "tests/support/results.h"

namespace catena::haptics::usb::falcon_boot_test {

using test::Bytes;
using Controls = std::vector<std::pair<int, int>>;

struct FalconBoot : testing::Test {
  std::shared_ptr<test::FakeFalcon> fake = std::make_shared<test::FakeFalcon>();
  test::FakeTransport transport{fake};
  FtdiCounters counters;
  Ftdi ftdi{transport, counters};
  FalconBootOptions options;
  std::atomic<std::uint64_t> uploads{0};
  Bytes image = test::make_boot_image();

  FalconBoot() { fake->image = image; }
  std::string boot() { return catena::test::message_of(falcon_boot(ftdi, image, options, &uploads)); }
};

TEST_F(FalconBoot, RunningFirmwareIsNotReloaded) {
  fake->firmware_is_running = true;
  EXPECT_EQ(boot(), "");
  EXPECT_EQ(fake->handshake_count, 0);
  EXPECT_EQ(uploads, 0u);
  EXPECT_EQ(fake->controls, (Controls{{0, 1}, {0, 2}, {9, 1}, {3, 2}, {0, 1}, {0, 2}}));
  EXPECT_EQ(fake->last().motors, FalconCounts{});
}

TEST_F(FalconBoot, TheWholeImageIsSentInTheExpectedSteps) {
  EXPECT_EQ(boot(), "");
  EXPECT_EQ(fake->received, image);
  EXPECT_EQ(uploads, 1u);
  const Controls run{{0, 1}, {0, 2}, {9, 1}, {3, 2}, {0, 1}, {0, 2}};
  Controls expected = run;
  expected.insert(expected.end(),
                  {{0, 1}, {0, 2}, {9, 16}, {3, 0x4138}, {4, 8}, {2, 0}, {1, 0x200}, {1, 0x100}, {1, 0x101}, {1, 0x100}, {3, 0x15}});
  expected.insert(expected.end(), run.begin(), run.end());
  EXPECT_EQ(fake->controls, expected);
}

TEST_F(FalconBoot, WithoutFirmwareTheErrorNamesTheOption) {
  image.clear();
  const std::string message = boot();
  for (const char* part : {"--firmware FILE", "\"firmware\"", "may not distribute"}) EXPECT_TRUE(catena::test::has(message, part));
  EXPECT_EQ(fake->handshake_count, 0);
}

TEST_F(FalconBoot, AReplyWithALeadingZeroIsAccepted) {
  fake->handshake_reply = {0x00, 0x0A, 0x44, 0x2C, 0x0D};
  EXPECT_EQ(boot(), "");
  EXPECT_EQ(fake->handshake_count, 1);
}

TEST_F(FalconBoot, AReplyInSingleBytesIsAccepted) {
  fake->packet_sizes = {1, 0, 2, 1, 0, 0, 3};
  EXPECT_EQ(boot(), "");
  EXPECT_EQ(fake->received, image);
}

TEST_F(FalconBoot, AWrongReplyIsRejected) {
  fake->handshake_reply = {0x0A, 0x44, 0x2D, 0x0D};
  EXPECT_NE(boot().find("did not answer 100 handshakes"), std::string::npos);
  EXPECT_EQ(fake->handshake_count, 200);
  EXPECT_EQ(fake->upload_count, 0);
}

TEST_F(FalconBoot, TheHundredthHandshakeIsAccepted) {
  fake->ignored_handshakes = 99;
  EXPECT_EQ(boot(), "");
  EXPECT_EQ(fake->handshake_count, 100);
  EXPECT_EQ(uploads, 1u);
}

TEST_F(FalconBoot, AWrongEchoIsRetriedTenTimes) {
  fake->corrupt_uploads = 9;
  EXPECT_EQ(boot(), "");
  EXPECT_EQ(uploads, 10u);
  EXPECT_EQ(fake->received, image);
}

TEST_F(FalconBoot, TenWrongEchoesAreAnErrorWithTheByte) {
  fake->corrupt_uploads = 1000;
  fake->corrupt_byte = 100;
  const std::string message = boot();
  EXPECT_NE(message.find("10 attempts"), std::string::npos) << message;
  EXPECT_NE(message.find("byte 100 of the image was echoed as"), std::string::npos) << message;
  EXPECT_EQ(fake->upload_count, 10);
}

TEST_F(FalconBoot, FirmwareThatDoesNotStartIsRetried) {
  fake->failed_uploads = 2;
  EXPECT_EQ(boot(), "");
  EXPECT_EQ(uploads, 3u);
}

TEST_F(FalconBoot, ALoaderThatEchoesIsNotFirmware) {
  fake->echoes_all = true;
  image.clear();
  EXPECT_NE(boot().find("the device runs no firmware"), std::string::npos);
}

TEST_F(FalconBoot, AnUnplugDuringBootEndsAtOnce) {
  options.progress = [&](int, double share) {
    if (share > 0.5) fake->is_plugged = false;
    return true;
  };
  EXPECT_NE(boot().find("unplugged"), std::string::npos);
  EXPECT_EQ(uploads, 1u);
}

TEST_F(FalconBoot, ProgressRisesAndCanCancel) {
  double last = -1;
  options.progress = [&](int attempt, double share) {
    EXPECT_EQ(attempt, 1);
    EXPECT_GE(share, last);
    last = share;
    return share < 0.5;
  };
  EXPECT_NE(boot().find("cancelled"), std::string::npos);
  EXPECT_GE(last, 0.5);
  EXPECT_FALSE(fake->firmware_is_running);
}

TEST_F(FalconBoot, RecoversFromStallsAndTimeouts) {
  fake->control_faults = {UsbError::none, UsbError::stall};
  fake->write_faults = {UsbError::stall};
  fake->read_faults = {UsbError::timeout, UsbError::stall};
  EXPECT_EQ(boot(), "");
  EXPECT_EQ(fake->out_halt_clears, 1);
  EXPECT_EQ(fake->in_halt_clears, 1);
  EXPECT_EQ(counters.stalls, 3u);
  EXPECT_EQ(counters.timeouts, 1u);
  EXPECT_EQ(counters.retries, 3u);
}

TEST_F(FalconBoot, ModemStatusBytesAreStrippedAndNotAnUnplug) {
  std::span<const std::uint8_t> payload;
  EXPECT_EQ(ftdi.read(payload, 1), UsbError::none);
  EXPECT_TRUE(payload.empty());
  EXPECT_EQ(counters.idle_packets, 1u);
  for (int i = 0; i < 100; ++i) fake->output_queue.push_back(static_cast<std::uint8_t>(i));
  EXPECT_EQ(ftdi.read(payload, 1), UsbError::none);
  ASSERT_EQ(payload.size(), 62u);
  EXPECT_EQ(payload[0], 0);
  EXPECT_EQ(payload[61], 61);
  EXPECT_EQ(ftdi.read(payload, 1), UsbError::none);
  ASSERT_EQ(payload.size(), 38u);
  EXPECT_EQ(payload[0], 62);
}

}  // namespace catena::haptics::usb::falcon_boot_test
