// SPDX-License-Identifier: MIT
#include "engine/base/system_failure.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace catena {

namespace {

constexpr const char *kAddresses = "this process may have at most {} KiB of addresses: ulimit -v",
                     *kProcesses = "this user may have at most {} processes and threads: ulimit -u",
                     *kFileSize = "files may have at most {} bytes: ulimit -f",
                     *kFiles = "at most {} files may be open at a time: ulimit -n";

constexpr std::array<SystemFailure, 11> kCauses{{
    {ENOSPC, -1, ""},                  // the disk is full
    {EDQUOT, -1, ""},                  // the user's disk quota is used up
    {EFBIG, RLIMIT_FSIZE, kFileSize},  // file size limit of the file system or of the process
    {EIO, -1, ""},                     // hardware error of the disk or its connection
    {EROFS, -1, ""},                   // mounted read-only, also by the kernel after an error
    {ESTALE, -1, ""},                  // stale handle: the file server has restarted
    {ETIMEDOUT, -1, ""},               // the file server does not answer
    {EMFILE, RLIMIT_NOFILE, kFiles},
    {ENFILE, -1, ""},
    {ENOMEM, RLIMIT_AS, kAddresses},
    {EAGAIN, RLIMIT_NPROC, kProcesses},  // from fork and thread creation; elsewhere another exhausted resource
}};

std::string limit_text(const SystemFailure& cause) {
  const auto value = cause.limit < 0 ? std::nullopt : resource_limit(cause.limit);
  if (!value) return {};
  return fmt::format(fmt::runtime(cause.limit_format), cause.limit == RLIMIT_AS ? *value / 1024 : *value);
}

const SystemFailure* find_cause(int code) {
  const auto* at = std::find_if(kCauses.begin(), kCauses.end(), [&](const SystemFailure& cause) { return cause.code == code; });
  return at != kCauses.end() ? at : nullptr;
}

}  // namespace

std::span<const SystemFailure> system_failures() { return kCauses; }

bool is_system_failure(int code) { return find_cause(code) != nullptr; }

std::string describe_errno(int code) {
  const SystemFailure* cause = find_cause(code);
  const std::string limit = cause != nullptr ? limit_text(*cause) : std::string();
  return limit.empty() ? std::strerror(code) : fmt::format("{} ({})", std::strerror(code), limit);
}

Error system_error(const std::string& what, int code) { return Error{what + ": " + describe_errno(code), is_system_failure(code)}; }

std::optional<unsigned long long> resource_limit(int limit) {
  if (limit == RLIMIT_NPROC && ::getuid() == 0) return std::nullopt;
  rlimit value{};
  if (::getrlimit(static_cast<__rlimit_resource>(limit), &value) != 0 || value.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return value.rlim_cur;
}

const char* out_of_memory_message() noexcept {
  static thread_local char message[200];
  const auto limit = resource_limit(RLIMIT_AS);
  if (limit)
    std::snprintf(
        message, sizeof message,
        "out of memory: this process may have at most %llu KiB of addresses: ulimit -v; expected more, or less to load or to draw",
        *limit / 1024);
  else
    std::snprintf(message, sizeof message,
                  "out of memory: this machine gives no more; expected less to load or to draw, or fewer programs beside this one");
  return message;
}

std::string describe_resource_limits() {
  std::string all;
  for (const SystemFailure& cause : kCauses)
    // only limits that are rarely set: every user has a limit on processes, and every shell one on open files
    if (const std::string text = cause.limit == RLIMIT_AS || cause.limit == RLIMIT_FSIZE ? limit_text(cause) : ""; !text.empty())
      all += (all.empty() ? "" : "; ") + text;
  return all;
}

}  // namespace catena
