// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/base/csv.h"
#include "tests/fuzz/mutate.h"

namespace catena::csv_fuzz_test {

const std::string kPath =
    "t,x,y,z,buttons\r\n0,0.05,0,0,0\r\n0.001,0.0499,1e-3,-0,1\r\n0.002,0.04,.002,+3,2\r\n0.003,1e-300,0.5,7,4294967295\r\n";
const std::string kSeeds = "x,y,z\n1,2,3\n-0.5,0.25,1e3\n0,0,0\n";

template <class T>
bool check(const Result<std::vector<T>>& result, const std::string& text) {
  if (result) {
    EXPECT_FALSE(result->empty());
    return true;
  }
  test::expect_error_line(result.error().message, "path.csv:", text);
  return false;
}

TEST(CsvFuzz, TheSeedsAreValid) {
  EXPECT_EQ(parse_probe_path(kPath, "path.csv")->size(), 4u);
  EXPECT_EQ(parse_seeds(kSeeds, "path.csv")->size(), 3u);
}

TEST(CsvFuzz, EveryTruncationAndEveryByteFlip) {
  test::truncate_and_flip(kPath, [](const std::string& text) { return check(parse_probe_path(text, "path.csv"), text); });
}

TEST(CsvFuzz, Mutations) {
  test::fuzz(20000, 3, [](test::Random& random, std::uint64_t) {
    const std::string path = test::mutate(kPath, random), seeds = test::mutate(kSeeds, random);
    const auto rows = parse_probe_path(path, "path.csv");
    check(parse_seeds(seeds, "path.csv"), seeds);
    if (!check(rows, path)) return false;
    for (std::size_t k = 0; k < rows->size(); ++k) {
      EXPECT_TRUE(is_finite((*rows)[k].position)) << path;
      EXPECT_TRUE(k == 0 || (*rows)[k].t_s > (*rows)[k - 1].t_s) << path;
    }
    return true;
  });
}

TEST(CsvFuzz, LongTexts) {
  for (const std::string& text : {std::string(1000000, ','), "x,y,z\n" + std::string(1000000, ','),
                                  "x,y,z\n1,2," + std::string(1000000, '9'), "x,y,z\n" + std::string(1000000, '\n') + "1,2,3"})
    EXPECT_FALSE(check(parse_seeds(text, "path.csv"), text.substr(0, 20))) << text.substr(0, 20);
}

}  // namespace catena::csv_fuzz_test
