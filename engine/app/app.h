/// The program `catena`: one file a subcommand. Exit codes: 0 done, 2 bad input (one clear line on stderr), 1 a failure of
/// the machine (no device, out of memory).
#pragma once

namespace catena::app {
int run(int argc, char** argv);
}
