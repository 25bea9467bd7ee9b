// SPDX-License-Identifier: MIT
/// Report of unexpected skips. If CATENA_EXPECTED_SKIPS names a file (set by `.ci/run`), each skipped case that matches no line of the file
/// is printed as "unexpected skip", and its ctest entry fails. A line is an fnmatch pattern of `Suite.Case`, a space, and the reason.
#include <fnmatch.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace catena::test {
namespace {

class UnexpectedSkips : public testing::EmptyTestEventListener {
 public:
  explicit UnexpectedSkips(const char* file) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      if (!line.empty() && line.front() != '#') patterns_.push_back(line.substr(0, line.find(' ')));
    }
  }

  void OnTestEnd(const testing::TestInfo& test) override {
    if (!test.result()->Skipped()) return;
    const std::string name = std::string(test.test_suite_name()) + "." + test.name();
    for (const std::string& pattern : patterns_) {
      if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) return;
    }
    std::printf("unexpected skip: %s\n", name.c_str());
  }

 private:
  std::vector<std::string> patterns_;
};

const bool is_listening = [] {
  const char* file = std::getenv("CATENA_EXPECTED_SKIPS");
  if (file != nullptr) testing::UnitTest::GetInstance()->listeners().Append(new UnexpectedSkips(file));
  return file != nullptr;
}();

}  // namespace
}  // namespace catena::test
