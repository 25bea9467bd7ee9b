// SPDX-License-Identifier: MIT
/// Starting threads without exceptions: a failure (limits on processes or memory) becomes an Error, because an exception of std::thread
/// could end a program while it drives a device. Also contains parallel_for.
#pragma once
#include <cstddef>
#include <exception>
#include <functional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "engine/base/result.h"

namespace catena {

/// Returns the errno of a thread that could not be started: ENOMEM when there is no address space for another stack, else EAGAIN
/// (pthread_create reports EAGAIN for both). To be called immediately, before any memory is freed.
int thread_start_errno();
/// Returns true when an exception of the standard library, TBB or ITK means that a thread could not be started.
bool is_thread_start_failure(const std::exception& thrown);

/// Makes a system failure "the servo: no other thread can be started: CAUSE" from the exception.
Error thread_start_error(const std::string& what, const std::system_error& error);

/// Starts a thread that runs `body`; `what` names its purpose in the error message, for example "the servo". Lack of memory is still thrown
/// as std::bad_alloc.
template <class Body>
Result<std::thread> start_thread(const std::string& what, Body&& body) {
  try {
    return std::thread(std::forward<Body>(body));
  } catch (const std::system_error& error) {
    return thread_start_error(what, error);
  }
}

/// parallel_for is the only use of TBB in Catena's own code. It runs serially under the thread sanitizer (libtbb is not instrumented).

/// Calls body(begin, end) on ranges of at least `grain` items that cover [0, count), on all cores. Blocks until all calls are done.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace catena
