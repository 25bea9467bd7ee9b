// SPDX-License-Identifier: MIT
/// A test case as a process of its own: what is stopped, killed or limited must not be the test program.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace catena::test {

struct ChildSetting {
  std::vector<std::string> environment;  ///< "NAME=VALUE", beside this process's own
  std::string out = "/dev/null";         ///< where its standard output goes
};

/// Starts this very program with one disabled case; the caller waits for it (waitpid).
pid_t start_case(const std::string& suite_dot_case, const ChildSetting& setting = {});
/// The value of a variable that start_case set; skips the case (false) where it was not set.
std::string child_variable(const char* name);

}  // namespace catena::test
