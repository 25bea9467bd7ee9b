// SPDX-License-Identifier: MIT
/// System failures, distinguished from bad input by one table of errno codes: a full disk, a resource limit of the process, a device or
/// server that does not respond. They end a command with exit code 1 and their cause; errors of a file or of the user end it with 2.
/// docs/reference/errors.md contains the same table. Any thread.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "engine/base/result.h"

namespace catena {

/// An errno code that is a system failure, and the resource limit that may cause it.
struct SystemFailure {
  int code;   ///< errno code, for example ENOSPC
  int limit;  ///< RLIMIT_*; -1: no limit causes it
  /// Format of a message on the limit, with one placeholder for its value: "files may have at most {} bytes: ulimit -f".
  const char* limit_format;
};
/// Returns the whole table.
std::span<const SystemFailure> system_failures();

/// Returns true when an errno code is in the table.
bool is_system_failure(int code);
/// Returns the C library's text for an errno code, and the limit that may cause it when one is set: "File too large (files may have at most
/// 8192 bytes: ulimit -f)".
std::string describe_errno(int code);
/// Makes an Error "WHAT: CAUSE" from an errno code; a system failure when the table contains the code.
Error system_error(const std::string& what, int code);

/// Returns a resource limit (RLIMIT_*) of this process; nullopt when it is unlimited. The limit on processes does not apply to root.
std::optional<unsigned long long> resource_limit(int limit);
/// Returns a description of the address-space and file-size limits that are set, for a failure without a known cause; empty: none is set.
std::string describe_resource_limits();

/// Returns "out of memory: this process may have at most N KiB of addresses: ulimit -v; expected more, or less to load or to draw".
/// Allocates nothing; valid until the next call on this thread.
const char* out_of_memory_message() noexcept;

/// Returns `error`, whose message describes `cause` in other words, marked as a system failure when `cause` is one.
inline Error with_cause(Error error, const Error& cause) {
  error.system_failure = cause.system_failure;
  return error;
}

/// Returns the exit code of a command that ended with this error: 1 for a system failure, else 2.
inline int to_exit_code(const Error& error) { return error.system_failure ? 1 : 2; }

}  // namespace catena
