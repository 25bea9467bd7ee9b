// SPDX-License-Identifier: MIT
#include "engine/base/threads.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>

#include "engine/base/system_failure.h"

namespace catena {

int thread_start_errno() {
  if (!resource_limit(RLIMIT_AS)) return EAGAIN;
  if (!resource_limit(RLIMIT_NPROC)) return ENOMEM;
  std::size_t stack = 8u << 20;
  if (pthread_attr_t attributes; pthread_getattr_default_np(&attributes) == 0) {
    pthread_attr_getstacksize(&attributes, &stack);
    pthread_attr_destroy(&attributes);
  }
  void* const tried = ::mmap(nullptr, stack, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (tried == MAP_FAILED) return ENOMEM;
  ::munmap(tried, stack);
  return EAGAIN;
}

bool is_thread_start_failure(const std::exception& thrown) {
  const auto* error = dynamic_cast<const std::system_error*>(&thrown);
  return (error != nullptr && error->code() == std::errc::resource_unavailable_try_again) ||
         std::strstr(thrown.what(), "pthread_create") != nullptr || std::strstr(thrown.what(), std::strerror(EAGAIN)) != nullptr;
}

Error thread_start_error(const std::string& what, const std::system_error& error) {
  const int code = is_thread_start_failure(error) ? thread_start_errno() : error.code().value();
  return {what + ": no other thread can be started: " + describe_errno(code), true};
}

}  // namespace catena

#ifndef CATENA_THREAD_SANITIZER
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#endif

namespace catena {

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
#ifdef CATENA_THREAD_SANITIZER
  static_cast<void>(grain);
  if (count > 0) body(0, count);
#else
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
#endif
}

}  // namespace catena
