// SPDX-License-Identifier: MIT
#include "tests/support/run_program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "tests/support/support.h"

namespace catena::test {

ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const std::string out = folder / "out", err = folder / "err";
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const pid_t child = fork();
  CATENA_ASSERT(child >= 0);
  if (child == 0) {
    const int in_fd = open("/dev/null", O_RDONLY);
    const int out_fd = open(out.c_str(), O_WRONLY | O_CREAT, 0600), err_fd = open(err.c_str(), O_WRONLY | O_CREAT, 0600);
    dup2(in_fd, 0);
    dup2(out_fd, 1);
    dup2(err_fd, 2);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  int status = 0;
  CATENA_ASSERT(waitpid(child, &status, 0) == child);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(out), read_file(err)};
}

ProgramResult run_catena(const std::vector<std::string>& arguments) { return run_program(program_path(), arguments); }

ProgramResult expect_run(const std::vector<std::string>& arguments) {
  const ProgramResult result = run_catena(arguments);
  EXPECT_EQ(result.exit_code, 0) << testing::PrintToString(arguments) << "\n" << result.err;
  return result;
}

namespace {
std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  if (line.ends_with(',')) cells.emplace_back();
  return cells;
}
}  // namespace

Table Table::read(const std::string& path) {
  Table table;
  std::istringstream in(read_file(path));
  std::string line;
  CATENA_ASSERT(std::getline(in, line));
  table.header_ = split(line);
  while (std::getline(in, line)) {
    table.cells_.push_back(split(line));
    CATENA_ASSERT(table.cells_.back().size() == table.header_.size());
  }
  return table;
}

bool Table::has(const std::string& column) const { return std::find(header_.begin(), header_.end(), column) != header_.end(); }

std::size_t Table::index(const std::string& column) const {
  const auto it = std::find(header_.begin(), header_.end(), column);
  CATENA_ASSERT(it != header_.end());
  return static_cast<std::size_t>(it - header_.begin());
}

std::string Table::text(std::size_t row, const std::string& column) const { return cells_.at(row).at(index(column)); }

double Table::number(std::size_t row, const std::string& column) const {
  const auto value = parse_double(text(row, column));
  CATENA_ASSERT(value.has_value());
  return *value;
}

}  // namespace catena::test
