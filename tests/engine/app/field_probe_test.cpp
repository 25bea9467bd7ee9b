// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/field_probe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/results.h"

namespace catena::app::field_probe_test {

using test::value_of;

TEST(FieldProbe, EveryLoadedFieldHasAValueAndAUnit) {
  auto scene = value_of(scene::parse_scene(R"({"unit_length": "mm", "fields": {
    "v": {"analytic": "circle", "unit": "m/s"}, "d": {"analytic": "sphere"}, "unused": {"analytic": "plane"}}})",
                                           "s.json"));
  const Vec3 at(0.6, -0.8, 0.5);
  EXPECT_TRUE(sample_fields(scene, at).empty()) << "nothing is loaded for it";
  for (const char* name : {"v", "d"}) ASSERT_TRUE(scene::resolve_field(scene, name, json::Node{}));
  const auto values = sample_fields(scene, at);
  ASSERT_EQ(values.size(), 2u);
  EXPECT_EQ(values[0].name, "v");
  EXPECT_EQ(values[0].unit, "m/s");
  ASSERT_TRUE(values[0].vector);
  EXPECT_EQ(*values[0].vector, Vec3(0.8, 0.6, 0));
  EXPECT_NEAR(values[0].value, 1, 1e-15);
  EXPECT_NEAR(values[1].value, std::sqrt(1.25), 1e-15);
  EXPECT_EQ(format_point_samples({at, "streamlines v", values}, "mm"), "0.6, -0.8, 0.5 mm   v 1 m/s   d 1.118   streamlines v");
  EXPECT_EQ(format_sample(values[0], true), "1 (0.8, 0.6, 0)");
  EXPECT_EQ(format_point_samples({}, "mm"), "");
}

TEST(FieldProbe, ALabelIsShownByItsName) {
  const test::TemporaryFolder folder;
  std::string bytes;
  for (int n = 0; n < 8 * 8 * 8; ++n) bytes += static_cast<char>(n % 8 < 3 ? 1 : n % 8 < 6 ? 0 : 9);
  test::write_file(folder / "m.raw", bytes);
  auto scene = value_of(scene::parse_scene(R"({"fields": {"m": {"file": "m.raw", "shape": [8, 8, 8], "type": "uint8",
    "labels": {"values": [1], "names": ["Precentral_L"]}}}})",
                                           folder / "s.json"));
  ASSERT_TRUE(scene::resolve_field(scene, "m", {}));
  const auto words = [&](double x) { return format_sample(sample_fields(scene, {x, 2.2, 3.4}).at(0)); };
  EXPECT_EQ(words(1.3), "Precentral_L (1)");
  EXPECT_EQ(words(2.7), "near Precentral_L (1)") << "a surface lies halfway";
  EXPECT_EQ(words(4.2), "no label");
  EXPECT_EQ(words(6.8), "9");
  EXPECT_EQ(words(9), "outside");
}

TEST(FieldProbe, OutsideOfADomainThereIsNoValue) {
  FieldSample value;
  value.name = "d";
  value.value = 3;
  EXPECT_EQ(format_sample(value), "outside");
  EXPECT_EQ(format_point_samples({Vec3(1, 2, 3), "", {value}}, ""), "1, 2, 3");
}

}  // namespace catena::app::field_probe_test
