// SPDX-License-Identifier: MIT
// Runs the table's rows, one test case each, and compares docs/reference/limits.md with the table. CATENA_WRITE_DOCUMENTS=1 in the
// environment writes the document from the rows' results (./run docs).
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "engine/base/numbers.h"
#include "tests/limits/limits_table.h"
#include "tests/support/support.h"

namespace catena::extremes {

Findings& Findings::at_most(const std::string& what, double value, double bound, const std::string& unit) {
  const std::string end = to_text(bound) + (unit.empty() ? "" : " " + unit);
  return add(value <= bound ? what + " at most " + end : what + " " + to_text(value) + ", more than " + end);
}

Findings& Findings::all(const std::string& what, long long count, long long of) {
  return add(what + (count == of ? " in every case" : " in " + std::to_string(count) + " of " + std::to_string(of)));
}

namespace limits_test {

const std::vector<Group>& table() {
  static const std::vector<Group> all{probe_rows(), world_rows(),          index_rows(), coupling_rows(), critical_rows(),
                                      flow_rows(),  grid_rendering_rows(), image_rows(), command_rows(),  measure_rows()};
  return all;
}

std::vector<Row> rows_to_run() {
  std::vector<Row> rows;
  for (const Group& group : table())
    for (const Row& row : group.rows)
      if (row.run != nullptr) rows.push_back(row);
  return rows;
}

bool writes_documents() { return std::getenv("CATENA_WRITE_DOCUMENTS") != nullptr; }

std::map<std::string, std::string>& measured_results() {
  static std::map<std::string, std::string> by_name;
  return by_name;
}

class LimitTable : public testing::TestWithParam<Row> {};

TEST_P(LimitTable, Row) {
  std::string& result = measured_results()[GetParam().name];
  try {
    result = GetParam().run();
  } catch (const RowFailure& failure) {
    result = failure.message;
  }
  EXPECT_EQ(result, GetParam().expected) << GetParam().input;
}

INSTANTIATE_TEST_SUITE_P(Table, LimitTable, testing::ValuesIn(rows_to_run()), [](const auto& test) { return test.param.name; });

constexpr const char* kBegin = R"(# Limits

This page lists what Catena does with extreme input: values that are not finite, grids far from the origin, very large images. Every row
is a test case of `tests/limits`. It states its result in advance, word for word; the numbers in it are bounds.

**Known defect** marks a result that is wrong, and the last table gives the correct one. The last column names the test:
`build/release/test_limits --gtest_filter='*NAME*'` runs it. A name with a dot is a test of another program. `./run docs` writes this page.

L is the domain length, the longest edge of the domain. Words in capitals are [statuses and reasons](chain.md#statuses). "From LENGTH to
CRITICAL" states how a traced streamline ends upstream and downstream. "Visible" means that the image is not empty.
)";

/// The document with the rows' results, or with the expectations of rows that have not run.
std::string document() {
  std::string text = kBegin, defects;
  for (const Group& group : table()) {
    text += "\n## " + group.title + "\n\n| input | result | test |\n|---|---|---|\n";
    for (const Row& row : group.rows) {
      const auto found = measured_results().find(row.name);
      const std::string happens = row.run != nullptr && found != measured_results().end() ? found->second : row.expected;
      text += "| " + row.input + " | " + (row.should.empty() ? "" : "**Known defect:** ") + happens + " | `" +
              (row.run != nullptr ? row.name : row.proved_by) + "` |\n";
      if (!row.should.empty()) defects += "| `" + row.name + "` | " + row.should + " |\n";
    }
  }
  text += "\n## Known defects\n\n";
  return text + (defects.empty() ? "None is known.\n" : "| test | correct result |\n|---|---|\n" + defects);
}

const std::string& path() {
  static const std::string at = test::source_dir() + "/docs/reference/limits.md";
  return at;
}

class Writer : public testing::Environment {
  void TearDown() override {
    if (writes_documents() && !testing::UnitTest::GetInstance()->Failed()) test::write_file(path(), document());
  }
};
const testing::Environment* const kWriter = testing::AddGlobalTestEnvironment(new Writer);

TEST(LimitsDocument, MatchesTheRows) {
  if (writes_documents()) return;
  EXPECT_TRUE(test::read_file(path()) == document()) << "docs/reference/limits.md is not current; ./run docs writes it";
}

TEST(LimitsDocument, EveryRowHasAUniqueNameAndSingleLineTexts) {
  std::map<std::string, int> names;
  for (const Group& group : table())
    for (const Row& row : group.rows) {
      EXPECT_EQ(row.run == nullptr, row.name.empty()) << row.input;
      EXPECT_EQ(row.run == nullptr, !row.proved_by.empty()) << row.input;
      EXPECT_FALSE(row.expected.empty() || row.input.empty()) << row.name;
      for (const std::string& text : {row.input, row.expected, row.should}) EXPECT_EQ(text.find_first_of("|\n"), std::string::npos) << text;
      if (row.run == nullptr) continue;
      EXPECT_EQ(++names[row.name], 1) << row.name;
    }
}

}  // namespace limits_test
}  // namespace catena::extremes
