#include "engine/app/viewer/shell/values.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::app {
namespace values_test {

TEST(Values, EveryLoadedFieldHasItsValueAndUnitAtAPlace) {
  auto scene = scene::parse_scene(R"({"unit_length": "mm", "fields": {
    "v": {"analytic": "circle", "unit": "m/s"}, "d": {"analytic": "sphere"}, "unused": {"analytic": "plane"}}})",
                                  "s.json");
  ASSERT_TRUE(scene);
  const Vec3 at(0.6, -0.8, 0.5);
  EXPECT_TRUE(values_at(*scene, at).empty()) << "nothing is loaded for it";
  for (const char* name : {"v", "d"}) ASSERT_TRUE(scene::use_field(*scene, name, json::Node{}));
  const auto values = values_at(*scene, at);
  ASSERT_EQ(values.size(), 2u);
  EXPECT_EQ(values[0].name, "v");
  EXPECT_EQ(values[0].unit, "m/s");
  ASSERT_TRUE(values[0].vector);
  EXPECT_EQ(*values[0].vector, Vec3(0.8, 0.6, 0));
  EXPECT_NEAR(values[0].value, 1, 1e-15);
  EXPECT_NEAR(values[1].value, std::sqrt(1.25), 1e-15);
  EXPECT_EQ(line_words({at, "streamlines v", values}, "mm"), "0.6, -0.8, 0.5 mm   v 1 m/s   d 1.118   streamlines v");
  EXPECT_EQ(value_words(values[0], true), "1 (0.8, 0.6, 0)");
  EXPECT_EQ(line_words({}, "mm"), "");
}

TEST(Values, OutsideOfADomainThereIsNone) {
  FieldValue value;
  value.name = "d";
  value.value = 3;
  EXPECT_EQ(value_words(value), "outside");
  EXPECT_EQ(line_words({Vec3(1, 2, 3), "", {value}}, ""), "1, 2, 3");
}

}  // namespace values_test
}  // namespace catena::app
