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
struct MachineCause {
  int code;           ///< ENOSPC
  int limit;          ///< RLIMIT_*; -1: none
  const char* words;  ///< of the limit, with one place for its value: "files may have at most {} bytes: ulimit -f"
};
/// The whole table.
std::span<const MachineCause> machine_causes();

/// Whether a code of errno is in the table.
bool is_machine_failure(int code);
/// What the C library calls the code, and the limit that is behind it where one is set: "File too large (files may have at most 8192
/// bytes: ulimit -f)".
std::string cause_of(int code);
/// "WHAT: CAUSE", an error of the machine if the table has the code.
Error system_error(const std::string& what, int code);

/// The value of a limit of this process (RLIMIT_*), where one is set. That on processes does not count for root.
std::optional<unsigned long long> limit_in_force(int limit);
/// The limits of this process on addresses and sizes of files that are set, for a failure of which nothing else is known; empty: none.
std::string limits_in_words();

/// "out of memory: this process may have at most N KiB of addresses: ulimit -v; expected more, or less to load or to draw". Allocates
/// nothing; valid until the next call of this thread.
const char* out_of_memory() noexcept;

/// `error`, which tells of `cause` in other words: an error of the machine if that is one.
inline Error caused_by(Error error, const Error& cause) {
  error.machine = cause.machine;
  return error;
}

/// Exit code of a command that ended with this error: 1 where the machine failed, else 2.
inline int exit_code_of(const Error& error) { return error.machine ? 1 : 2; }

}  // namespace catena
