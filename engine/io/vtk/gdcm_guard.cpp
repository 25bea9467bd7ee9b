// SPDX-License-Identifier: MIT
#include "engine/io/vtk/gdcm_guard.h"

#include <unistd.h>

#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

namespace {

std::jmp_buf after_assertion;
bool is_guarded = false;

}  // namespace

/// Replaces the C library's function, which every library of the process calls when an assertion fails.
extern "C" [[noreturn]] __attribute__((visibility("default"))) void __assert_fail(const char* assertion, const char*, unsigned,
                                                                                  const char*) noexcept {
  if (is_guarded) std::longjmp(after_assertion, 1);
  static_cast<void>(::write(STDERR_FILENO, assertion, std::strlen(assertion)) + ::write(STDERR_FILENO, "\n", 1));
  std::abort();
}

namespace catena::vtk {

bool call_gdcm(const std::function<void()>& call) {
  if (setjmp(after_assertion) != 0) {
    is_guarded = false;
    return false;
  }
  is_guarded = true;
  try {
    call();
  } catch (const std::bad_alloc&) {
    is_guarded = false;
    throw;
  } catch (const std::exception&) {
    is_guarded = false;
    return false;
  }
  is_guarded = false;
  return true;
}

}  // namespace catena::vtk
