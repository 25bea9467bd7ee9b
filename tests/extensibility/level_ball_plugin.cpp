// SPDX-License-Identifier: MIT
// The plug-in level_ball.so. Its initialiser leaves a mark, so that a test sees whether any of its code has run.
#include <cstdio>
#include <cstdlib>

#include "haptics/plugin/plugin.h"
#include "tests/extensibility/level_ball.h"

namespace {
const bool kRan = [] {
  if (const char* const mark = std::getenv("CATENA_TEST_MARK"))
    if (std::FILE* const file = std::fopen(mark, "w")) std::fclose(file);
  return true;
}();
}  // namespace

CATENA_CONSTRAINT_PLUGIN(newcomer_test::level_ball_constraint)
