// SPDX-License-Identifier: MIT
/// `catena trace`: seed patterns, tolerances and the .vtp file.

#include <cmath>
#include <cstring>

#include "engine/base/numbers.h"
#include "tests/engine/app/program_in_folder.h"

namespace catena::trace_test {

class TraceLines : public test::ProgramInFolder {
 protected:
  void SetUp() override {
    succeed("generate circle -o {v.vdb} --resolution 32");
    write("s.json", "{\"fields\": {\"v\": {\"file\": \"v.vdb\"}, \"r\": {\"analytic\": \"sphere\"}}}");
    write("seeds.csv", "x,y,z\n0.5,0,0\n1,0.5,0.25\n");
  }
  /// Traces from the file of seeds, or from a pattern.
  test::ProgramResult trace(const std::string& options, const std::string& pattern = "") const {
    return pattern.empty() ? succeed("trace {s.json} --field v --seeds {seeds.csv} " + options)
                           : succeed("trace {s.json} --field v " + options, {"--seeds", pattern});
  }
  static std::size_t rows_of(const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1; }
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
  trace("-o {l.vtp}");
  trace("-o {l.csv}");
  const std::string file = read("l.vtp"), table = read("l.csv");
  test::expect_parts(file, {"NumberOfLines=\"2\""});
  const auto s = doubles_of(file, "s"), points = doubles_of(file, "Points"), tangents = doubles_of(file, "tangent"),
             velocities = doubles_of(file, "velocity");
  ASSERT_EQ(s.size(), rows_of(table));
  ASSERT_EQ(points.size(), 3 * s.size());
  std::size_t at = table.find('\n') + 1;
  double line = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const std::size_t end = table.find('\n', at);
    std::vector<double> cells;
    for (std::size_t from = at; from < end;) {
      const std::size_t to = std::min(table.find(',', from), end);
      cells.push_back(*parse_double(table.substr(from, to - from)));
      from = to + 1;
    }
    at = end + 1;
    EXPECT_TRUE(cells[0] == line || cells[0] == line + 1) << i;
    line = cells[0];
    EXPECT_EQ(cells[1], s[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(cells[2 + k], points[3 * i + k]);
      EXPECT_EQ(cells[5 + k], tangents[3 * i + k]);
    }
    EXPECT_NEAR(velocities[3 * i], -points[3 * i + 1], 1e-6);
    EXPECT_NEAR(velocities[3 * i + 1], points[3 * i], 1e-6);
  }
  EXPECT_EQ(line, 1);
  EXPECT_TRUE(file.ends_with("</AppendedData>\n</VTKFile>\n"));
}

TEST_F(TraceLines, PatternsAreGivenAsTextOrFile) {
  const std::string pattern = R"({"line": {"from": [0.25, 0, 0], "to": [1.5, 0, 0], "count": 5}})";
  test::expect_parts(trace("-o {a.csv}", pattern).out, {"5 lines", "LAP 10"});
  write("p.json", pattern);
  succeed("trace {s.json} --field v --seeds {p.json} -o {b.csv}");
  EXPECT_EQ(read("a.csv"), read("b.csv"));
  trace("-o {c.vtp} --stats {c.json}", R"({"isosurface": {"field": "r", "level": 1, "count": 7}})");
  test::expect_parts(read("c.json"), {"\"lines\": 7"});
}

TEST_F(TraceLines, ALargerToleranceGivesFewerPoints) {
  trace("-o {exact.csv}");
  trace("-o {loose.vtp} --tolerance 1e-7");
  const auto points = doubles_of(read("loose.vtp"), "Points");
  EXPECT_LT(2 * points.size() / 3, rows_of(read("exact.csv")));
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const double radius = std::hypot(points[i], points[i + 1]);
    EXPECT_LT(std::min(std::fabs(radius - 0.5), std::fabs(radius - std::hypot(1, 0.5))), 1e-5);
  }
}

TEST_F(TraceLines, ErrorsAreOneLine) {
  const std::string line = "trace {s.json} --field v -o {o.csv} ";
  expect_refused(line, {"--seeds:1:"}, {"--seeds", "{\"line\": {\"from\": [0, 0, 0]}}"});
  expect_refused(line, {"--seeds"}, {"--seeds", "{\"line\": "});
  expect_refused(line + "--seeds {none.json}", {"none.json"});
  expect_refused(line, {"unknown field \"q\""}, {"--seeds", R"({"isosurface": {"field": "q", "level": 1, "count": 7}})"});
  expect_refused(line + "--seeds {seeds.csv} --tolerance 1", {"tolerance"});
  expect_refused(line + "--seeds {seeds.csv} --stats {o.csv}", {"expected two"});
}

}  // namespace catena::trace_test
