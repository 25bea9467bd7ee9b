// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>

#include "engine/io/volume/load_field.h"
#include "tests/support/support.h"

namespace catena::field {
namespace load_raw_test {

using catena::test::TemporaryFolder;

template <class T>
std::string bytes_of(int count) {
  std::string s;
  for (int i = 0; i < count; ++i) {
    const T v = static_cast<T>(i);
    s.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  return s;
}

LoadRequest request(const std::string& path, const std::string& type) {
  LoadRequest r;
  r.path = path;
  r.raw = RawLayout{{4, 3, 2}, Vec3(0.5, 1, 2), Vec3(-10, 0, 5), type};
  return r;
}

template <class T>
void expect_numbers(const TemporaryFolder& folder, const std::string& type) {
  catena::test::write_file(folder / "a.raw", bytes_of<T>(24));
  const auto field = load(request(folder / "a.raw", type));
  ASSERT_TRUE(field) << field.error().message;
  Cursor cursor;
  // Voxel (1, 2, 1), with x as the fastest axis.
  EXPECT_NEAR(field->scalar->sample(Vec3(-9.5, 2, 7), cursor).value, 1 + 4 * (2 + 3), 1e-12) << type;
}

TEST(LoadRaw, ReadsEveryType) {
  TemporaryFolder folder;
  expect_numbers<float>(folder, "float32");
  expect_numbers<double>(folder, "float64");
  expect_numbers<std::uint8_t>(folder, "uint8");
  expect_numbers<std::int8_t>(folder, "int8");
  expect_numbers<std::uint16_t>(folder, "uint16");
  expect_numbers<std::int16_t>(folder, "int16");
  expect_numbers<std::uint32_t>(folder, "uint32");
  expect_numbers<std::int32_t>(folder, "int32");
}

TEST(LoadRaw, ReadsVectors) {
  TemporaryFolder folder;
  catena::test::write_file(folder / "v.raw", bytes_of<float>(72));
  const auto field = load(request(folder / "v.raw", "float32x3"));
  ASSERT_TRUE(field) << field.error().message;
  Cursor cursor;
  EXPECT_EQ(field->vector->sample(Vec3(-9.5, 0, 5), cursor).value, Vec3(3, 4, 5));
}

// Each number of the transform is finite, but the field's extent is not (found in a damaged .vdb).
TEST(LoadRaw, AnInfiniteExtentIsRefused) {
  const TemporaryFolder folder;
  catena::test::write_file(folder / "a.raw", std::string(4 * 4 * 2 * 2, '\x3f'));
  LoadRequest r;
  r.path = folder / "a.raw";
  r.raw = RawLayout{};
  r.raw->shape = {4, 2, 2};
  r.raw->spacing = Vec3(1e308, 1, 1);
  const auto field = load(r);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().message.find('\n'), std::string::npos);
  EXPECT_NE(field.error().message.find("finite"), std::string::npos) << field.error().message;
}

TEST(LoadRaw, TheSizeMustFitExactly) {
  TemporaryFolder folder;
  for (const int count : {23, 25}) {
    catena::test::write_file(folder / "a.raw", bytes_of<float>(count));
    const auto field = load(request(folder / "a.raw", "float32"));
    ASSERT_FALSE(field);
    EXPECT_NE(field.error().message.find("expected 96"), std::string::npos);
    EXPECT_NE(field.error().message.find(std::to_string(4 * count)), std::string::npos);
  }
}

TEST(LoadRaw, BadLayoutsAreErrors) {
  TemporaryFolder folder;
  catena::test::write_file(folder / "a.raw", bytes_of<float>(24));
  const std::string path = folder / "a.raw";
  EXPECT_FALSE(load(request(path, "float16")));
  LoadRequest r = request(path, "float32");
  r.raw->shape = {4, 3, -2};
  EXPECT_FALSE(load(r));
  r = request(path, "float32");
  r.raw->shape = {2147483647, 2147483647, 2147483647};
  EXPECT_FALSE(load(r));
  r = request(path, "float32");
  r.raw->spacing.y = 0;
  EXPECT_FALSE(load(r));
  r.raw = std::nullopt;
  EXPECT_FALSE(load(r));
  EXPECT_FALSE(load(request(folder / "absent.raw", "float32")));
  EXPECT_FALSE(describe_grids(path));
}

}  // namespace load_raw_test
}  // namespace catena::field
