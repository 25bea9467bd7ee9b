// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/base/csv.h"
#include "tests/fuzz/mutate.h"

namespace catena {
namespace csv_fuzz_test {

const std::string kPath =
    "t,x,y,z,buttons\r\n0,0.05,0,0,0\r\n0.001,0.0499,1e-3,-0,1\r\n0.002,0.04,.002,+3,2\r\n0.003,1e-300,0.5,7,4294967295\r\n";
const std::string kSeeds = "x,y,z\n1,2,3\n-0.5,0.25,1e3\n0,0,0\n";

template <class T>
bool check(const Result<std::vector<T>>& result, const std::string& text) {
  if (result) {
    EXPECT_FALSE(result->empty());
    return true;
  }
  const std::string& message = result.error().message;
  EXPECT_TRUE(message.starts_with("path.csv:")) << message << "\nfor\n" << text;
  EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message << "\nfor\n" << text;
  EXPECT_NE(message.find("expected"), std::string::npos) << message;
  EXPECT_LT(message.size(), 500u) << message;
  return false;
}

TEST(CsvFuzz, TheSeedsAreValid) {
  EXPECT_EQ(parse_probe_path(kPath, "path.csv")->size(), 4u);
  EXPECT_EQ(parse_seeds(kSeeds, "path.csv")->size(), 3u);
}

TEST(CsvFuzz, EveryTruncationAndEveryByteFlip) {
  for (std::size_t n = 0; n < kPath.size(); ++n) {
    check(parse_probe_path(kPath.substr(0, n), "path.csv"), kPath.substr(0, n));
    std::string text = kPath;
    text[n] = static_cast<char>(text[n] ^ 0x81);
    check(parse_probe_path(text, "path.csv"), text);
  }
}

TEST(CsvFuzz, Mutations) {
  test::FuzzInputs inputs(20000, 3);
  test::Random& random = inputs.random;
  std::uint64_t read = 0;
  while (inputs.next() && !HasFailure()) {
    const std::string path = test::mutate(kPath, random), seeds = test::mutate(kSeeds, random);
    const auto rows = parse_probe_path(path, "path.csv");
    read += check(rows, path) ? 1 : 0;
    check(parse_seeds(seeds, "path.csv"), seeds);
    if (!rows) continue;
    for (std::size_t k = 0; k < rows->size(); ++k) {
      EXPECT_TRUE(is_finite((*rows)[k].position)) << path;
      if (k > 0) {
        EXPECT_GT((*rows)[k].t_s, (*rows)[k - 1].t_s) << path;
      }
    }
  }
  EXPECT_GT(read, 0u);
  EXPECT_LT(read, inputs.count());
}

TEST(CsvFuzz, LongTexts) {
  EXPECT_FALSE(check(parse_seeds(std::string(1000000, ','), "path.csv"), ""));
  EXPECT_FALSE(check(parse_seeds("x,y,z\n" + std::string(1000000, ','), "path.csv"), ""));
  EXPECT_FALSE(check(parse_seeds("x,y,z\n1,2," + std::string(1000000, '9'), "path.csv"), ""));
  EXPECT_FALSE(check(parse_seeds("x,y,z\n" + std::string(1000000, '\n') + "1,2,3", "path.csv"), ""));
}

}  // namespace csv_fuzz_test
}  // namespace catena
