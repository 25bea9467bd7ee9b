// SPDX-License-Identifier: MIT
/// Runs code in a helper program before the constructors of its shared libraries. Some of these start threads, and throw when the system
/// refuses them, long before main().
#pragma once

// The sanitizers initialize themselves in the same section: no Catena code may run before them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CATENA_BEFORE_LIBRARIES(function)
#else
/// Registers `function`, a void() noexcept that uses nothing a constructor creates. Use it in the file of main().
#define CATENA_BEFORE_LIBRARIES(function) [[gnu::section(".preinit_array"), gnu::used]] static void (*before_libraries)() = function
#endif
