// SPDX-License-Identifier: MIT
/// Memory of this process that is in use now.
#pragma once
#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace catena::test {

/// The address sanitizer keeps what is freed for a while: there what is held says nothing.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kResidentCounts = false;
#else
inline constexpr bool kResidentIsReliable = true;
#endif

/// Resident bytes (Linux).
inline std::uint64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

}  // namespace catena::test
