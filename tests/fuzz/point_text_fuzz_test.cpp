// SPDX-License-Identifier: MIT
/// Hostile points of options such as `catena measure --line`: as many finite points as expected, or none.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "engine/base/point_text.h"
#include "tests/fuzz/mutate.h"

namespace catena::point_text_fuzz_test {

const std::string kPoints[] = {"1,2,3", "-0.5,.25,1e3:0,0,1e-320", "1,0,0: 0,+2,0 :0,0,-1.5e300"};

bool check(const std::string& text) {
  bool valid = false;
  for (std::size_t count = 1; count <= 3; ++count) {
    const auto points = parse_points(text, count);
    if (!points) continue;
    EXPECT_FALSE(valid) << text << ": as two numbers of points";
    valid = true;
    EXPECT_EQ(points->size(), count);
    std::string again;
    for (const Vec3& p : *points) {
      EXPECT_TRUE(is_finite(p)) << text;
      again += fmt::format("{}{},{},{}", again.empty() ? "" : ":", p.x, p.y, p.z);
    }
    EXPECT_EQ(parse_points(again, count), points) << text;
  }
  return valid;
}

TEST(PointTextFuzz, TheSeedsAreValid) {
  for (std::size_t n = 0; n < 3; ++n) EXPECT_TRUE(parse_points(kPoints[n], n + 1)) << kPoints[n];
  for (const char* wrong : {"", ",,", "1,2", "1,2,3,4", "1,2,3:", "1,2,inf", "nan,0,0", "1;2;3", "1,2,3:4,5", "1:2:3"})
    EXPECT_FALSE(check(wrong)) << wrong;
}

TEST(PointTextFuzz, EveryTruncationAndEveryByteFlip) {
  for (const std::string& points : kPoints) test::truncate_and_flip(points, check);
}

TEST(PointTextFuzz, Mutations) {
  test::fuzz(20000, 31, [](test::Random& random, std::uint64_t) { return check(test::mutate(kPoints[random.below(3)], random)); });
}

}  // namespace catena::point_text_fuzz_test
