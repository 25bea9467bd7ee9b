/// What was printed on standard output, and whether it arrived. The last thing of a run.
#pragma once

namespace catena::app {

/// Descriptors 0, 1 and 2 that are closed become ones that nothing can be written to: a file that is opened later is never taken for them.
void keep_standard_descriptors();

/// Flushes standard output. The exit code of the run: `code`, or 1 where that was 0 and the output is lost, which is said in one sentence;
/// nothing is said where the reader of a pipe has gone.
int exit_code_after_output(int code);

}  // namespace catena::app
