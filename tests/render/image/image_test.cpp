// SPDX-License-Identifier: MIT
#include "render/image/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "render/image/exr_writer.h"
#include "render/image/png_writer.h"
#include "tests/render/support/read_files.h"
#include "tests/support/support.h"

namespace catena::test::image_test {

using namespace catena::render;

Image8 ramp() {
  Image8 rendered{13, 7, {}};
  for (std::uint32_t i = 0; i < 13 * 7; ++i)
    for (const std::uint32_t c : {3 * i, 255 - i, i % 5 * 60, i * 2 % 256}) rendered.rgba.push_back(std::uint8_t(c));
  return rendered;
}

TEST(Png, RoundTripWithAlpha) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "a.png", ramp(), true));
  const auto back = read_png(folder / "a.png");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->width, 13u);
  EXPECT_EQ(back->height, 7u);
  EXPECT_EQ(back->rgba, ramp().rgba);
}

TEST(Png, RoundTripWithoutAlpha) {
  const TemporaryFolder folder;
  write_file(folder / "a.png", "an older file");
  ASSERT_TRUE(write_png(folder / "a.png", ramp(), false));
  const auto back = read_png(folder / "a.png");
  ASSERT_TRUE(back);
  for (std::size_t i = 0; i < back->rgba.size(); ++i) EXPECT_EQ(back->rgba[i], i % 4 == 3 ? 255 : ramp().rgba[i]);
}

TEST(Png, AFailedWriteLeavesNoFile) {
  const TemporaryFolder folder;
  const auto missing = write_png(folder / "no/such/a.png", ramp(), true);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message.rfind(folder / "no/such/a.png", 0), 0u);
  EXPECT_NE(missing.error().message.find("No such file or directory"), std::string::npos);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 0);
}

TEST(Png, AFullDiskIsReported) {
  if (!exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  const auto full = write_png("/dev/full", ramp(), true);
  ASSERT_FALSE(full);
  EXPECT_NE(full.error().message.find("No space left"), std::string::npos);
  EXPECT_TRUE(exists("/dev/full"));
}

TEST(Png, ReadingAnotherFormatIsAnError) {
  const TemporaryFolder folder;
  write_file(folder / "a.png", "not a picture");
  EXPECT_FALSE(read_png(folder / "a.png"));
  EXPECT_FALSE(read_png(folder / "missing.png"));
}

TEST(Png, SixteenBitsRoundTrip) {
  const TemporaryFolder folder;
  for (const int channels : {1, 3, 4}) {
    std::vector<std::uint16_t> values;
    for (std::uint32_t i = 0; i < 11u * 5u * unsigned(channels); ++i) values.push_back(std::uint16_t(i * 1237u + 258u));
    auto png = PngWriter::open(folder / "a.png", {11, 5, 16, channels, "Objects", "[1, 2]"});
    ASSERT_TRUE(png) << png.error().message;
    // in bands of 2, 1 and 2 rows
    const std::size_t row = 11 * std::size_t(channels);
    const std::span<const std::uint16_t> all(values);
    for (const auto& [first, count] : {std::pair{0, 2}, {2, 1}, {3, 2}})
      ASSERT_TRUE(png->write_rows(all.subspan(std::size_t(first) * row, std::size_t(count) * row)));
    EXPECT_FALSE(exists(folder / "a.png")) << "not before the commit";
    ASSERT_TRUE(png->finish());
    ASSERT_TRUE(png->commit());
    const DeepPng back = read_deep_png(folder / "a.png");
    EXPECT_EQ(back.bits, 16);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.values, values);
    EXPECT_EQ(back.text.at("Objects"), "[1, 2]");
    std::filesystem::remove(folder / "a.png");
  }
}

TEST(Png, ADroppedWriterLeavesNoFile) {
  const TemporaryFolder folder;
  {
    auto png = PngWriter::open(folder / "a.png", {4, 4, 8, 3});
    ASSERT_TRUE(png);
    ASSERT_TRUE(png->write_rows(std::vector<std::uint8_t>(12, 7)));
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 0);
}

TEST(Png, LevelsRoundToNearest) {
  EXPECT_EQ(quantize(0, 65535), 0u);
  EXPECT_EQ(quantize(1, 65535), 65535u);
  EXPECT_EQ(quantize(0.5f, 65535), 32768u);  // 32767.5 + 0.5
  EXPECT_EQ(quantize(0.4f / 65535, 65535), 0u);
  EXPECT_EQ(quantize(0.6f / 65535, 65535), 1u);
  EXPECT_EQ(quantize(-3, 65535), 0u);
  EXPECT_EQ(quantize(7, 65535), 65535u);
  EXPECT_EQ(quantize(std::numeric_limits<float>::quiet_NaN(), 65535), 0u);
  EXPECT_EQ(quantize(0.5f, 255), 128u);
}

TEST(Exr, FloatsRoundTripBitForBit) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (int i = 0; i < 9 * 40 * 4; ++i) values.push_back(std::ldexp(float(i) + 0.3f, i % 60 - 30));
  values[5] = std::numeric_limits<float>::infinity();
  auto exr = ExrWriter::open(folder / "a.exr", {9, 40, {"R", "G", "B", "A"}, "a test"});
  ASSERT_TRUE(exr) << exr.error().message;
  const std::span<const float> all(values);
  // in bands that do not match OpenEXR's blocks of 16 rows
  for (const auto& [first, count] : {std::pair{0, 7}, {7, 20}, {27, 13}})
    ASSERT_TRUE(exr->write_rows(all.subspan(std::size_t(first) * 36, std::size_t(count) * 36)));
  ASSERT_TRUE(exr->finish());
  ASSERT_TRUE(exr->commit());
  const ExrImage back = read_exr(folder / "a.exr");
  EXPECT_EQ(back.width, 9);
  EXPECT_EQ(back.height, 40);
  EXPECT_EQ(back.comments, "a test");
  ASSERT_EQ(back.channels.size(), 4u);
  const char* names[] = {"R", "G", "B", "A"};
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(back.channels.at(names[i % 4])[i / 4], values[i]) << i;
}

TEST(Exr, AFullDiskAndAMissingFolderAreReported) {
  const TemporaryFolder folder;
  const auto missing = ExrWriter::open(folder / "no/a.exr", {2, 2, {"Z"}});
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("No such file or directory"), std::string::npos);
  {
    auto dropped = ExrWriter::open(folder / "a.exr", {2, 2, {"Z"}});
    ASSERT_TRUE(dropped);
    ASSERT_TRUE(dropped->write_rows(std::vector<float>{1, 2}));
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 0);
  if (!exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  auto full = ExrWriter::open("/dev/full", {2, 2, {"Z"}});
  ASSERT_TRUE(full);
  ASSERT_TRUE(full->write_rows(std::vector<float>{1, 2, 3, 4}));
  const auto finished = full->finish();
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().message.find("No space left"), std::string::npos);
}

TEST(Exr, DisplayValuesBecomeLinearLight) {
  // IEC 61966-2-1: 0.5 is 0.21404 of the light, 0.04 is on the linear part
  EXPECT_FLOAT_EQ(linear_from_display(0), 0);
  EXPECT_FLOAT_EQ(linear_from_display(1), 1);
  EXPECT_NEAR(linear_from_display(0.5f), 0.2140411, 1e-6);
  EXPECT_NEAR(linear_from_display(0.04f), 0.04 / 12.92, 1e-7);
  const float rgba[] = {0.5f, 1, 0, 0.25f};
  const auto c = premultiplied_linear(rgba);
  EXPECT_NEAR(c[0], 0.25 * 0.2140411, 1e-6);
  EXPECT_FLOAT_EQ(c[1], 0.25f);
  EXPECT_FLOAT_EQ(c[2], 0);
  EXPECT_FLOAT_EQ(c[3], 0.25f);
}

}  // namespace catena::test::image_test
