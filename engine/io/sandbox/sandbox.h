// SPDX-License-Identifier: MIT
/// Sandbox of a process that handles an untrusted file; entered before the first byte is read. Afterwards only the open descriptors can be
/// used: no file can be opened (Landlock where the kernel supports it, and seccomp), no socket, program or process created, no memory made
/// executable, no other process affected. There are no capabilities, even when started by root. The process is killed with the thread that
/// started it (unless it ends with a connection), writes no core file, and has resource limits. A reader of formats that span several files
/// may read the files of one folder: enforced by Landlock, else by a change of the root directory.
#pragma once
#include "engine/io/protocol.h"

namespace catena::sandbox {

/// Resource limits of a sandboxed process.
struct ProcessLimits {
  std::uint64_t memory_bytes = ~std::uint64_t{0};  ///< Memory beyond the present use of the process, bytes; all ones: no limit.
  std::uint64_t cpu_s = 0;                         ///< CPU time limit, seconds; 0: none.
  std::uint64_t max_cpu_s = 0;                     ///< Limit up to which the process may raise `cpu_s` itself; 0: it may not.
  bool only_memory_files = true;                   ///< Files may grow up to memory_bytes (readers write into memory files only).
  std::string readable_folder{};                   ///< Folder that may be read, with its subfolders; empty: no file can be opened.
  bool ends_with_starter = true;                   ///< The process is killed with the thread that started it.
  bool use_landlock = true;                        ///< False: act as on a kernel without Landlock, for tests.
};

/// Enters the sandbox; call it before any thread is created. Returns an Error when seccomp is not available; a missing Landlock is only
/// reported in the status, except that with a readable folder it is an Error when neither Landlock nor a change of the root directory
/// confines the process. `root_changed`: receives whether the folder has become "/".
Result<field::SandboxStatus> enter_sandbox(const ProcessLimits& limits, bool* root_changed = nullptr);

}  // namespace catena::sandbox
