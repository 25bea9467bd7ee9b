// SPDX-License-Identifier: MIT
/// Numbers the test cases for fault.h, and passes the number on to child processes. Only trees with planted faults build it.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "tests/mutation/fault.h"

namespace catena::mutation {
namespace {

class Listener : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo& test) override {
    if (the_switch.reach == nullptr) return;
    the_switch.test_case = __atomic_add_fetch(reinterpret_cast<int*>(the_switch.reach), 1, __ATOMIC_RELAXED);
    const std::string name = std::string(program_invocation_short_name) + " " + test.test_suite_name() + "." + test.name();
    std::strncpy(reinterpret_cast<char*>(the_switch.name(the_switch.test_case)), name.c_str(), kNameBytes - 1);
    setenv("CATENA_FAULT_CASE", std::to_string(the_switch.test_case).c_str(), 1);
  }
  void OnTestEnd(const testing::TestInfo&) override { the_switch.test_case = 0; }
};

const bool is_listening = (testing::UnitTest::GetInstance()->listeners().Append(new Listener), true);

}  // namespace
}  // namespace catena::mutation
