// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/io/curves/load_points.h"
#include "tests/fuzz/mutate.h"

namespace catena::points_fuzz_test {

const std::string kTables[] = {"name,x,y,z,v\nfirst,1,2,3,\nsecond,4,5,6,7\nthird,4,5.5e-3,6,nan\n",
                               "x y z radius\n1 2 3 4\n-1 -2 -3 0.5\n", "x\ty\tz\n1\t2\t3\n4\t5\t6\n"};

bool check(const std::string& text) {
  const auto set = curves::parse_points(text, "file.csv");
  if (!set) {
    test::expect_error_line(set.error().message, "file.csv:", text);
    return false;
  }
  EXPECT_FALSE(set->points.empty());
  for (const glm::vec3& p : set->points) EXPECT_TRUE(is_finite(Vec3(p)));
  for (const curves::PointValues& one : set->values) EXPECT_EQ(one.values.size(), set->points.size());
  return true;
}

TEST(PointsFuzz, Mutations) {
  const auto accepted = [](test::Random& random, std::uint64_t) {
    return std::ranges::count_if(kTables, [&](const std::string& table) { return check(test::mutate(table, random)); });
  };
  test::fuzz(6000, 6, accepted, 3);
}

}  // namespace catena::points_fuzz_test
