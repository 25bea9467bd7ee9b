// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "haptics/device/usb/falcon_boot.h"
#include "haptics/device/usb/falcon_codec.h"
#include "haptics/device/usb/falcon_kinematics.h"
#include "tests/fuzz/mutate.h"

namespace catena::haptics::usb::falcon_fuzz_test {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kInputs = 100000;

// random bit flips, cuts, duplications, and changes of bytes and words
void mutate(Bytes& bytes, test::Random& random) {
  const std::size_t changes = 1 + random.below(4);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = random.below(bytes.size() + 1), length = std::min(random.below(40), bytes.size() - at);
    const auto where = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random.below(6)) {
      case 0:
        if (at < bytes.size()) bytes[at] ^= static_cast<std::uint8_t>(1u << random.below(8));
        break;
      case 1:
        bytes.erase(where, where + static_cast<std::ptrdiff_t>(length));
        break;
      case 2: {
        const Bytes piece(where, where + static_cast<std::ptrdiff_t>(length));
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(random.below(bytes.size() + 1)), piece.begin(), piece.end());
        break;
      }
      case 3:
        bytes.insert(where, static_cast<std::uint8_t>(random.next()));
        break;
      case 4: {
        constexpr std::uint8_t kWords[] = {0x00, 0xFF, '<', '>', 'A', 'P', 0xC0, 0xC1, 0xAA, 0x08, 0x40, 0x3F};
        if (at < bytes.size()) bytes[at] = kWords[random.below(std::size(kWords))];
        break;
      }
      default:
        if (at + 1 < bytes.size()) bytes[at] = bytes[at + 1] = static_cast<std::uint8_t>(random.below(2) * 0xFF);
    }
  }
}

FalconFrame any_frame(test::Random& random) {
  FalconFrame f;
  for (std::int16_t& count : f.encoders) count = static_cast<std::int16_t>(random.next());
  f.buttons = static_cast<std::uint8_t>(random.below(16));
  f.homed = static_cast<std::uint8_t>(random.below(8));
  f.unknown = static_cast<std::uint8_t>(random.next());
  return f;
}

// A stateless reader that looks for a complete frame at each position. Frames overlap only by a '<' in byte 14.
std::vector<FalconFrame> by_hand(const Bytes& stream) {
  std::vector<FalconFrame> out;
  for (std::size_t at = 0; at + kFalconPacketBytes <= stream.size();) {
    FalconFrame f;
    if (decode_frame(std::span<const std::uint8_t>(stream).subspan(at).first<kFalconPacketBytes>(), f)) {
      out.push_back(f);
      at += kFalconPacketBytes;
    } else {
      ++at;
    }
  }
  return out;
}

TEST(FalconFuzz, TheFramerMatchesAReaderOfTheWholeStream) {
  test::FuzzInputs inputs(kInputs, 17);
  test::Random& random = inputs.random;
  std::uint64_t found = 0, dropped = 0;
  while (inputs.next() && !HasFailure()) {
    const std::uint64_t i = inputs.count();
    Bytes stream;
    for (std::size_t k = 1 + random.below(4); k > 0; --k) {
      const FalconPacket bytes = encode_frame(any_frame(random));
      stream.insert(stream.end(), bytes.begin(), bytes.end());
    }
    mutate(stream, random);
    const std::vector<FalconFrame> expected = by_hand(stream);
    FalconFramer framer;
    std::size_t got = 0;
    for (std::size_t at = 0; at < stream.size();) {
      const std::size_t piece = std::min(1 + random.below(20), stream.size() - at);
      for (std::size_t b = at; b < at + piece; ++b)
        if (FalconFrame f; framer.push(stream[b], f)) {
          ASSERT_LT(got, expected.size()) << "input " << i;
          ASSERT_EQ(encode_frame(f), encode_frame(expected[got])) << "input " << i;
          ++got;
        }
      at += piece;
    }
    ASSERT_EQ(got, expected.size()) << "input " << i;
    ASSERT_LE(framer.dropped_bytes() + got * kFalconPacketBytes, stream.size()) << "input " << i;
    ASSERT_GT(framer.dropped_bytes() + (got + 1) * kFalconPacketBytes, stream.size()) << "input " << i;
    found += got;
    dropped += framer.dropped_bytes();
  }
  EXPECT_GT(found, inputs.count());
  EXPECT_GT(dropped, inputs.count());
}

TEST(FalconFuzz, PacketsOfAnyBytesAreRefusedOrRoundTrip) {
  test::FuzzInputs inputs(kInputs, 23);
  test::Random& random = inputs.random;
  std::uint64_t frames = 0, commands = 0, places = 0;
  while (inputs.next() && !HasFailure()) {
    const std::uint64_t i = inputs.count();
    FalconPacket good = encode_frame(any_frame(random));
    if (i % 2 == 0) good = encode_command({any_frame(random).encoders, static_cast<std::uint8_t>(random.below(16))});
    Bytes bytes(good.begin(), good.end());
    mutate(bytes, random);
    bytes.resize(kFalconPacketBytes, 0);
    const auto packet = std::span<const std::uint8_t>(bytes).first<kFalconPacketBytes>();
    FalconFrame f;
    if (decode_frame(packet, f)) {
      ++frames;
      ASSERT_TRUE(std::ranges::equal(encode_frame(f), bytes)) << "input " << i;
      // any encoder counts give a finite position within reach, or are refused
      if (i % 64 == 0) {
        Vec3 p(0.0);
        if (falcon_forward_kinematics(falcon_angles(f.encoders), p)) {
          ++places;
          ASSERT_LT(max_abs(p), 0.3);
        }
      }
    }
    FalconCommand c;
    if (decode_command(packet, c)) {
      ++commands;
      ASSERT_TRUE(std::ranges::equal(encode_command(c), bytes)) << "input " << i;
    }
  }
  EXPECT_GT(frames, inputs.count() / 50);
  EXPECT_GT(commands, inputs.count() / 50);
  EXPECT_GT(places, 0u);
}

Bytes good_image() {
  Bytes image{0xAA, 0x08};
  const auto put = [&image](unsigned word) {
    image.push_back(static_cast<std::uint8_t>(word));
    image.push_back(static_cast<std::uint8_t>(word >> 8));
  };
  for (const unsigned word : {0, 0, 0, 0, 0, 0, 0, 0, 0x3F, 0x8000}) put(word);
  for (const unsigned words : {3u, 20u, 1u}) {
    for (const unsigned word : {words, 0x3Fu, 0x8000u}) put(word);
    for (unsigned i = 0; i < words; ++i) put(i * 4099);
  }
  put(0);
  return image;
}

TEST(FalconFuzz, ImagesAreAcceptedOrRefusedWithTheByteAndTheExpectation) {
  const Bytes good = good_image();
  ASSERT_TRUE(check_falcon_image(good, "a.bin"));
  test::fuzz(kInputs, 29, [&](test::Random& random, std::uint64_t i) {
    Bytes image = good;
    mutate(image, random);
    const auto info = check_falcon_image(image, "a.bin");
    if (info) {
      EXPECT_EQ(22 + 2 * info->data_words + 6 * static_cast<std::size_t>(info->blocks) + 2, image.size()) << "input " << i;
      return true;
    }
    const std::string& message = info.error().message;
    test::expect_error_line(message, "a.bin: byte ", {}, std::string::npos);
    EXPECT_LE(std::strtoul(message.c_str() + std::min<std::size_t>(12, message.size()), nullptr, 10), image.size()) << message;
    return false;
  });
}

}  // namespace catena::haptics::usb::falcon_fuzz_test
