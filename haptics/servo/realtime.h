// SPDX-License-Identifier: MIT
/// Real-time properties of a thread, as far as the machine permits: fixed priority, memory that is never paged out, a CPU core of its own.
/// Each property that is not permitted becomes a note of one sentence, and the thread runs without it.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/export.h"

namespace catena::haptics {

/// Real-time properties that a servo's thread requests.
struct RealtimeOptions {
  bool fifo = true;                        ///< request a fixed priority (SCHED_FIFO)
  int priority = 80;                       ///< fixed priority, 1..98; the watchdog has one more
  bool lock_memory = true;                 ///< request memory that is never paged out
  int cpu = kAnyWithFifo;                  ///< core to bind to, or one of the following constants
  static constexpr int kAnyWithFifo = -1;  ///< last allowed core, if there is more than one and the fixed priority was granted
  static constexpr int kUnbound = -2;      ///< not bound to a core
};

/// Real-time properties that were granted.
struct RealtimeReport {
  bool fifo = false;               ///< fixed priority
  bool locked = false;             ///< all memory of the process is locked
  int cpu = -1;                    ///< core to which the thread is bound; -1: none
  std::vector<std::string> notes;  ///< properties that were not permitted, one sentence each
};

/// Gives the calling thread a fixed priority (SCHED_FIFO, not inherited by children). Returns false if not permitted, with a sentence added
/// to `notes`.
CATENA_EXPORT bool acquire_fifo_priority(int priority, std::vector<std::string>& notes);
/// Limits how long this process may run at a fixed priority without blocking: after `soft_s` SIGXCPU, after `hard_s` SIGKILL, so that a
/// tick that never ends does not lock up the machine. Never raises a limit. A servo that is merely too slow releases its priority earlier
/// (servo.h).
CATENA_EXPORT void limit_realtime_run(double soft_s, double hard_s) noexcept;
inline constexpr double kRealtimeSoftLimit_s = 2, kRealtimeHardLimit_s = 3;  ///< limits that a servo sets for its process, seconds

/// Returns the calling thread to normal priority.
CATENA_EXPORT void release_fifo_priority() noexcept;

/// Lets the calling thread run on all cores allowed to the process, although the thread that created it is bound to one.
CATENA_EXPORT void reset_cpu_affinity() noexcept;

/// Prepares the calling thread before its first tick: fixed priority, core, locked memory with the stack touched. All memory of the process
/// is locked (as pages are touched) if locking is unlimited; otherwise only the stack and `own`, as far as the limit allows, because a lock
/// on all memory would make later allocations fail. The destructor undoes it, on the same thread.
class CATENA_EXPORT RealtimeThread {
 public:
  /// Prepares the calling thread; `own` is memory to lock if not all of it can be.
  RealtimeThread(const RealtimeOptions& options, const void* own, std::size_t own_bytes);
  ~RealtimeThread();
  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;

  /// Returns the properties that were granted.
  const RealtimeReport& report() const { return report_; }

 private:
  void lock(const void* own, std::size_t own_bytes);
  void bind(int cpu);

  RealtimeReport report_;
  struct LockedRange {
    const void* at;
    std::size_t bytes;
  };
  std::vector<LockedRange> locked_ranges_;
};

}  // namespace catena::haptics
