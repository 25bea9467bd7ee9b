// SPDX-License-Identifier: MIT
/// Monotonic wall-clock time and CPU time in nanoseconds, and the time since the process started (for `first_frame_ms`).
#pragma once
#include <cstdint>

#include "engine/base/export.h"

namespace catena {

/// Returns the monotonic time in nanoseconds since an arbitrary start. Any thread.
CATENA_EXPORT std::int64_t now_ns();
/// Returns the milliseconds elapsed since `start_ns`, an earlier result of now_ns().
CATENA_EXPORT double ms_since(std::int64_t start_ns);
/// Returns the CPU time in nanoseconds that all threads of this process have used; other processes do not count. Any thread.
CATENA_EXPORT std::int64_t process_cpu_ns();
/// Returns the milliseconds since the kernel started this process. The start time is read from /proc on the first call; where that fails,
/// the time counts from the first call.
CATENA_EXPORT double ms_since_process_start();

}  // namespace catena
