/// A process that handles a foreign file shuts itself in before it looks at the first byte. From then on it has the descriptors that it
/// holds, and nothing else: no file can be opened (Landlock where the kernel has it, and seccomp), no socket, program or process made, no
/// memory made executable, no other process touched. It has no capability, even where root started it. It dies with the thread that started
/// it, leaves no core file, and has limits. A reader of formats that lie in several files may open those of one folder, to read: Landlock
/// sees to it, else a change of the root.
#pragma once
#include "engine/io/protocol.h"

namespace catena::sandbox {

struct ProcessLimits {
  std::uint64_t memory_bytes = ~std::uint64_t{0};  ///< beyond what the process has now; all ones: none
  std::uint64_t cpu_s = 0;                         ///< 0: none
  std::uint64_t max_cpu_s = 0;                     ///< to which the process may raise that itself; 0: it may not
  bool only_memory_files = true;                   ///< files may grow up to memory_bytes
  std::string readable_folder{};                   ///< with everything below it; empty: nothing can be opened
  bool use_landlock = true;                        ///< false: as on a kernel without it, for tests
};

/// Before any thread is made. An error: the kernel refuses what it must not (seccomp); Landlock may be missing, and the answer says so.
/// With a readable folder it is an error, too, where neither Landlock nor a change of the root keeps the process in it. `root_changed`: the
/// folder is now "/".
Result<field::SandboxStatus> enter_sandbox(const ProcessLimits& limits, bool* root_changed = nullptr);

}  // namespace catena::sandbox
