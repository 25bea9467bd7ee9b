/// Failures of the machine, told apart from bad input in one table: a full disk, a limit of the process, a device that does not answer.
/// They end a command with exit code 1 and their cause; what a file or a person got wrong ends it with 2. The same table is in
/// docs/command-line.md. Any thread.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "engine/base/result.h"

namespace catena {

/// A code of errno that is the machine's failure, and the limit that may be behind it.
struct SystemFailure {
  int code;                  ///< ENOSPC
  int limit;                 ///< RLIMIT_*; -1: none
  const char* limit_format;  ///< of the limit, with one place for its value: "files may have at most {} bytes: ulimit -f"
};
/// The whole table.
std::span<const SystemFailure> system_failures();

/// Whether a code of errno is in the table.
bool is_system_failure(int code);
/// What the C library calls the code, and the limit that is behind it where one is set: "File too large (files may have at most 8192
/// bytes: ulimit -f)".
std::string describe_errno(int code);
/// "WHAT: CAUSE", an error of the machine if the table has the code.
Error system_error(const std::string& what, int code);

/// The value of a limit of this process (RLIMIT_*), where one is set. That on processes does not count for root.
std::optional<unsigned long long> resource_limit(int limit);
/// The limits of this process on addresses and sizes of files that are set, for a failure of which nothing else is known; empty: none.
std::string describe_resource_limits();

/// "out of memory: this process may have at most N KiB of addresses: ulimit -v; expected more, or less to load or to draw". Allocates
/// nothing; valid until the next call of this thread.
const char* out_of_memory_message() noexcept;

/// `error`, which tells of `cause` in other words: an error of the machine if that is one.
inline Error with_cause(Error error, const Error& cause) {
  error.system_failure = cause.system_failure;
  return error;
}

/// Exit code of a command that ended with this error: 1 where the machine failed, else 2.
inline int to_exit_code(const Error& error) { return error.system_failure ? 1 : 2; }

}  // namespace catena
