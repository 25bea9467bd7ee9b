// SPDX-License-Identifier: MIT
#include "engine/scene/label_table.h"

#include <filesystem>

#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::label_table_test {

LabelTable table_of(const std::string& text) { return value_of(parse_label_table(text, "t.txt")); }

std::string refused(const std::string& text) { return message_of(parse_label_table(text, "t.txt")); }

TEST(LabelTables, ReadsFreeSurferTables) {
  const LabelTable table =
      table_of("#No. Label Name:  R   G   B   A\r\n\r\n0   Unknown  0 0 0 0\r\n17  Left-Hippocampus  220 216 20  0\r\n");
  ASSERT_EQ(table.size(), 2u);
  EXPECT_EQ(table[1].value, 17);
  EXPECT_EQ(table[1].name, "Left-Hippocampus");
  EXPECT_EQ(table[1].color, (Color{220 / 255.f, 216 / 255.f, 20 / 255.f}));
}

TEST(LabelTables, ReadsItkSnapTables) {
  const LabelTable table = table_of(
      "# ITK-SnAP Label Description File\n    0     0    0    0        0  0  0    \"Clear Label\"\n"
      "    5   255    0  255        1  1  1    \"Left Ventricle 2\"\n");
  ASSERT_EQ(table.size(), 2u);
  EXPECT_EQ(table[1].name, "Left Ventricle 2");
  EXPECT_EQ(table[1].color, (Color{1, 0, 1}));
}

TEST(LabelTables, ReadsNumbersAndNames) {
  const LabelTable table = table_of("2 Precentral_R 2002\r\n1 Precentral_L 2001\r\n7\tGenu of corpus callosum\n");
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0].name, "Precentral_L");
  EXPECT_EQ(table[1].name, "Precentral_R");
  EXPECT_EQ(table[2].name, "Genu of corpus callosum");
  EXPECT_FALSE(table[0].color);
}

TEST(LabelTables, ReadsColumnsByTheirNames) {
  for (const char separator : {',', '\t', ';'}) {
    std::string text = "r,g,b,name,index\n0.5,1,0,\"a name\",12\n0,0,1,other,3\n";
    std::replace(text.begin(), text.end(), ',', separator);
    const LabelTable table = table_of(text);
    ASSERT_EQ(table.size(), 2u);
    EXPECT_EQ(table[0].value, 3);
    EXPECT_EQ(table[1].name, "a name");
    EXPECT_EQ(table[1].color, (Color{0.5f, 1, 0}));
  }
  EXPECT_EQ(table_of("id,label,red,green,blue\n4,x,255,0,51\n")[0].color, (Color{1, 0, 0.2f}));
}

TEST(LabelTables, ErrorsNameTheLine) {
  EXPECT_EQ(refused("1 a\nx b\n"), "t.txt:2: the row begins with \"x\"; an integer label of magnitude at most 16777216 was expected");
  EXPECT_EQ(refused("1.5 a\n").substr(0, 8), "t.txt:1:");
  EXPECT_EQ(refused("1 a\n2\n"), "t.txt:2: label 2 has no name; a name was expected after the number");
  EXPECT_EQ(refused("# nothing\n"), "t.txt: the table has no labels; rows with a number and a name were expected");
  EXPECT_NE(refused("1 a 300 0 0 0\n").find("colour component \"300\""), std::string::npos);
}

TEST(LabelTables, TheFirstOfEqualLabelsCountsAndNamesAreShortAndPrintable) {
  EXPECT_EQ(table_of("1 a\n1 b\n")[0].name, "a");
  EXPECT_EQ(table_of("1 " + std::string(300, 'x'))[0].name.size(), 200u);
  EXPECT_EQ(table_of("1 a\x1b[2J")[0].name, "a?[2J");
}

TEST(LabelTables, TheTableNextToALabelMapIsFoundWithItsColors) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(find_label_table(folder / "a.nii.gz"), "");
  std::string lut(768, '\0');
  lut[1] = '\xff';
  test::write_file(folder / "a.nii.lut", lut);
  EXPECT_EQ(find_label_table(folder / "a.nii.gz"), "") << "colours alone are no table";
  test::write_file(folder / "a.nii.txt", "1 one\n2 two\n");
  EXPECT_EQ(find_label_table(folder / "a.nii.gz"), folder / "a.nii.txt");
  const auto table = read_label_table(folder / "a.nii.txt");
  ASSERT_TRUE(table);
  EXPECT_EQ((*table)[0].color, (Color{1, 0, 0}));
  EXPECT_FALSE((*table)[1].color) << "black is none";
  test::write_file(folder / "b.csv", "index,name\n1,x\n");
  for (const char* map : {"b.vdb", "b.nrrd", "b.MHA", "b.nii"}) EXPECT_EQ(find_label_table(folder / map), folder / "b.csv") << map;
}

TEST(LabelTables, ReadsATableOfADebianPackage) {
  const std::string path = "/usr/share/mricron/templates/aal.nii.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path;
  const LabelTable table = value_of(read_label_table(path));
  ASSERT_EQ(table.size(), 116u);
  EXPECT_EQ(table.front().name, "Precentral_L");
  EXPECT_EQ(table.back().name, "Vermis_10");
}

}  // namespace catena::scene::label_table_test
