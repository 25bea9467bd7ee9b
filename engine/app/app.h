/// The program `catena`: one file a subcommand. Exit codes: 0 done; 2 bad input, with one clear line on stderr and no output
/// file; 1 the machine failed (no Vulkan device, no display, out of memory), or a replay does not repeat its recording.
#pragma once

namespace catena::app {
int run(int argc, char** argv);
}
