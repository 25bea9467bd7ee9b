// SPDX-License-Identifier: MIT
/// `catena trace`: seed patterns, tolerances and the .vtp file.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine/base/numbers.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena {
namespace trace_test {

using test::ProgramResult;
using test::read_file;
using test::write_file;

ProgramResult catena_program(const std::vector<std::string>& arguments) { return test::run_catena(arguments); }

class TraceLines : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(catena_program({"generate", "circle", "-o", folder_ / "v.vdb", "--resolution", "32"}).exit_code, 0);
    write_file(folder_ / "s.json", "{\"fields\": {\"v\": {\"file\": \"v.vdb\"}, \"r\": {\"analytic\": \"sphere\"}}}");
    write_file(folder_ / "seeds.csv", "x,y,z\n0.5,0,0\n1,0.5,0.25\n");
  }
  ProgramResult trace(std::vector<std::string> more) {
    std::vector<std::string> all{"trace", folder_ / "s.json", "--field", "v"};
    all.insert(all.end(), more.begin(), more.end());
    return catena_program(all);
  }
  static std::size_t rows_of(const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1; }

  test::TemporaryFolder folder_;
};

/// The appended array of doubles with this name.
std::vector<double> doubles_of(const std::string& file, const std::string& name) {
  const std::size_t at = file.find("Name=\"" + name + "\""), offset_at = file.find("offset=\"", at) + 8;
  const std::size_t start = file.find("<AppendedData encoding=\"raw\">\n_") + 31 + std::stoul(file.substr(offset_at, 20));
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, file.data() + start, 8);
  std::vector<double> values(bytes / 8);
  std::memcpy(values.data(), file.data() + start + 8, bytes);
  return values;
}

TEST_F(TraceLines, PolyDataEqualsTheTable) {
  ASSERT_EQ(trace({"--seeds", folder_ / "seeds.csv", "-o", folder_ / "l.vtp"}).exit_code, 0);
  ASSERT_EQ(trace({"--seeds", folder_ / "seeds.csv", "-o", folder_ / "l.csv"}).exit_code, 0);
  const std::string file = read_file(folder_ / "l.vtp"), table = read_file(folder_ / "l.csv");
  EXPECT_NE(file.find("NumberOfLines=\"2\""), std::string::npos);
  const auto s = doubles_of(file, "s"), points = doubles_of(file, "Points"), tangents = doubles_of(file, "tangent"),
             velocities = doubles_of(file, "velocity");
  ASSERT_EQ(s.size(), rows_of(table));
  ASSERT_EQ(points.size(), 3 * s.size());
  std::size_t at = table.find('\n') + 1;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const std::size_t end = table.find('\n', at);
    std::vector<double> cells;
    for (std::size_t from = at; from < end;) {
      const std::size_t to = std::min(table.find(',', from), end);
      cells.push_back(*parse_double(table.substr(from, to - from)));
      from = to + 1;
    }
    at = end + 1;
    EXPECT_EQ(cells[1], s[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(cells[2 + k], points[3 * i + k]);
      EXPECT_EQ(cells[5 + k], tangents[3 * i + k]);
    }
    EXPECT_NEAR(velocities[3 * i], -points[3 * i + 1], 1e-6);
    EXPECT_NEAR(velocities[3 * i + 1], points[3 * i], 1e-6);
  }
  EXPECT_TRUE(file.ends_with("</AppendedData>\n</VTKFile>\n"));
}

TEST_F(TraceLines, PatternsAreGivenAsTextOrFile) {
  const std::string pattern = R"({"line": {"from": [0.25, 0, 0], "to": [1.5, 0, 0], "count": 5}})";
  const ProgramResult text = trace({"--seeds", pattern, "-o", folder_ / "a.csv"});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("5 lines"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("LAP 10"), std::string::npos) << text.out;
  write_file(folder_ / "p.json", pattern);
  ASSERT_EQ(trace({"--seeds", folder_ / "p.json", "-o", folder_ / "b.csv"}).exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "a.csv"), read_file(folder_ / "b.csv"));
  const ProgramResult surface = trace(
      {"--seeds", R"({"isosurface": {"field": "r", "level": 1, "count": 7}})", "-o", folder_ / "c.vtp", "--stats", folder_ / "c.json"});
  ASSERT_EQ(surface.exit_code, 0) << surface.err;
  EXPECT_NE(read_file(folder_ / "c.json").find("\"lines\": 7"), std::string::npos);
}

TEST_F(TraceLines, ALargerToleranceGivesFewerPoints) {
  ASSERT_EQ(trace({"--seeds", folder_ / "seeds.csv", "-o", folder_ / "exact.csv"}).exit_code, 0);
  ASSERT_EQ(trace({"--seeds", folder_ / "seeds.csv", "-o", folder_ / "loose.vtp", "--tolerance", "1e-7"}).exit_code, 0);
  const auto points = doubles_of(read_file(folder_ / "loose.vtp"), "Points");
  EXPECT_LT(2 * points.size() / 3, rows_of(read_file(folder_ / "exact.csv")));
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const double radius = std::hypot(points[i], points[i + 1]);
    EXPECT_LT(std::min(std::fabs(radius - 0.5), std::fabs(radius - std::hypot(1, 0.5))), 1e-5);
  }
}

TEST_F(TraceLines, ErrorsAreOneLine) {
  const auto refused = [&](const std::vector<std::string>& more, const std::string& words) {
    const ProgramResult result = trace(more);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
  };
  const std::string o = folder_ / "o.csv";
  refused({"--seeds", "{\"line\": {\"from\": [0, 0, 0]}}", "-o", o}, "--seeds:1:");
  refused({"--seeds", "{\"line\": ", "-o", o}, "--seeds");
  refused({"--seeds", folder_ / "none.json", "-o", o}, "none.json");
  refused({"--seeds", R"({"isosurface": {"field": "q", "level": 1, "count": 7}})", "-o", o}, "unknown field \"q\"");
  refused({"--seeds", folder_ / "seeds.csv", "-o", o, "--tolerance", "1"}, "tolerance");
  refused({"--seeds", folder_ / "seeds.csv", "-o", o, "--stats", o}, "expected two");
}

}  // namespace trace_test
}  // namespace catena
