// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_boot.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/haptics/device/fake_falcon.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::haptics::usb::falcon_image_test {

using catena::test::fails;
using catena::test::message_of;

std::string error_of(const std::vector<std::uint8_t>& image) { return message_of(check_falcon_image(image, "a.bin")); }

void expect_error(const std::vector<std::uint8_t>& image, int offset, const std::string& what) {
  const std::string message = error_of(image);
  EXPECT_TRUE(message.starts_with("a.bin: byte " + std::to_string(offset) + ": ")) << message;
  for (const std::string& part : {what, std::string("expected")}) EXPECT_TRUE(catena::test::has(message, part));
}

TEST(FalconImage, AValidImageReportsItsBlocks) {
  const auto info = catena::test::value_of(check_falcon_image(test::make_boot_image(200), "a.bin"));
  EXPECT_EQ(info.blocks, 1);
  EXPECT_EQ(info.data_words, 200u);
  EXPECT_EQ(info.entry, 0x3F8000u);
}

TEST(FalconImage, ErrorsNameTheByteAndTheExpectation) {
  const std::vector<std::uint8_t> good = test::make_boot_image(4);
  const auto changed = [&](std::size_t at, std::uint8_t byte) {
    std::vector<std::uint8_t> image = good;
    image[at] = byte;
    return image;
  };
  expect_error({}, 0, "key 0x08AA");
  expect_error(changed(0, 0x4D), 0, "0x084D; the key 0x08AA");
  expect_error(changed(18, 0x40), 18, "below 0x400000");  // high word of the entry address: 0x40 is bit 22
  expect_error(changed(24, 0x40), 24, "below 0x400000");
  expect_error(changed(22, 200), 22, "400 bytes, but only 10 bytes are left");
  std::vector<std::uint8_t> image = good;
  image.push_back(0);
  expect_error(image, static_cast<int>(image.size()), "half a word");
  image.push_back(0);
  expect_error(image, static_cast<int>(image.size()) - 2, "2 bytes follow the final 0");
  image = good;
  image.resize(22);
  image.insert(image.end(), {0, 0});
  expect_error(image, 22, "first block");
}

TEST(FalconImage, EveryTruncationIsRefused) {
  const std::vector<std::uint8_t> image = test::make_boot_image(20);
  for (std::size_t n = 0; n < image.size(); ++n)
    EXPECT_NE(error_of({image.begin(), image.begin() + static_cast<std::ptrdiff_t>(n)}), "") << n;
  EXPECT_EQ(error_of(image), "");
}

TEST(FalconImage, ATooLongFileIsRefusedBeforeReading) {
  expect_error(std::vector<std::uint8_t>(kFalconImageMaxBytes + 2, 0xAA), static_cast<int>(kFalconImageMaxBytes), "too long");
  const catena::test::TemporaryFolder folder;
  catena::test::write_file(folder / "long.bin", "x");
  std::filesystem::resize_file(folder / "long.bin", std::uintmax_t{1} << 40);
  EXPECT_TRUE(fails(read_falcon_image(folder / "long.bin"), "too long"));
}

TEST(FalconImage, AnIrregularFileIsRefused) {
  for (const char* path : {"/dev/zero", "/tmp"})
    EXPECT_EQ(message_of(read_falcon_image(path)), std::string(path) + ": this is not a file; a Falcon firmware image was expected");
}

TEST(FalconImage, AFileIsReadCompletely) {
  const catena::test::TemporaryFolder folder;
  const std::vector<std::uint8_t> image = test::make_boot_image(300);
  catena::test::write_file(folder / "good.bin", {image.begin(), image.end()});
  EXPECT_EQ(catena::test::value_of(read_falcon_image(folder / "good.bin")), image);
  EXPECT_TRUE(fails(read_falcon_image(folder / "none.bin"), "a Falcon firmware image was expected"));
}

}  // namespace catena::haptics::usb::falcon_image_test
