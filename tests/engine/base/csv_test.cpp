// SPDX-License-Identifier: MIT
#include "engine/base/csv.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/memory_limit.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::csv_test {

using test::expect_error;

TEST(Csv, ReadsColumnsInAnyOrder) {
  const auto rows = test::value_of(parse_probe_path("t,x,y,z\n0,1,2,3\n0.001,-1e-3,.5,+7\n", "p.csv"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].t_s, 0.001);
  EXPECT_EQ(rows[1].position, Vec3(-1e-3, 0.5, 7));
  const auto turned = test::value_of(parse_probe_path("buttons, z ,y,x,t\n5,3,2,1,0\n", "p.csv"));
  EXPECT_EQ(turned[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(turned[0].buttons, 5u);
}

TEST(Csv, AcceptsTheFormatsOfSpreadsheets) {
  for (const char* text : {"\xEF\xBB\xBFt,x,y,z\r\n0,1,2,3\r\n", "t,x,y,z\n0,1,2,3", " t , x,y,z \n 0 , 1,\t2,3 \n\n\r\n  \n"}) {
    const auto rows = test::value_of(parse_probe_path(text, "p.csv"));
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].position, Vec3(1, 2, 3));
  }
}

TEST(Csv, HeaderErrorsAreReported) {
  expect_error(parse_probe_path("t,x,y\n0,1,2\n", "p.csv"),
               {"p.csv:1:", "\"z\" is missing", "\"t,x,y,z[,buttons][,qw,qx,qy,qz]\" was expected"});
  expect_error(parse_probe_path("t,x,y,z,w\n0,1,2,3,4\n", "p.csv"), {"p.csv:1:", "unknown column \"w\"", "expected"});
  expect_error(parse_probe_path("t,x,y,z,x\n0,1,2,3,4\n", "p.csv"), {"p.csv:1:", "duplicate column \"x\"", "expected"});
  expect_error(parse_probe_path("t,x,y,z,\n0,1,2,3,\n", "p.csv"), {"p.csv:1:", "unknown column \"\"", "expected"});
  expect_error(parse_probe_path("0,1,2,3\n", "p.csv"), {"p.csv:1:", "unknown column \"0\"", "t,x,y,z"});
  expect_error(parse_probe_path("T,x,y,z\n0,1,2,3\n", "p.csv"), {"p.csv:1:", "unknown column \"T\"", "t,x,y,z"});
  expect_error(parse_probe_path("t,x,y,z\r\n", "p.csv"), {"p.csv:1:", "header only", "row", "expected"});
  expect_error(parse_probe_path("", "p.csv"), {"p.csv:1:", "is empty", "expected"});
  expect_error(parse_probe_path("\n\n", "p.csv"), {"p.csv:1:", "is empty", "expected"});
  expect_error(parse_seeds("t,x,y,z\n0,1,2,3\n", "s.csv"), {"s.csv:1:", "unknown column \"t\"", "\"x,y,z\" was expected"});
}

TEST(Csv, AnOrientationHasAllColumnsAndIsNormalized) {
  const auto rows =
      test::value_of(parse_probe_path("t,x,y,z,buttons,qw,qx,qy,qz\n0,1,2,3,0,0.6,0.8,0,0\n1,1,2,3,1,0.7071,0,0,0.7071\n", "p.csv"));
  EXPECT_TRUE(rows[0].has_orientation);
  EXPECT_NEAR(rows[0].orientation.w, 0.6, 1e-15);
  EXPECT_NEAR(rows[0].orientation.x, 0.8, 1e-15);
  EXPECT_NEAR(rows[1].orientation.z, std::sqrt(0.5), 1e-15);  // normalized
  EXPECT_EQ(rows[1].buttons, 1u);
  const auto plain = test::value_of(parse_probe_path("t,x,y,z\n0,1,2,3\n", "p.csv"));
  EXPECT_FALSE(plain[0].has_orientation);
  EXPECT_EQ(plain[0].orientation, kIdentityRotation);
  expect_error(parse_probe_path("t,x,y,z,qw,qx,qz\n0,1,2,3,1,0,0\n", "p.csv"), {"p.csv:1:", "\"qy\" is missing", "qw,qx,qy,qz"});
  expect_error(parse_probe_path("t,x,y,z,qw,qx,qy,qz\n0,1,2,3,1,0,0,0\n1,1,2,3,0,0,0,0\n", "p.csv"),
               {"p.csv:3:", "length 0", "unit quaternion was expected"});
}

TEST(Csv, RowErrorsNameTheLine) {
  expect_error(parse_seeds("x,y,z\n0,1,2\n0,1\n", "s.csv"), {"s.csv:3:", "has 2 cells", "3 were expected"});
  expect_error(parse_seeds("x,y,z\n0,1,2,\n", "s.csv"), {"s.csv:2:", "has 4 cells", "3 were expected"});
  expect_error(parse_seeds("x,y,z\n0,1,abc\n", "s.csv"), {"s.csv:2:", "\"abc\" in column \"z\"", "finite number was expected"});
  expect_error(parse_seeds("x,y,z\n0,,2\n", "s.csv"), {"s.csv:2:", "\"\" in column \"y\"", "finite number was expected"});
  expect_error(parse_seeds("x,y,z\n0,1,2\n\n3,4,5\n", "s.csv"), {"s.csv:3:", "blank", "expected"});
  for (const char* bad : {"nan", "NaN", "inf", "-inf", "1e999", "0x10", "1 2", "1;2", "--1"})
    expect_error(parse_seeds("x,y,z\n0,1," + std::string(bad) + "\n", "s.csv"), {"s.csv:2:", bad, "finite number was expected"});
}

TEST(Csv, TimeMustIncreaseStrictly) {
  expect_error(parse_probe_path("t,x,y,z\n0,1,2,3\n0.1,1,2,3\n0.1,1,2,3\n", "p.csv"), {"p.csv:4:", "t is 0.1 after 0.1", "rising"});
  expect_error(parse_probe_path("t,x,y,z\n1,1,2,3\n0,1,2,3\n", "p.csv"), {"p.csv:3:", "t is 0 after 1", "rising"});
}

TEST(Csv, ButtonsAreAMask) {
  EXPECT_EQ((*parse_probe_path("t,x,y,z,buttons\n0,1,2,3,4294967295\n", "p.csv"))[0].buttons, 4294967295u);
  for (const char* bad : {"-1", "0.5", "4294967296"})
    expect_error(parse_probe_path("t,x,y,z,buttons\n0,1,2,3," + std::string(bad) + "\n", "p.csv"), {"p.csv:2:", bad, "whole number"});
}

TEST(Csv, UnreadableFilesAreRefused) {
  const test::TemporaryFolder folder;
  expect_error(read_seeds(folder / "none.csv"), {"none.csv", "No such file", "x,y,z", "expected"});
  expect_error(read_probe_path(folder.path()), {folder.path().c_str(), "is a folder", "expected"});
  test::write_file(folder / "s.csv", "x,y,z\n1,2,3\n");
  EXPECT_EQ(read_seeds(folder / "s.csv")->front(), Vec3(1, 2, 3));
}

TEST(Csv, ManyRowsKeepTheirValues) {
  std::string text = "t,x,y,z\n";
  for (int i = 0; i < 200000; ++i) text += std::to_string(i) + ",0.1,0.2," + std::to_string(2 * i) + "\n";
  const auto rows = test::value_of(parse_probe_path(text, "p.csv"));
  ASSERT_EQ(rows.size(), 200000u);
  EXPECT_EQ(rows.back().position.z, 399998.0);
}

// The memory of the rows is counted and limited.
TEST(Csv, TheMemoryOfRowsIsChecked) {
  std::string text = "t,x,y,z\n";
  for (int i = 0; i < 10000; ++i) text += std::to_string(i) + ",0,0,0\n";
  set_memory_limit(1000000);
  const auto path = parse_probe_path(text, "p.csv");
  for (int i = 0; i < 30000; ++i) text += std::to_string(10000 + i) + ",0,0,0\n";
  const auto longer = parse_probe_path(text, "p.csv");
  set_memory_limit(std::nullopt);
  expect_error(path, {"p.csv: a table of 10000 rows needs 3 MB of memory, expected at most 1 MB"});
  expect_error(longer, {"p.csv: a table of 40000 rows needs 2 MB of memory, expected at most 1 MB"});
}

}  // namespace catena::csv_test
