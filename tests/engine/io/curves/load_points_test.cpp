// SPDX-License-Identifier: MIT
#include "engine/io/curves/load_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/memory_limit.h"

namespace catena::curves {
namespace load_points_test {

std::string message_of(const Result<PointSet>& set) { return set ? "" : set.error().message; }

TEST(PointTable, ReadsEverySeparatorAndColumnOrder) {
  const std::string tables[] = {"x,y,z,t\n1,2,3,4\n-1.5,0,1e2,5\n", "t;z;Y;X\r\n4;3;2;1\r\n\"5\";1e2; 0 ;-1.5\r\n",
                                "\n\"x\"\t\"y\"\t\"z\"\t\"t\"\n1\t2\t3\t4\n-1.5\t0\t100\t5",
                                "# x   y z  t\n1 2  3\t4\n  -1.5 0 100 5  \n\n"};
  for (const std::string& table : tables) {
    const auto set = parse_points(table, "a.csv");
    ASSERT_TRUE(set) << message_of(set) << "\n" << table;
    ASSERT_EQ(set->points.size(), 2u) << table;
    EXPECT_EQ(set->points[0], glm::vec3(1, 2, 3));
    EXPECT_EQ(set->points[1], glm::vec3(-1.5f, 0, 100));
    ASSERT_NE(set->find_values("t"), nullptr);
    EXPECT_EQ(set->find_values("t")->values, (std::vector<float>{4, 5}));
    EXPECT_EQ(set->min_corner, Vec3(-1.5, 0, 3));
    EXPECT_EQ(set->max_corner, Vec3(1, 2, 100));
    EXPECT_NEAR(set->median_spacing, std::sqrt(2.5 * 2.5 + 4 + 97 * 97), 1e-4);
  }
}

TEST(PointTable, ReadsMissingValuesAndSkipsTextColumns) {
  const auto set = parse_points("name,x,y,z,v\nfirst,1,2,3,\nsecond,4,5,6,7\nthird,4,5,6,nan\n", "a.csv");
  ASSERT_TRUE(set) << message_of(set);
  EXPECT_EQ(set->note, "columns without numbers were left out: \"name\"");
  ASSERT_EQ(set->values.size(), 1u);
  EXPECT_TRUE(std::isnan(set->values[0].values[0]));
  EXPECT_EQ(set->values[0].values[1], 7);
  EXPECT_TRUE(std::isnan(set->values[0].values[2]));
}

TEST(PointTable, ErrorsNameThePositionAndTheExpectation) {
  EXPECT_EQ(message_of(parse_points("t,x,y\n1,2,3\n", "a.csv")),
            "a.csv:1: there is no column z: the first line is \"t,x,y\"; a table of points with columns x, y, z was expected");
  EXPECT_EQ(message_of(parse_points("x,y,z,X\n1,2,3,4\n", "a.csv")), "a.csv:1: there are two columns x; one was expected");
  EXPECT_EQ(message_of(parse_points("x,y,z\n1,2,3\n1,2\n", "a.csv")),
            "a.csv:3: the row has 2 cells; 3 were expected, one for each column name");
  EXPECT_EQ(message_of(parse_points("x,y,z\n1,nan,3\n", "a.csv")), "a.csv:2: y is \"nan\"; a number up to 1e15 in size was expected");
  EXPECT_EQ(message_of(parse_points("x,y,z\n1,1e16,3\n", "a.csv")), "a.csv:2: y is \"1e16\"; a number up to 1e15 in size was expected");
  EXPECT_EQ(message_of(parse_points("x,y,z,v\n1,2,3,4\n1,2,3,q\n", "a.csv")),
            "a.csv:3: \"v\" is \"q\"; a number or an empty cell was expected");
  EXPECT_EQ(message_of(parse_points("x,y,z\n\n", "a.csv")),
            "a.csv:2: the table has no rows after the column names; rows of numbers were expected");
  EXPECT_EQ(message_of(parse_points("x,y,z", "a.csv")),
            "a.csv:1: the table has no rows after the column names; rows of numbers were expected");
  EXPECT_NE(message_of(parse_points("", "a.csv")).find("there is no column x"), std::string::npos);
}

TEST(PointTable, MemoryIsCheckedBeforeReading) {
  std::string table = "x,y,z\n";
  for (int i = 0; i < 200000; ++i) table += "1,2,3\n";
  set_memory_limit(std::uint64_t{1} << 20);
  const auto set = parse_points(table, "a.csv");
  set_memory_limit(std::nullopt);
  EXPECT_NE(message_of(set).find("a.csv: 200001 points needs"), std::string::npos) << message_of(set);
}

}  // namespace load_points_test
}  // namespace catena::curves
