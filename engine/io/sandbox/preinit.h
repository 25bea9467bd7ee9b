/// What a helper program does before the constructors of the shared libraries that it is linked to. Some of those start threads, and throw
/// where the machine gives none, long before main().
#pragma once

// The sanitizers set themselves up in the same section: nothing of Catena may run before them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CATENA_BEFORE_LIBRARIES(function)
#else
/// `function` is void() noexcept, and uses nothing that a constructor makes. In the file of main().
#define CATENA_BEFORE_LIBRARIES(function) [[gnu::section(".preinit_array"), gnu::used]] static void (*before_libraries)() = function
#endif
