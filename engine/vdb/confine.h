/// A process that handles a foreign file shuts itself in before it looks at the first byte. From then on it has the descriptors that it
/// holds, and nothing else: no file can be opened (Landlock where the kernel has it, and seccomp), no socket, program or process made, no
/// memory made executable, no other process touched. It dies with the thread that started it, leaves no core file, and has limits.
#pragma once
#include "engine/field/vdb_exchange.h"

namespace catena::vdb {

struct ProcessLimits {
  std::uint64_t memory_bytes = ~std::uint64_t{0};  ///< beyond what the process has now; all ones: none
  std::uint64_t cpu_s = 0;                         ///< 0: none
  bool only_memory_files = true;                   ///< files may grow up to memory_bytes
};

/// Before any thread is made. An error: the kernel refuses what it must not (seccomp); Landlock may be missing, and the answer says so.
Result<field::Confinement> confine(const ProcessLimits& limits);

}  // namespace catena::vdb
