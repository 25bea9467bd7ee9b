// SPDX-License-Identifier: MIT
#include "haptics/servo/realtime.h"

#include <linux/capability.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>

namespace catena::haptics {

namespace {

constexpr std::size_t kStackBytes = 256 * 1024;  // more than a tick ever uses

// Touches the pages of the stack below this frame, so that no tick faults on them.
[[gnu::noinline]] void touch_stack() {
  [[maybe_unused]] volatile unsigned char pages[kStackBytes];
  for (std::size_t i = 0; i < kStackBytes; i += 4096) pages[i] = 0;
}

std::string reason() { return std::strerror(errno); }

/// Returns instructions for obtaining a denied permission; `limit` is its name in limits.d.
std::string remedy(const char* limit) {
  return std::string("join the group catena of the Debian package (`adduser YOU catena`) and log in again, or raise ") + limit +
         " in /etc/security/limits.d";
}

/// Returns whether all future memory may be locked: under a limit, allocations of the process would fail.
bool may_lock_everything() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3] = {};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  return (data[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

// The lock on all memory belongs to the process: the last servo to end releases it.
std::mutex everything_mutex;
int everything_users = 0;

bool lock_everything() {
  const std::lock_guard hold(everything_mutex);
  if (everything_users == 0 && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) return false;
  ++everything_users;
  return true;
}

void unlock_everything() {
  const std::lock_guard hold(everything_mutex);
  if (--everything_users == 0) munlockall();
}

}  // namespace

bool acquire_fifo_priority(int priority, std::vector<std::string>& notes) {
  sched_param parameter{};
  parameter.sched_priority = std::clamp(priority, sched_get_priority_min(SCHED_FIFO), sched_get_priority_max(SCHED_FIFO));
  if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0) return true;
  notes.push_back("real-time scheduling was not permitted (" + reason() + "): " + remedy("rtprio"));
  return false;
}

void limit_realtime_run(double soft_s, double hard_s) noexcept {
  rlimit limit{};
  if (getrlimit(RLIMIT_RTTIME, &limit) != 0) return;
  limit.rlim_max = std::min(limit.rlim_max, static_cast<rlim_t>(1e6 * hard_s));
  limit.rlim_cur = std::min({limit.rlim_cur, limit.rlim_max, static_cast<rlim_t>(1e6 * soft_s)});
  setrlimit(RLIMIT_RTTIME, &limit);
}

void release_fifo_priority() noexcept {
  const sched_param parameter{};
  sched_setscheduler(0, SCHED_OTHER, &parameter);
}

void reset_cpu_affinity() noexcept {
  cpu_set_t cores;  // affinity of the first thread, which no servo binds
  if (sched_getaffinity(getpid(), sizeof cores, &cores) == 0) sched_setaffinity(0, sizeof cores, &cores);
}

RealtimeThread::RealtimeThread(const RealtimeOptions& options, const void* own, std::size_t own_bytes) {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // at normal priority a wake-up may be 50 us late by default
  if (options.fifo) report_.fifo = acquire_fifo_priority(options.priority, report_.notes);
  if (report_.fifo) limit_realtime_run(kRealtimeSoftLimit_s, kRealtimeHardLimit_s);
  if (options.cpu >= 0 || (options.cpu == RealtimeOptions::kAnyWithFifo && report_.fifo)) bind(options.cpu);
  if (options.lock_memory) lock(own, own_bytes);
}

RealtimeThread::~RealtimeThread() {
  if (report_.locked) unlock_everything();
  for (const LockedRange& part : locked_ranges_) munlock(part.at, part.bytes);
  if (report_.fifo) release_fifo_priority();
}

void RealtimeThread::bind(int cpu) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) {
    report_.notes.push_back("the thread was not bound to a core: the list of cores could not be read (" + reason() + ")");
    return;
  }
  const bool chosen = cpu >= 0;
  if (!chosen) {
    if (CPU_COUNT(&allowed) < 2) return;
    for (int i = 0; i < CPU_SETSIZE; ++i)
      if (CPU_ISSET(static_cast<unsigned>(i), &allowed)) cpu = i;
  }
  cpu_set_t one;
  CPU_ZERO(&one);
  if (cpu < CPU_SETSIZE) CPU_SET(static_cast<unsigned>(cpu), &one);
  if (cpu >= CPU_SETSIZE || sched_setaffinity(0, sizeof one, &one) != 0) {
    report_.notes.push_back("the thread was not bound to core " + std::to_string(cpu) + ": the thread is not allowed to run on this core");
    return;
  }
  report_.cpu = cpu;
}

void RealtimeThread::lock(const void* own, std::size_t own_bytes) {
  const bool everything = may_lock_everything() && lock_everything();
  touch_stack();
  report_.locked = everything;
  if (everything) return;
  const void* const stack = static_cast<const char*>(__builtin_frame_address(0)) - kStackBytes;  // the stack grows downward
  for (const LockedRange& part : {LockedRange{stack, kStackBytes}, LockedRange{own, own_bytes}})
    if (mlock(part.at, part.bytes) == 0) locked_ranges_.push_back(part);
  report_.notes.push_back(
      std::string("not all memory could be locked (") +
      (locked_ranges_.size() == 2 ? "the memory of the thread is locked): " : "the memory of the thread is not locked, either): ") +
      remedy("memlock"));
}

}  // namespace catena::haptics
