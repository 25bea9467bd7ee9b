// SPDX-License-Identifier: MIT
#include "engine/scene/units.h"

#include <gtest/gtest.h>

namespace catena::scene {
namespace units_test {

TEST(SceneUnits, FieldsAndLengthsHaveTheStatedUnits) {
  const auto scene = parse_scene(R"({"unit_length": "mm",
    "fields": {"v": {"analytic": "circle", "unit": "m/s"}, "d": {"analytic": "sphere"}}})",
                                 "s.json");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(length_unit(*scene), "mm");
  EXPECT_EQ(unit_of(*scene, find_field(*scene, "v")), "m/s");
  EXPECT_EQ(unit_of(*scene, find_field(*scene, "d")), "");
  EXPECT_EQ(unit_suffix("m/s"), " m/s");
  EXPECT_EQ(unit_suffix(""), "");
}

TEST(SceneUnits, ErrorsNameTheLine) {
  for (const char* text : {"{\"fields\": {\n\"v\": {\"analytic\": \"circle\", \"unit\": 3}}}", "{\n\"unit_length\": \"\"}",
                           "{\n\"unit_length\": \"much too long for a unit of length\"}"}) {
    const auto scene = parse_scene(text, "s.json");
    ASSERT_FALSE(scene) << text;
    EXPECT_EQ(scene.error().message.find("s.json:2: "), 0u) << scene.error().message;
    EXPECT_NE(scene.error().message.find("is not a unit"), std::string::npos) << scene.error().message;
  }
}

}  // namespace units_test
}  // namespace catena::scene
