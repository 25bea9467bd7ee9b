// SPDX-License-Identifier: MIT
#include "engine/io/curves/load_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/memory_limit.h"
#include "tests/support/results.h"

namespace catena::curves::load_points_test {

using namespace catena::test;

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
  const auto set = value_of(parse_points("name,x,y,z,v\nfirst,1,2,3,\nsecond,4,5,6,7\nthird,4,5,6,nan\n", "a.csv"));
  EXPECT_EQ(set.note, "columns without numbers were left out: \"name\"");
  ASSERT_EQ(set.values.size(), 1u);
  EXPECT_TRUE(std::isnan(set.values[0].values[0]));
  EXPECT_EQ(set.values[0].values[1], 7);
  EXPECT_TRUE(std::isnan(set.values[0].values[2]));
}

TEST(PointTable, ErrorsNameThePositionAndTheExpectation) {
  const char* none = "the table has no rows after the column names; rows of numbers were expected";
  for (const auto& [table, message] : {
           std::pair{"t,x,y\n1,2,3\n",
                     std::string("1: there is no column z: the first line is \"t,x,y\"; a table of points with columns x, y, "
                                 "z was expected")},
           {"x,y,z,X\n1,2,3,4\n", "1: there are two columns x; one was expected"},
           {"x,y,z\n1,2,3\n1,2\n", "3: the row has 2 cells; 3 were expected, one for each column name"},
           {"x,y,z\n1,nan,3\n", "2: y is \"nan\"; a number up to 1e15 in size was expected"},
           {"x,y,z\n1,1e16,3\n", "2: y is \"1e16\"; a number up to 1e15 in size was expected"},
           {"x,y,z,v\n1,2,3,4\n1,2,3,q\n", "3: \"v\" is \"q\"; a number or an empty cell was expected"},
           {"x,y,z\n\n", std::string("2: ") + none},
           {"x,y,z", std::string("1: ") + none},
       })
    EXPECT_EQ(message_of(parse_points(table, "a.csv")), "a.csv:" + message);
  EXPECT_TRUE(fails(parse_points("", "a.csv"), "there is no column x"));
}

TEST(PointTable, MemoryIsCheckedBeforeReading) {
  std::string table = "x,y,z\n";
  for (int i = 0; i < 200000; ++i) table += "1,2,3\n";
  set_memory_limit(std::uint64_t{1} << 20);
  const auto set = parse_points(table, "a.csv");
  set_memory_limit(std::nullopt);
  EXPECT_TRUE(fails(set, "a.csv: 200001 points needs"));
}

}  // namespace catena::curves::load_points_test
