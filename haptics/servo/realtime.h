/// What makes a thread a hard-real-time one, as far as the machine permits: fixed priority, memory that is never paged out, a
/// core of its own. Whatever is not permitted becomes one plain sentence, and the thread goes on without it.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace catena::haptics {

/// What a servo's thread asks for.
struct RealtimeOptions {
  bool fifo = true;                        ///< ask for a fixed priority
  int priority = 80;                       ///< 1..98; the watchdog has one more
  bool lock_memory = true;                 ///< ask for memory that is never paged out
  int cpu = kAnyWithFifo;                  ///< the core to stay on, or one of these:
  static constexpr int kAnyWithFifo = -1;  ///< the last allowed core, if there is more than one and the priority was granted
  static constexpr int kUnbound = -2;      ///< wherever the system likes
};

/// What it got.
struct RealtimeReport {
  bool fifo = false;               ///< a fixed priority
  bool locked = false;             ///< all of the process's memory
  int cpu = -1;                    ///< -1: not bound to a core
  std::vector<std::string> notes;  ///< what was not permitted, a sentence each
};

/// Fixed priority (SCHED_FIFO, not inherited by children) for the calling thread. On failure one sentence in `notes`.
bool acquire_fifo_priority(int priority, std::vector<std::string>& notes);
/// How long this process may run at a fixed priority without a pause: beyond `soft_s` SIGXCPU, beyond `hard_s` SIGKILL, so that a tick that
/// never ends gives the machine back. Only ever lowers a limit. A servo that is merely too slow has left the priority before (servo.h).
void limit_realtime_run(double soft_s, double hard_s) noexcept;
inline constexpr double kRealtimeSoftLimit_s = 2, kRealtimeHardLimit_s = 3;  ///< what a servo sets for its process, seconds

/// Back to normal priority.
void release_fifo_priority() noexcept;

/// The calling thread may run wherever the process may, though the thread that made it is bound to a core.
void reset_cpu_affinity() noexcept;

/// Prepares the calling thread before its first tick: touches its stack, then priority, core, memory. The whole process is locked
/// (as pages are touched) where that is unlimited; otherwise only the stack and `own`, as far as the limit goes: a lock on all
/// memory would make later allocations fail. Undone by the destructor, on the same thread.
class RealtimeThread {
 public:
  /// Of the calling thread; `own` is memory to lock where not all can be.
  RealtimeThread(const RealtimeOptions& options, const void* own, std::size_t own_bytes);
  ~RealtimeThread();
  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;

  /// What it got.
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
