// SPDX-License-Identifier: MIT
// The plug-in level_ball.so. Its initializer creates the file CATENA_TEST_MARK, so that tests detect whether its code has run.
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

CATENA_CONSTRAINT_PLUGIN(extension_points_test::level_ball_constraint)
