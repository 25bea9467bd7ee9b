// SPDX-License-Identifier: MIT
/// A test case in a child process, to be stopped, killed or limited instead of the test program.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace catena::test {

struct ChildSetting {
  std::vector<std::string> environment;  ///< "NAME=VALUE", in addition to this process's
  std::string out = "/dev/null";         ///< file for its standard output
};

/// Starts this test program with one disabled case; the caller waits for it (waitpid).
pid_t start_case(const std::string& suite_dot_case, const ChildSetting& setting = {});
/// Value of a variable that start_case set; empty if it is not set, so that the case is skipped.
std::string child_variable(const char* name);

}  // namespace catena::test
