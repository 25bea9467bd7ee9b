/// A thread, or one sentence why this machine gives none (limits on processes or memory): std::thread alone would throw, and end a
/// program that holds a device.
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

/// Why a thread could not be started, a code of errno: ENOMEM where this process gets no addresses for another stack, else EAGAIN.
/// pthread_create answers EAGAIN to both. To be asked at once, before anything is freed.
int thread_start_errno();
/// Whether an exception says that a thread could not be started: of the standard library, TBB or ITK.
bool is_thread_start_failure(const std::exception& thrown);

/// "the servo: no other thread can be started: CAUSE": an Error of the machine.
Error thread_start_error(const std::string& what, const std::system_error& error);

/// `what` needs it: "the servo". Out of memory is still std::bad_alloc.
template <class Body>
Result<std::thread> start_thread(const std::string& what, Body&& body) {
  try {
    return std::thread(std::forward<Body>(body));
  } catch (const std::system_error& error) {
    return thread_start_error(what, error);
  }
}

/// The only user of TBB in Catena's own code. Serial under the thread sanitizer (libtbb is not instrumented).

/// Calls body(begin, end) over [0, count) in pieces of at least `grain`, on all cores. Blocks until done.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace catena
