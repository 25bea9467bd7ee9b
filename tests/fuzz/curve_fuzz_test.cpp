// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/io/curves/load_curves.h"
#include "tests/fuzz/mutate.h"
#include "tests/fuzz/mutate_bytes.h"
#include "tests/support/curve_files.h"

namespace catena::curve_fuzz_test {

const test::Polylines kLines{{{1, 2, 3}, {1.5, 2.25, -3}, {8, 0, 0}}, {{-1, 0, 0.125}, {-1, 4, 0.125}}, {{0, 0, 0}, {1, 0, 0}}};

std::string trk() {
  test::TrkFile file;
  file.lines = kLines;
  file.scalars = {"FA", "MD"};
  file.properties = 1;
  file.voxel = {2, 3, 4};
  return file.bytes();
}

bool check(const Result<curves::CurveSet>& set) {
  if (!set) {
    test::expect_error_line(set.error().message, "file.curves:", {});
    return false;
  }
  EXPECT_GT(set->line_count(), 0u);
  EXPECT_EQ(set->line_offsets.front(), 0u);
  EXPECT_EQ(set->line_offsets.back(), set->points.size());
  for (std::size_t k = 0; k < set->line_count(); ++k) {
    EXPECT_GE(set->line_offsets[k + 1], set->line_offsets[k] + 2);
    for (std::uint32_t i = set->line_offsets[k] + 1; i < set->line_offsets[k + 1]; ++i) EXPECT_NE(set->points[i - 1], set->points[i]);
  }
  for (const glm::vec3& p : set->points) EXPECT_TRUE(is_finite(Vec3(p)));
  for (const curves::PointValues& one : set->values) EXPECT_EQ(one.values.size(), set->points.size());
  return true;
}

bool tck(const std::string& bytes) { return check(curves::parse_tck(bytes, "file.curves")); }
bool trk(const std::string& bytes) { return check(curves::parse_trk(bytes, "file.curves")); }

TEST(CurveFuzz, EveryTruncationAndEveryByteFlip) {
  const std::string a = test::tck_bytes(kLines, "Float32LE"), b = trk();
  EXPECT_TRUE(tck(a) && trk(b));
  test::truncate_and_flip(a, tck, a.size());
  test::truncate_and_flip(
      b, [](const std::string& bytes) { return trk(bytes); }, 1000);
}

TEST(CurveFuzz, Mutations) {
  const std::string files[] = {test::tck_bytes(kLines, "Float32LE"), test::tck_bytes(kLines, "Float64BE"), trk()};
  const auto accepted = [&](test::Random& random, std::uint64_t n) {
    int read = tck(test::mutate_bytes(files[0], random));
    read += tck(test::mutate_bytes(files[1], random, 3, 0, 80));
    read += tck(test::mutate(files[0], random));
    read += trk(test::mutate_bytes(files[2], random));
    // the numbers of the header and of the first line
    return read + trk(test::mutate_bytes(files[2], random, 2, n % 2 == 0 ? 0 : 990, 1030));
  };
  const auto [read, inputs] = test::fuzz(6000, 5, accepted, 5);
  EXPECT_GT(read, inputs / 2);
}

}  // namespace catena::curve_fuzz_test
