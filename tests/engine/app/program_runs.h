// SPDX-License-Identifier: MIT
/// Runs of the program `catena` that succeed or are refused, and parts of texts.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/results.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::test {

using Words = std::vector<std::string>;

/// EXPECT_TRUE(is_one_line(text)): one line with its end.
inline testing::AssertionResult is_one_line(const std::string& text) {
  if (std::count(text.begin(), text.end(), '\n') == 1 && text.ends_with('\n')) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "not one line: " << text;
}

inline Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Runs `catena` with the words and more of them; it must succeed.
inline ProgramResult run_ok(const Words& words, const Words& more = {}) { return expect_run(joined(words, more)); }

/// Runs `catena`; it must end with exit code 2 and one line on standard error that has the part.
inline ProgramResult run_refused(const Words& words, const std::string& part = "") {
  ProgramResult run = run_catena(words);
  EXPECT_EQ(run.exit_code, 2) << testing::PrintToString(words) << "\n" << run.out << run.err;
  EXPECT_TRUE(is_one_line(run.err)) << testing::PrintToString(words);
  EXPECT_TRUE(has(run.err, part)) << testing::PrintToString(words);
  return run;
}

}  // namespace catena::test
