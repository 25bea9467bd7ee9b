// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_boot.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/haptics/device/fake_falcon.h"

namespace catena::haptics::usb {
namespace falcon_image_test {

std::string error_of(const std::vector<std::uint8_t>& image) {
  const auto result = check_falcon_image(image, "a.bin");
  return result ? "" : result.error().message;
}

void expect_error(const std::vector<std::uint8_t>& image, int offset, const std::string& what) {
  const std::string message = error_of(image);
  EXPECT_TRUE(message.starts_with("a.bin: byte " + std::to_string(offset) + ": ")) << message;
  EXPECT_NE(message.find(what), std::string::npos) << message;
  EXPECT_NE(message.find("expected"), std::string::npos) << message;
}

TEST(FalconImage, AValidImageReportsItsBlocks) {
  const auto info = check_falcon_image(test::make_boot_image(200), "a.bin");
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->blocks, 1);
  EXPECT_EQ(info->data_words, 200u);
  EXPECT_EQ(info->entry, 0x3F8000u);
}

TEST(FalconImage, ErrorsNameTheByteAndTheExpectation) {
  std::vector<std::uint8_t> image = test::make_boot_image(4);
  expect_error({}, 0, "key 0x08AA");
  image[0] = 0x4D;
  expect_error(image, 0, "0x084D; the key 0x08AA");
  image = test::make_boot_image(4);
  image[18] = 0x40;  // high word of the entry address: 0x40 is bit 22
  expect_error(image, 18, "below 0x400000");
  image = test::make_boot_image(4);
  image[24] = 0x40;
  expect_error(image, 24, "below 0x400000");
  image = test::make_boot_image(4);
  image[22] = 200;
  expect_error(image, 22, "400 bytes, but only 10 bytes are left");
  image = test::make_boot_image(4);
  image.push_back(0);
  expect_error(image, static_cast<int>(image.size()), "half a word");
  image.push_back(0);
  expect_error(image, static_cast<int>(image.size()) - 2, "2 bytes follow the final 0");
  image = test::make_boot_image(4);
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
  const auto path = std::filesystem::path(testing::TempDir()) / "falcon_image_long.bin";
  std::ofstream(path) << "x";
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40);
  const auto result = read_falcon_image(path.string());
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("too long"), std::string::npos) << result.error().message;
  std::filesystem::remove(path);
}

TEST(FalconImage, AnIrregularFileIsRefused) {
  for (const char* path : {"/dev/zero", "/tmp"}) {
    const auto result = read_falcon_image(path);
    ASSERT_FALSE(result) << path;
    EXPECT_EQ(result.error().message, std::string(path) + ": this is not a file; a Falcon firmware image was expected");
  }
}

TEST(FalconImage, AFileIsReadCompletely) {
  const auto path = std::filesystem::path(testing::TempDir()) / "falcon_image_good.bin";
  const std::vector<std::uint8_t> image = test::make_boot_image(300);
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
  const auto read = read_falcon_image(path.string());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, image);
  std::filesystem::remove(path);
  const auto missing = read_falcon_image(path.string());
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("a Falcon firmware image was expected"), std::string::npos) << missing.error().message;
}

}  // namespace falcon_image_test
}  // namespace catena::haptics::usb
