// SPDX-License-Identifier: MIT
#include "engine/base/result.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "engine/base/console.h"

namespace catena {

namespace {
std::atomic<bool> reported{false};
}  // namespace

bool assertion_was_reported() noexcept { return reported; }

void assertion_failed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "catena: a bug: %s at %s:%d\n", expression, file, line);
  reported = true;
  std::abort();
}

}  // namespace catena
