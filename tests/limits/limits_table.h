// SPDX-License-Identifier: MIT
/// The table of extremes: what happens at the ends of what can be asked. A row's expectation is written before the row is run, and holds
/// word for word: run() says what happened in sentences that hold on every machine, such as "status OK; off the line at most 1e-09 L".
/// docs/reference/limits.md is made from the table. A number within a sentence is a bound, never a measured figure.
/// One row: build/release/test_limits --gtest_filter='*NAME*'.
#pragma once
#include <ostream>
#include <string>
#include <vector>

namespace catena::extremes {

struct Row {
  std::string name;            ///< of the test case
  std::string input;           ///< what is done
  std::string expected;        ///< what happens
  std::string (*run)();        ///< what did happen; null: `proved_by` says it
  std::string should = {};     ///< of a known defect: what would be right
  std::string proved_by = {};  ///< the case of another test program, `Suite.Case`
};

/// For the messages of a failing case.
inline void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

/// What another test proves already.
inline Row proved_elsewhere(std::string asked, std::string expected, std::string proved_by) {
  return {{}, std::move(asked), std::move(expected), nullptr, {}, std::move(proved_by)};
}

struct Group {
  std::string title;
  std::vector<Row> rows;
};

/// In the order of the document; each in a file of its own.
Group probe_rows();
Group world_rows();
Group index_rows();
Group coupling_rows();
Group critical_rows();
Group flow_rows();
Group grid_rendering_rows();
Group image_rows();
Group command_rows();

/// What a row has found, one sentence after the other.
class Findings {
 public:
  Findings& add(const std::string& sentence) {
    text_ += (text_.empty() ? "" : "; ") + sentence;
    return *this;
  }
  /// "WHAT at most BOUND UNIT", or what it is instead: then the row fails, and its message has the figure.
  Findings& at_most(const std::string& what, double value, double bound, const std::string& unit = {});
  /// "WHAT in every case", or how many of how many.
  Findings& all(const std::string& what, long long count, long long of);
  const std::string& text() const { return text_; }
  operator std::string() const { return text_; }

 private:
  std::string text_;
};

}  // namespace catena::extremes
