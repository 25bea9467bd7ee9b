// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/base/json.h"

namespace catena {
namespace json_rotation_test {

Result<Mat3> rotation(const std::string& text) {
  auto node = json::parse(text, "scene.json");
  if (!node) return node.error();
  return json::as_rotation(*node, "rotation");
}

TEST(JsonRotation, ReadsRowsNineNumbersOrAxisAndAngle) {
  const Mat3 expected(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));  // columns
  for (const char* text :
       {"[[0, -1, 0], [1, 0, 0], [0, 0, 1]]", "[0, -1, 0, 1, 0, 0, 0, 0, 1]", R"({"axis": [0, 0, 3], "angle_deg": 90})"}) {
    const auto made = rotation(text);
    ASSERT_TRUE(made) << text;
    for (int i = 0; i < 3; ++i) EXPECT_LE(norm((*made)[i] - expected[i]), 1e-16) << text;
  }
}

TEST(JsonRotation, RefusesInvalidRotations) {
  for (const char* text :
       {"[1, 0, 0]", "3", "[[1, 0, 0], [0, 1, 0]]", "[1, 0, 0, 0, 1, 0, 0, 0, -1]", "[1, 0, 0, 0, 1, 0, 0, 0, 1.1]",
        R"({"axis": [0, 0, 0], "angle_deg": 1})", R"({"axis": [0, 0, 1]})", R"({"axis": [0, 0, 1], "angle_deg": 1, "x": 1})"}) {
    const auto made = rotation(text);
    ASSERT_FALSE(made) << text;
    EXPECT_EQ(made.error().message.rfind("scene.json:1:", 0), 0u) << made.error().message;
  }
}

}  // namespace json_rotation_test
}  // namespace catena
