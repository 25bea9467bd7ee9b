// SPDX-License-Identifier: MIT
/// Runs the program `catena` as a user would.
#pragma once
#include <string>
#include <vector>

namespace catena::test {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal number if killed
  std::string out, err;
};

/// Runs a program without a shell and with empty standard input.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments);
/// Runs `catena` of this build.
ProgramResult run_catena(const std::vector<std::string>& arguments);
/// Runs `catena` and expects exit code 0.
ProgramResult expect_run(const std::vector<std::string>& arguments);

/// Columns of a CSV: numbers if they parse, otherwise texts.
class Table {
 public:
  static Table read(const std::string& path);
  std::size_t rows() const { return cells_.size(); }
  bool has(const std::string& column) const;
  double number(std::size_t row, const std::string& column) const;
  std::string text(std::size_t row, const std::string& column) const;
  const std::vector<std::string>& header() const { return header_; }

 private:
  std::size_t index(const std::string& column) const;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> cells_;
};

}  // namespace catena::test
