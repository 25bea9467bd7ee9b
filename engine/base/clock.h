/// Monotonic wall time and processor time in nanoseconds, and the time since the process started (for `first_frame_ms`).
#pragma once
#include <cstdint>

namespace catena {

/// Monotonic time in nanoseconds since an arbitrary start. Any thread.
std::int64_t now_ns();
/// Milliseconds from an earlier now_ns() to now.
double ms_since(std::int64_t start_ns);
/// Processor time that all threads of this process have used so far, in nanoseconds; other programs do not count. Any thread.
std::int64_t process_cpu_ns();
/// Since the kernel started this process (reads its start time once; falls back to the first call).
double ms_since_process_start();

}  // namespace catena
