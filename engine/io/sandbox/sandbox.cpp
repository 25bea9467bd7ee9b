// SPDX-License-Identifier: MIT
#include "engine/io/sandbox/sandbox.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <linux/landlock.h>
#include <malloc.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <memory>

namespace catena::sandbox {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // the sanitizers map terabytes of addresses
#else
constexpr bool kSanitized = false;
#endif

/// Sets a limit, never above one that the shell has set, which root could exceed.
void set_limit(__rlimit_resource what, std::uint64_t soft, std::uint64_t hard) {
  rlimit limit{};
  if (::getrlimit(what, &limit) != 0) return;
  limit = {std::min<rlim_t>(soft, limit.rlim_cur), std::min<rlim_t>(hard, limit.rlim_max)};
  ::setrlimit(what, &limit);
}

/// Returns the size of the address space that this process has mapped; without /proc the size of the largest reader.
std::uint64_t mapped_bytes() {
  constexpr std::uint64_t kLargest = std::uint64_t{2} << 30;
  std::uint64_t pages = 0;
  if (!(std::ifstream("/proc/self/statm") >> pages)) return kLargest;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void set_limits(const ProcessLimits& limits) {
  // stacks of the worker threads, and what the C library reserves
  constexpr std::uint64_t kRoom = 512 << 20;
  ::mallopt(M_ARENA_MAX, 1);
  const bool limited = limits.memory_bytes < ~std::uint64_t{0} / 2;
  if (limited && !kSanitized)
    set_limit(RLIMIT_AS, mapped_bytes() + limits.memory_bytes + kRoom, mapped_bytes() + limits.memory_bytes + kRoom);
  if (limited && limits.only_memory_files) {
    ::signal(SIGXFSZ, SIG_IGN);
    set_limit(RLIMIT_FSIZE, limits.memory_bytes + kRoom, limits.memory_bytes + kRoom);
  }
  if (limits.cpu_s > 0) set_limit(RLIMIT_CPU, limits.cpu_s, std::max(limits.cpu_s, limits.max_cpu_s) + 1);
  set_limit(RLIMIT_CORE, 0, 0);
}

/// Adds a Landlock rule that allows reading in the folder. Returns false if that fails.
bool allow_reading(int ruleset, const std::string& folder) {
  landlock_path_beneath_attr rule{};
  rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
  rule.parent_fd = ::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (rule.parent_fd < 0) return false;
  const long done = ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  ::close(rule.parent_fd);
  return done == 0;
}

/// Makes the folder the root directory, by the right that a user has in a user namespace, or that root has.
bool change_root(const std::string& folder) {
  if (::chroot(folder.c_str()) != 0 && (::unshare(CLONE_NEWUSER) != 0 || ::chroot(folder.c_str()) != 0)) return false;
  return ::chdir("/") == 0;
}

/// Drops all capabilities, so that a process started by root has none to use, pass on or regain.
bool drop_capabilities() {
  ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  for (unsigned long capability = 0; ::prctl(PR_CAPBSET_READ, capability, 0, 0, 0) >= 0; ++capability)
    ::prctl(PR_CAPBSET_DROP, capability, 0, 0, 0);
  __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = {};
  return ::syscall(SYS_capset, &head, none) == 0;
}

/// Forbids opening, creating or removing files and folders, except for reading in `readable_folder`. Returns the Landlock version; 0 if it
/// is not available.
std::uint32_t landlock(const std::string& readable_folder) {
  const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return 0;
  landlock_ruleset_attr rules{};
  rules.handled_access_fs = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;  // all of the first version
#ifdef LANDLOCK_ACCESS_FS_REFER
  if (version >= 2) rules.handled_access_fs |= LANDLOCK_ACCESS_FS_REFER;
#endif
#ifdef LANDLOCK_ACCESS_FS_TRUNCATE
  if (version >= 3) rules.handled_access_fs |= LANDLOCK_ACCESS_FS_TRUNCATE;
#endif
  const long ruleset = ::syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0);
  if (ruleset < 0) return 0;
  if (!readable_folder.empty() && !allow_reading(static_cast<int>(ruleset), readable_folder)) {
    ::close(static_cast<int>(ruleset));
    return 0;
  }
  const long done = ::syscall(SYS_landlock_restrict_self, ruleset, 0);
  ::close(static_cast<int>(ruleset));
  return done == 0 ? static_cast<std::uint32_t>(version) : 0;
}

/// Allows the system calls for finding and opening files read-only.
bool allow_opening(scmp_filter_ctx filter) {
  constexpr int kCalls[] = {SCMP_SYS(stat),       SCMP_SYS(lstat),      SCMP_SYS(newfstatat), SCMP_SYS(statx),      SCMP_SYS(access),
                            SCMP_SYS(faccessat),  SCMP_SYS(faccessat2), SCMP_SYS(readlink),   SCMP_SYS(readlinkat), SCMP_SYS(getcwd),
                            SCMP_SYS(getdents64), SCMP_SYS(flock),      SCMP_SYS(fadvise64),  SCMP_SYS(uname),      SCMP_SYS(umask)};
  for (const int call : kCalls)
    if (seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) != 0) return false;
  constexpr scmp_datum_t kWriting = O_ACCMODE | O_CREAT | O_TRUNC;
  return seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(openat), 1, SCMP_A2(SCMP_CMP_MASKED_EQ, kWriting, O_RDONLY)) == 0 &&
         seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(open), 1, SCMP_A1(SCMP_CMP_MASKED_EQ, kWriting, O_RDONLY)) == 0 &&
         seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(fcntl), 1, SCMP_A1(SCMP_CMP_EQ, F_SETFD)) == 0 &&
         seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(fcntl), 1, SCMP_A1(SCMP_CMP_EQ, F_GETFD)) == 0;
}

/// Allows the system calls for reading and writing open descriptors, threads, memory, and exit. All others are refused with EPERM.
bool seccomp(bool opens_files, bool raises_time) {
  const std::unique_ptr<void, void (*)(void*)> filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)), [](void* f) { seccomp_release(f); });
  if (!filter) return false;
  constexpr int kAllowed[] = {SCMP_SYS(read),         SCMP_SYS(pread64),         SCMP_SYS(readv),
                              SCMP_SYS(write),        SCMP_SYS(pwrite64),        SCMP_SYS(writev),
                              SCMP_SYS(lseek),        SCMP_SYS(fstat),           SCMP_SYS(ftruncate),
                              SCMP_SYS(close),        SCMP_SYS(recvfrom),        SCMP_SYS(sendto),
                              SCMP_SYS(munmap),       SCMP_SYS(mremap),          SCMP_SYS(madvise),
                              SCMP_SYS(brk),          SCMP_SYS(futex),           SCMP_SYS(set_robust_list),
                              SCMP_SYS(rseq),         SCMP_SYS(sched_yield),     SCMP_SYS(sched_getaffinity),
                              SCMP_SYS(getcpu),       SCMP_SYS(clock_gettime),   SCMP_SYS(clock_nanosleep),
                              SCMP_SYS(nanosleep),    SCMP_SYS(gettimeofday),    SCMP_SYS(time),
                              SCMP_SYS(getrandom),    SCMP_SYS(getpid),          SCMP_SYS(gettid),
                              SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask),  SCMP_SYS(rt_sigreturn),
                              SCMP_SYS(sigaltstack),  SCMP_SYS(restart_syscall), SCMP_SYS(exit),
                              SCMP_SYS(exit_group),   SCMP_SYS(getrlimit),       SCMP_SYS(sysinfo)};
  for (const int call : kAllowed)
    if (seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0) != 0) return false;
  if (opens_files && !allow_opening(filter.get())) return false;
  // the sanitizers use a pipe to test whether memory can be read
  if (kSanitized)
    for (const int call : {SCMP_SYS(pipe), SCMP_SYS(pipe2)})
      if (seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0) != 0) return false;
  // threads, but no processes; clone3 hides its flags from the filter, and the C library works without it
  bool success =
      seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(clone), 1, SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD)) == 0;
  success = success && seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) == 0;
  // memory, but none that is executable
  success = success && seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(mmap), 1, SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0)) == 0;
  success =
      success && seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(mprotect), 1, SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0)) == 0;
  // query how a descriptor is open, and the process's own limits
  success = success && seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(fcntl), 1, SCMP_A1(SCMP_CMP_EQ, F_GETFL)) == 0;
  success = success &&
            seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(prlimit64), 2, SCMP_A0(SCMP_CMP_EQ, 0), SCMP_A2(SCMP_CMP_EQ, 0)) == 0;
  success = success && (!raises_time || seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(prlimit64), 2, SCMP_A0(SCMP_CMP_EQ, 0),
                                                         SCMP_A1(SCMP_CMP_EQ, RLIMIT_CPU)) == 0);
  // abort by a failed assertion, in this process only
  success = success && seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1,
                                        SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(::getpid()))) == 0;
  return success && seccomp_load(filter.get()) == 0;
}

}  // namespace

Result<field::SandboxStatus> enter_sandbox(const ProcessLimits& limits, bool* root_changed) {
  if (limits.ends_with_starter) ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_DUMPABLE, 0);
  set_limits(limits);
  field::SandboxStatus confinement;
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return Error{std::string("privileges cannot be dropped: ") + std::strerror(errno)};
  const std::string& folder = limits.readable_folder;
  confinement.landlock_version = limits.use_landlock ? landlock(folder) : 0;
  const bool moved = !folder.empty() && confinement.landlock_version == 0 && change_root(folder);
  if (!folder.empty() && confinement.landlock_version == 0 && !moved)
    return Error{"this kernel cannot restrict a process to a folder, expected Landlock or user namespaces"};
  if (root_changed != nullptr) *root_changed = moved;
  if (!drop_capabilities()) return Error{std::string("privileges cannot be dropped: ") + std::strerror(errno)};
  confinement.seccomp = seccomp(!folder.empty(), limits.max_cpu_s > 0);
  if (!confinement.seccomp) return Error{"this kernel cannot filter system calls, expected seccomp"};
  return confinement;
}

}  // namespace catena::sandbox
