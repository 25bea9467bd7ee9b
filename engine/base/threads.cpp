#include "engine/base/threads.h"

namespace catena {

Error no_thread(const std::string& what, const std::system_error& error) {
  return {what + ": no other thread can be started (" + error.code().message() +
              "); more processes (ulimit -u) or more memory (ulimit -v) were expected",
          true};
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
