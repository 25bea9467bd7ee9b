// SPDX-License-Identifier: MIT
/// Best-effort use of huge pages (2 MiB) for large memory that is soon read or written throughout: fewer page faults while it is filled and
/// fewer TLB misses while it is read. Has no effect where the kernel offers none. Any thread.
#pragma once
#include <cstddef>

namespace catena {

inline constexpr std::size_t kMinHugePageBytes = std::size_t{4} << 20;  ///< smallest size in bytes for which huge pages are requested

/// Requests huge pages for `bytes` bytes at `start`, which must be private mapped memory.
void prefer_huge_pages(void* start, std::size_t bytes);

}  // namespace catena
