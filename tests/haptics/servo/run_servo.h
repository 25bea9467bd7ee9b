// SPDX-License-Identifier: MIT
/// Runs a servo with a limited number of ticks to its end.
#pragma once
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "haptics/servo/servo.h"

namespace catena::test {

inline void run_to_end(haptics::Servo& servo) {
  EXPECT_TRUE(servo.start());
  while (servo.running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  servo.stop();
}

}  // namespace catena::test
