// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/engine/field/field_helpers.h"

namespace catena::field::load_raw_test {

using namespace test;

using LoadRaw = FilesTest;

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
  LoadRequest r = request_for(path);
  r.raw = RawLayout{{4, 3, 2}, Vec3(0.5, 1, 2), Vec3(-10, 0, 5), type};
  return r;
}

TEST_F(LoadRaw, ReadsEveryType) {
  for (const auto& [type, bytes] : {std::pair{"float32", bytes_of<float>(24)},
                                    {"float64", bytes_of<double>(24)},
                                    {"uint8", bytes_of<std::uint8_t>(24)},
                                    {"int8", bytes_of<std::int8_t>(24)},
                                    {"uint16", bytes_of<std::uint16_t>(24)},
                                    {"int16", bytes_of<std::int16_t>(24)},
                                    {"uint32", bytes_of<std::uint32_t>(24)},
                                    {"int32", bytes_of<std::int32_t>(24)}})
    // Voxel (1, 2, 1), with x as the fastest axis.
    EXPECT_NEAR(sample_at(value_of(load(request(file("a.raw", bytes), type))), Vec3(-9.5, 2, 7)).value, 1 + 4 * (2 + 3), 1e-12) << type;
}

TEST_F(LoadRaw, ReadsVectors) {
  const AnyField field = value_of(load(request(file("v.raw", bytes_of<float>(72)), "float32x3")));
  Cursor cursor;
  EXPECT_EQ(field.vector->sample(Vec3(-9.5, 0, 5), cursor).value, Vec3(3, 4, 5));
}

// Each number of the transform is finite, but the field's extent is not (found in a damaged .vdb).
TEST_F(LoadRaw, AnInfiniteExtentIsRefused) {
  LoadRequest r = request_for(file("a.raw", std::string(4 * 4 * 2 * 2, '\x3f')));
  r.raw = RawLayout{};
  r.raw->shape = {4, 2, 2};
  r.raw->spacing = Vec3(1e308, 1, 1);
  EXPECT_TRUE(fails(load(r), "finite"));
}

TEST_F(LoadRaw, TheSizeMustFitExactly) {
  for (const int count : {23, 25})
    expect_error(load(request(file("a.raw", bytes_of<float>(count)), "float32")), {"expected 96", std::to_string(4 * count)});
}

TEST_F(LoadRaw, BadLayoutsAreErrors) {
  const std::string path = file("a.raw", bytes_of<float>(24));
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
  EXPECT_FALSE(load(request(folder_ / "absent.raw", "float32")));
  EXPECT_FALSE(describe_grids(path));
}

}  // namespace catena::field::load_raw_test
