// SPDX-License-Identifier: MIT
/// Catena installed below the build folder, once for all tests of this program.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::test {

/// Runs CMake; a failure shows its output.
inline bool run_cmake(const std::vector<std::string>& arguments) {
  const ProgramResult result = run_program(CATENA_CMAKE, arguments);
  EXPECT_EQ(result.exit_code, 0) << "cmake " << testing::PrintToString(arguments) << "\n"
                                 << result.out.substr(0, 8000) << result.err.substr(0, 4000);
  return result.exit_code == 0;
}

/// The prefix with bin, lib, include and share.
inline const std::string& install_prefix() {
  static const std::string prefix = [] {
    const std::string at = binary_dir() + "/installed";
    std::filesystem::remove_all(at);  // from an earlier build
    run_cmake({"--install", binary_dir(), "--prefix", at});
    return at;
  }();
  return prefix;
}

/// Output of bash, including errors, for script lines in a folder, in an environment set up as in docs/user/start.md. The first failing
/// line ends the script. `before`: a program with options that starts bash.
inline ProgramResult run_shell(const std::string& folder, const std::string& lines, std::vector<std::string> before = {}) {
  const std::string& at = install_prefix();
  before.insert(before.end(), {"/bin/bash", "-c",
                               "set -euo pipefail; exec 2>&1; cd '" + folder + "'; export CATENA=" + at + " PATH=" + at +
                                   "/bin:$PATH PYTHONPATH=" + at + "/" CATENA_PYTHON_FOLDER " PYTHONDONTWRITEBYTECODE=1" +
                                   " CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER-" CATENA_LAUNCHER "}\n" + lines});
  return run_program("/usr/bin/env", before);
}

}  // namespace catena::test
