/// A bug in Catena itself: checked in every build type, prints the place and aborts.
#pragma once

namespace catena {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);
}

#define CATENA_ASSERT(expression) ((expression) ? static_cast<void>(0) : ::catena::assertion_failed(#expression, __FILE__, __LINE__))
