#include "engine/base/result.h"

#include <cstdio>
#include <cstdlib>

namespace catena {

void assertion_failed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "catena: a bug: %s at %s:%d\n", expression, file, line);
  std::abort();
}

}  // namespace catena
