#include "render/vk/picture.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/support.h"

namespace catena::test {
namespace {

using namespace catena::render;

Picture ramp() {
  Picture picture{13, 7, {}};
  for (std::uint32_t i = 0; i < 13 * 7; ++i)
    for (const std::uint32_t c : {3 * i, 255 - i, i % 5 * 60, i * 2 % 256}) picture.rgba.push_back(std::uint8_t(c));
  return picture;
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

TEST(Png, NothingHalfWrittenStays) {
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

TEST(Png, ReadingSomethingElseIsAnError) {
  const TemporaryFolder folder;
  write_file(folder / "a.png", "not a picture");
  EXPECT_FALSE(read_png(folder / "a.png"));
  EXPECT_FALSE(read_png(folder / "missing.png"));
}

}  // namespace
}  // namespace catena::test
