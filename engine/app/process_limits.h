/// What the program does about the limits that a shell or a service manager sets (ulimit, prlimit), once, before its work.
///   stack      of new threads: at least 2 MiB, whatever the limit says, for a thread's stack is taken from it. Of the first thread: raised
///              to 8 MiB as far as the hard limit allows; below 1 MiB the program refuses to start
///   file size  SIGXFSZ is ignored: a write beyond it fails, and is told as a full disk is
///   any        an exception that nobody handles (no memory, no thread) lets the device go and ends with one line and exit code 1
#pragma once
#include "engine/base/result.h"

namespace catena::app {

Outcome prepare_process();

}  // namespace catena::app
