// SPDX-License-Identifier: MIT
#include "engine/scene/units.h"

#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::units_test {

TEST(SceneUnits, FieldsAndLengthsHaveTheStatedUnits) {
  const Scene scene =
      parsed(R"({"unit_length": "mm", "fields": {"v": {"analytic": "circle", "unit": "m/s"}, "d": {"analytic": "sphere"}}})");
  EXPECT_EQ(length_unit(scene), "mm");
  EXPECT_EQ(unit_of(scene, find_field(scene, "v")), "m/s");
  EXPECT_EQ(unit_of(scene, find_field(scene, "d")), "");
  EXPECT_EQ(unit_suffix("m/s"), " m/s");
  EXPECT_EQ(unit_suffix(""), "");
}

TEST(SceneUnits, ErrorsNameTheLine) {
  for (const char* text : {"{\"fields\": {\n\"v\": {\"analytic\": \"circle\", \"unit\": 3}}}", "{\n\"unit_length\": \"\"}",
                           "{\n\"unit_length\": \"much too long for a unit of length\"}"})
    expect_error(parse_scene(text, "s.json"), "s.json:2: ", {"is not a unit"});
}

}  // namespace catena::scene::units_test
