// SPDX-License-Identifier: MIT
#include "tests/support/child_test.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "engine/base/result.h"

namespace catena::test {

pid_t start_case(const std::string& suite_dot_case, const ChildSetting& setting) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<std::string> words{self, "--gtest_filter=" + suite_dot_case, "--gtest_also_run_disabled_tests"};
  std::vector<char*> arguments, environment;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::vector<std::string> own = setting.environment;
  for (std::string& variable : own) environment.push_back(variable.data());
  for (char** e = environ; *e != nullptr; ++e)
    if (!std::string_view(*e).starts_with("GTEST_")) environment.push_back(*e);
  environment.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, setting.out.c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  CATENA_ASSERT(posix_spawn(&child, self.c_str(), &actions, nullptr, arguments.data(), environment.data()) == 0);
  posix_spawn_file_actions_destroy(&actions);
  return child;
}

std::string child_variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

}  // namespace catena::test
