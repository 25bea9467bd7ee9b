// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/io/curves/load_points.h"
#include "tests/fuzz/mutate.h"

namespace catena {
namespace points_fuzz_test {

const std::string kTables[] = {"name,x,y,z,v\nfirst,1,2,3,\nsecond,4,5,6,7\nthird,4,5.5e-3,6,nan\n",
                               "x y z radius\n1 2 3 4\n-1 -2 -3 0.5\n", "x\ty\tz\n1\t2\t3\n4\t5\t6\n"};

bool check(const std::string& text) {
  const auto set = curves::parse_points(text, "file.csv");
  if (!set) {
    const std::string& message = set.error().message;
    EXPECT_TRUE(message.starts_with("file.csv:")) << message;
    EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
    EXPECT_NE(message.find("expected"), std::string::npos) << message;
    EXPECT_LT(message.size(), 500u) << message;
    return false;
  }
  EXPECT_FALSE(set->points.empty());
  for (const glm::vec3& p : set->points) EXPECT_TRUE(is_finite(Vec3(p)));
  for (const curves::PointValues& one : set->values) EXPECT_EQ(one.values.size(), set->points.size());
  return true;
}

TEST(PointsFuzz, Mutations) {
  test::FuzzInputs inputs(6000, 6);
  std::uint64_t read = 0;
  while (inputs.next() && !HasFailure())
    for (const std::string& table : kTables) read += check(test::mutate(table, inputs.random)) ? 1 : 0;
  EXPECT_GT(read, 0u);
  EXPECT_LT(read, 3 * inputs.count());
}

}  // namespace points_fuzz_test
}  // namespace catena
