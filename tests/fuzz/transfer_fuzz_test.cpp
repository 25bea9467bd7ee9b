// SPDX-License-Identifier: MIT
/// Hostile transfer function files: a drawable transfer function, or an error in one line with the file's name.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/color_maps.h"
#include "engine/scene/readers.h"
#include "tests/fuzz/mutate.h"
#include "tests/support/support.h"

namespace catena::transfer_fuzz_test {

/// Two files of this program, then two of ParaView.
const std::string kFiles[] = {
    R"({ /* bone */ "color": [[-1000, 0.2, 0.1, 0.1], [200, 0.9, 0.8, 0.7], [3000, 1, 1, 1]], "opacity": [[200, 0], [400, 0.2], [1e3, 0.9]],
         "opacity_unit": 1.5, "gradient_opacity": [[0, 0], [50, 0.5], [300, 1]] })",
    R"({"color": "plasma_r", "range": [0.5, 80], "extinction": [[0.5, 0], [80, 3]]})",
    R"([{"ColorSpace": "Diverging", "Name": "Cool to Warm", "NanColor": [1, 1, 0], "RGBPoints": [0, 0.23, 0.3, 0.754, 0.5, 0.865, 0.865, 0.865,
         1, 0.706, 0.016, 0.15], "Points": [0, 0, 0.5, 0, 1, 1, 0.5, 0]}])",
    R"([{"ColorSpace": "HSV", "RGBPoints": [-1, 0, 0, 1, 1, 1, 0, 0]}])"};

template <class Table>
void expect_rising(const Table& table, const std::string& text) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_TRUE(std::isfinite(table[i].value)) << text;
    EXPECT_TRUE(i == 0 || table[i - 1].value < table[i].value) << text;
  }
}

bool check(const std::string& text) {
  const auto read = scene::parse_transfer(text, "t.json");
  if (!read) {
    test::expect_error_line(read.error().message, "t.json:", text, 1000, "");
    return false;
  }
  const auto colors = scene::make_color_table(read->colors, read->named, -1, 1);
  expect_rising(colors, text);
  for (const auto& point : colors)
    for (const float c : {point.color.r, point.color.g, point.color.b}) EXPECT_TRUE(c >= 0 && c <= 1) << c << " for\n" << text;
  expect_rising(read->opacities, text);
  expect_rising(read->extinctions, text);
  for (const auto& point : read->opacities) EXPECT_TRUE(point.alpha >= 0 && point.alpha < 1) << text;
  for (const auto& point : read->extinctions) EXPECT_TRUE(point.sigma >= 0) << text;
  for (const auto& point : read->gradient_factors) EXPECT_TRUE(point.gradient >= 0 && point.factor >= 0 && point.factor <= 1) << text;
  return true;
}

TEST(TransferFuzz, EveryTruncationAndEveryByteFlip) {
  for (const std::string& seed : kFiles) {
    EXPECT_TRUE(check(seed)) << seed;
    test::truncate_and_flip(seed, check, seed.size());
  }
}

TEST(TransferFuzz, Mutations) {
  test::fuzz(20000, 4, [](test::Random& random, std::uint64_t n) {
    return check(test::mutate(kFiles[(n % 2 == 0 ? 0 : 2) + random.below(2)], random));
  });
}

/// Any range with any file: a rescaled function, or an error in one line.
TEST(TransferFuzz, FilesWithExtremeRanges) {
  const test::TemporaryFolder folder;
  const std::string ranges[] = {"[0, 1]", "[1, 0]", "[-1e38, 1e38]", "[0, 1e-45]", "[1, 1.0000001]", "[\"a\", 1]", "{}", "[1e300, 2e300]"};
  for (const std::string& seed : kFiles) {
    test::write_file(folder / "t.json", seed);
    for (const std::string& range : ranges) {
      const auto object = json::parse("{\"transfer\": \"t.json\", \"range\": " + range + "}", folder / "s.json");
      ASSERT_TRUE(object);
      const auto transfer = scene::read_transfer(folder / "s.json", *object);
      if (!transfer) {
        EXPECT_TRUE(transfer.error().message.starts_with(folder / "s.json:1: ")) << transfer.error().message;
        continue;
      }
      expect_rising(transfer->colors, range);
      expect_rising(transfer->opacities, range);
      expect_rising(transfer->extinctions, range);
    }
  }
}

}  // namespace catena::transfer_fuzz_test
