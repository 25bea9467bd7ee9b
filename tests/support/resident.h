/// Memory of this process that is in use now.
#pragma once
#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace catena::test {

/// Resident bytes (Linux).
inline std::uint64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

}  // namespace catena::test
