/// What the program does about the limits that a shell or a service manager sets (ulimit, prlimit), once, before its work.
///   stack      of new threads: at least 2 MiB, whatever the limit says, for a thread's stack is taken from it. Of the first thread: raised
///              to 8 MiB as far as the hard limit allows; below 1 MiB the program refuses to start
///   file size  SIGXFSZ is ignored: a write beyond it fails, and is told as a full disk is
///   crash      is said in one line, and ends with the signal
///   any        an exception that nobody handles (no memory, no thread) lets the device go and ends with one line and exit code 1
#pragma once
#include "engine/base/result.h"

namespace catena::app {

Outcome prepare_process();

/// What was printed on standard output, and whether it arrived. The last thing of a run.

/// Descriptors 0, 1 and 2 that are closed become ones that nothing can be written to: a file that is opened later is never taken for them.
void reserve_standard_descriptors();

/// Flushes standard output. The exit code of the run: `code`, or 1 where that was 0 and the output is lost, which is said in one sentence;
/// nothing is said where the reader of a pipe has gone.
int flush_output(int code);

}  // namespace catena::app
