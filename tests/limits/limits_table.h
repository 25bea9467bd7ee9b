// SPDX-License-Identifier: MIT
/// The table of limits: the behaviour at extreme inputs. run() returns the observed behaviour as machine-independent sentences, such as
/// "status OK; off the line at most 1e-09 L", which must equal the row's expectation word for word. Numbers in sentences are bounds, never
/// measured figures. docs/reference/limits.md is generated from the table. One row: build/release/test_limits --gtest_filter='*NAME*'.
#pragma once
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::extremes {

struct Row {
  std::string name;                  ///< name of the test case
  std::string input;                 ///< description of the input
  std::string expected;              ///< expected behaviour
  std::function<std::string()> run;  ///< returns the observed behaviour; empty: tested by `proved_by`
  std::string should = {};           ///< correct behaviour, for a known defect
  std::string proved_by = {};        ///< `Suite.Case` of another test program
};

/// Prints a row in the messages of a failing case.
inline void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

/// A row that is tested by another test program.
inline Row proved_elsewhere(std::string asked, std::string expected, std::string proved_by) {
  return {{}, std::move(asked), std::move(expected), nullptr, {}, std::move(proved_by)};
}

struct Group {
  std::string title;
  std::vector<Row> rows;
};

/// Groups in the order of the document, each defined in its own file.
Group probe_rows();
Group world_rows();
Group index_rows();
Group coupling_rows();
Group critical_rows();
Group flow_rows();
Group grid_rendering_rows();
Group image_rows();
Group command_rows();
Group measure_rows();

/// Collects the sentences of a row's result.
class Findings {
 public:
  Findings& add(const std::string& sentence) {
    text_ += (text_.empty() ? "" : "; ") + sentence;
    return *this;
  }
  /// Adds "WHAT at most BOUND UNIT", or the measured value if it exceeds the bound, so that the row fails with the figure.
  Findings& at_most(const std::string& what, double value, double bound, const std::string& unit = {});
  /// Adds "WHAT in every case", or the number of cases.
  Findings& all(const std::string& what, long long count, long long of);
  const std::string& text() const { return text_; }
  operator std::string() const { return text_; }

 private:
  std::string text_;
};

/// Thrown to end a row; the message is its observed behaviour.
struct RowFailure {
  std::string message;
};

/// Returns the value, or ends the row with the error message.
template <class T>
T get(Result<T> result) {
  if (!result) throw RowFailure{result.error().message};
  return std::move(*result);
}

}  // namespace catena::extremes
