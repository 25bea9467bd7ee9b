// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_codec.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace catena::haptics::usb::falcon_codec_test {

FalconPacket packet(const std::string& text) {
  FalconPacket out{};
  EXPECT_EQ(text.size(), out.size());
  std::memcpy(out.data(), text.data(), out.size());
  return out;
}

FalconFrame frame(int x, int y, int z, int buttons = 0, int homed = 7, int unknown = 'A') {
  return {{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), static_cast<std::int16_t>(z)},
          static_cast<std::uint8_t>(buttons),
          static_cast<std::uint8_t>(homed),
          static_cast<std::uint8_t>(unknown)};
}

bool same(const FalconFrame& a, const FalconFrame& b) {
  return a.encoders == b.encoders && a.buttons == b.buttons && a.homed == b.homed && a.unknown == b.unknown;
}

void append(std::vector<std::uint8_t>& to, const FalconFrame& f) {
  const FalconPacket bytes = encode_frame(f);
  to.insert(to.end(), bytes.begin(), bytes.end());
}

std::vector<std::uint8_t> stream_of(const std::vector<FalconFrame>& frames) {
  std::vector<std::uint8_t> stream;
  for (const FalconFrame& f : frames) append(stream, f);
  return stream;
}

std::vector<FalconFrame> all_of(FalconFramer& framer, std::span<const std::uint8_t> bytes) {
  std::vector<FalconFrame> out;
  for (const std::uint8_t byte : bytes)
    if (FalconFrame f; framer.push(byte, f)) out.push_back(f);
  return out;
}

TEST(FalconCodec, CommandsEncodeToTheExpectedBytes) {
  EXPECT_EQ(encode_command({}), packet("<AAAAAAAAAAAAAA>"));
  // 0x1234 low nibble first: 4 3 2 1; -1447 = 0xFA59: 9 5 A F = J F K P; -1
  EXPECT_EQ(encode_command({{0x1234, -1447, -1}, kFalconHoming | kFalconRed}), packet("<EDCBJFKPPPPPJA>"));
  EXPECT_EQ(encode_command({{4095, -4095, 0}, kFalconGreen}), packet("<PPPABAAPAAAACA>"));
}

TEST(FalconCodec, FramesDecodeToTheExpectedValues) {
  FalconFrame f;
  ASSERT_TRUE(decode_frame(packet("<JFKPAAAAEDCBAA>"), f));
  EXPECT_TRUE(same(f, frame(-1447, 0, 0x1234, 0, 0, 'A')));
  // byte 13: all buttons pressed and all axes homed
  ASSERT_TRUE(decode_frame(packet("<AAAAAAAAAAAA\xC0\x07>"), f));
  EXPECT_TRUE(same(f, frame(0, 0, 0, 15, 7, 7)));
  EXPECT_TRUE(f.all_homed());
}

TEST(FalconCodec, EveryCountRoundTrips) {
  for (int v = -32768; v <= 32767; v += 7) {
    const FalconFrame f = frame(v, -(v + 1), v ^ 0x55, v & 15, v & 7, v & 0xFF);
    FalconFrame back;
    ASSERT_TRUE(decode_frame(encode_frame(f), back)) << v;
    ASSERT_TRUE(same(f, back)) << v;
    const FalconCommand c{f.encoders, static_cast<std::uint8_t>(v & 15)};
    FalconCommand decoded;
    ASSERT_TRUE(decode_command(encode_command(c), decoded)) << v;
    ASSERT_EQ(decoded.motors, c.motors);
    ASSERT_EQ(decoded.control, c.control);
  }
}

TEST(FalconCodec, AnInvalidByteInvalidatesTheFrame) {
  const FalconPacket good = encode_frame(frame(-1447, 20, 300, 5));
  for (std::size_t at = 0; at < good.size(); ++at)
    for (int byte = 0; byte < 256; ++byte) {
      FalconPacket bytes = good;
      bytes[at] = static_cast<std::uint8_t>(byte);
      const bool fits = at == 0    ? byte == '<'
                        : at <= 12 ? byte >= 'A' && byte <= 'P'
                        : at == 13 ? byte >= 0x41 && byte <= 0xC0
                        : at == 14 ? true
                                   : byte == '>';
      FalconFrame f;
      ASSERT_EQ(decode_frame(bytes, f), fits) << at << " " << byte;
    }
}

TEST(FalconFramer, EverySplitOfAStreamGivesTheSameFrames) {
  const std::vector<FalconFrame> sent = {frame(1, 2, 3), frame(-1447, 0, 5, 15, 7, '<'), frame(7, -8, 9, 4, 0, '>')};
  const std::vector<std::uint8_t> stream = stream_of(sent);
  for (std::size_t a = 0; a <= stream.size(); ++a)
    for (std::size_t b = a; b <= stream.size(); ++b) {
      FalconFramer framer;
      std::vector<FalconFrame> got;
      const std::span<const std::uint8_t> bytes(stream);
      for (const auto piece : {bytes.first(a), bytes.subspan(a, b - a), bytes.subspan(b)})
        for (const FalconFrame& f : all_of(framer, piece)) got.push_back(f);
      ASSERT_EQ(got.size(), sent.size()) << a << " " << b;
      for (std::size_t i = 0; i < sent.size(); ++i) ASSERT_TRUE(same(got[i], sent[i]));
      ASSERT_EQ(framer.dropped_bytes(), 0u);
    }
}

TEST(FalconFramer, OfJoinedFramesTheNewestIsReturned) {
  FalconFramer framer;
  FalconFrame newest;
  EXPECT_EQ(framer.push(stream_of({frame(0, 0, 0), frame(1, 0, 0), frame(2, 0, 0)}), newest), 3);
  EXPECT_EQ(newest.encoders[0], 2);
}

TEST(FalconFramer, ATruncatedFrameLosesOnlyItself) {
  for (std::size_t prefix = 0; prefix < kFalconPacketBytes; ++prefix) {
    std::vector<std::uint8_t> stream = stream_of({frame(1, 1, 1)});
    stream.resize(prefix);
    append(stream, frame(2, 2, 2));
    FalconFramer framer;
    const auto got = all_of(framer, stream);
    ASSERT_EQ(got.size(), 1u) << prefix;
    EXPECT_EQ(got[0].encoders[0], 2);
    EXPECT_EQ(framer.dropped_bytes(), prefix);
    EXPECT_EQ(framer.resyncs(), prefix > 0 ? 1u : 0u);
  }
}

TEST(FalconFramer, GarbageBetweenFramesIsDropped) {
  const std::string garbage[] = {std::string(1, 0), ">", "<", "<<", "<A<>", "\xFF\xC0\x41", "<AAAAAAAAAAAAA<B"};
  for (const auto& noise : garbage) {
    std::vector<std::uint8_t> stream(noise.begin(), noise.end());
    append(stream, frame(3, 3, 3));
    stream.insert(stream.end(), noise.begin(), noise.end());
    append(stream, frame(4, 4, 4));
    FalconFramer framer;
    const auto got = all_of(framer, stream);
    ASSERT_EQ(got.size(), 2u);
    EXPECT_EQ(got[0].encoders[0], 3);
    EXPECT_EQ(got[1].encoders[0], 4);
    EXPECT_EQ(framer.dropped_bytes(), 2 * noise.size());
  }
}

TEST(FalconFramer, AFrameStartInByte14IsFound) {
  // fourteen bytes of a frame followed by another frame, whose '<' is in the place of the unknown byte
  std::vector<std::uint8_t> stream = stream_of({frame(1, 1, 1)});
  stream.resize(14);
  append(stream, frame(2, 2, 2));
  append(stream, frame(3, 3, 3));
  FalconFramer framer;
  const auto got = all_of(framer, stream);
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(got[0].encoders[0], 2);
}

TEST(FalconFramer, ResetDiscardsThePartialFrame) {
  const std::vector<std::uint8_t> stream = stream_of({frame(1, 1, 1)});
  FalconFramer framer;
  FalconFrame f;
  EXPECT_EQ(framer.push(std::span<const std::uint8_t>(stream).first(8), f), 0);
  framer.reset();
  EXPECT_EQ(framer.push(std::span<const std::uint8_t>(stream).subspan(8), f), 0);
  EXPECT_EQ(framer.push(stream, f), 1);
}

}  // namespace catena::haptics::usb::falcon_codec_test
