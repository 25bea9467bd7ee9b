// SPDX-License-Identifier: MIT
/// Resident memory of this process.
#pragma once
#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace catena::test {

/// False under the address sanitizer, which keeps freed memory for a while.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kResidentIsReliable = false;
#else
inline constexpr bool kResidentIsReliable = true;
#endif

/// Resident size in bytes (Linux).
inline std::uint64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

}  // namespace catena::test
