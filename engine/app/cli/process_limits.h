// SPDX-License-Identifier: MIT
/// Handles the process limits that a shell or a service manager sets (ulimit, prlimit), at the start of the program:
///   stack      of new threads: at least 2 MiB, whatever the limit is, because a thread's default stack size is taken from the limit. Of
///              the first thread: raised to 8 MiB as far as the hard limit allows; below 1 MiB the program does not start
///   file size  SIGXFSZ is ignored: a write beyond the limit fails and is reported as a full disk is
///   crash      one line on stderr, then the process ends with the signal
///   exception  an exception that is not caught (no memory, no thread) stops the guarded device, prints one line and ends with exit code 1
#pragma once
#include "engine/base/result.h"

namespace catena::app {

/// Applies all of the above. Error (system failure): the stack is limited to less than 1 MiB.
Outcome prepare_process();

/// Opens /dev/null read-only on those of the descriptors 0, 1 and 2 that are closed, so that a file opened later cannot get one of them.
void reserve_standard_descriptors();

/// Flushes standard output, as the last action of a run. Returns the exit code of the process: `code`, or 1 if `code` is 0 and output was
/// lost. Prints an error message for lost output, except for a broken pipe.
int flush_output(int code);

}  // namespace catena::app
