// SPDX-License-Identifier: MIT
/// Hostile label tables: labels that can be shown, or an error in one line with the file's name.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/label_table.h"
#include "tests/fuzz/mutate.h"

namespace catena::label_table_fuzz_test {

const std::string kFormats[] = {
    "#No. Label Name:  R   G   B   A\n\n0   Unknown  0 0 0 0\n17  Left-Hippocampus  220 216 20  0\n18 Left-Amygdala 103 255 255 0\n",
    "# ITK-SnAP Label Description File\n    0     0    0    0        0  0  0    \"Clear Label\"\n    5   255    0  255  1  1  1  \"Left "
    "Ventricle\"\n",
    "1 Precentral_L 2001\r\n2 Precentral_R 2002\r\n7\tGenu of corpus callosum\r\n",
    "index,name,r,g,b\n1,\"left, front\",0.5,1,0\n2,right,0,0,1\n", "id\tlabel\tred\tgreen\tblue\n4\tx y\t255\t0\t51\n5\tz\t0\t1\t2\n"};

bool check(const std::string& text) {
  const auto read = scene::parse_label_table(text, "t.txt");
  if (!read) {
    test::expect_error_line(read.error().message, "t.txt:", text, 1000, "");
    return false;
  }
  EXPECT_FALSE(read->empty());
  for (std::size_t i = 0; i < read->size(); ++i) {
    const scene::LabelRow& label = (*read)[i];
    EXPECT_EQ(label.value, std::nearbyint(label.value)) << text;
    EXPECT_TRUE(i == 0 || (*read)[i - 1].value < label.value) << text;
    EXPECT_FALSE(label.name.empty()) << text;
    EXPECT_LE(label.name.size(), 200u);
    for (const unsigned char c : label.name) EXPECT_GE(c, 0x20) << text;
    const Color color = label.color.value_or(Color{});
    for (const float c : {color.r, color.g, color.b}) EXPECT_TRUE(c >= 0 && c <= 1) << c << "\n" << text;
  }
  return true;
}

TEST(LabelTableFuzz, EveryTruncationAndEveryByteFlip) {
  for (const std::string& seed : kFormats) {
    EXPECT_TRUE(check(seed)) << seed;
    test::truncate_and_flip(seed, check);
  }
}

TEST(LabelTableFuzz, Mutations) {
  test::fuzz(1000 * std::size(kFormats), 11,
             [](test::Random& random, std::uint64_t n) { return check(test::mutate(kFormats[n % std::size(kFormats)], random)); });
}

}  // namespace catena::label_table_fuzz_test
