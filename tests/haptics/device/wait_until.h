// SPDX-License-Identifier: MIT
/// A wait with a limit, for conditions of other threads and processes.
#pragma once
#include <chrono>
#include <thread>

namespace catena::test {

/// True once the condition holds; false after 30 s.
template <class F>
bool wait_until(F&& condition) {
  for (int i = 0; i < 60000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  return condition();
}

}  // namespace catena::test
