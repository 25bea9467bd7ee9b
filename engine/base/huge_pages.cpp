// SPDX-License-Identifier: MIT
#include "engine/base/huge_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace catena {

void prefer_huge_pages(void* start, std::size_t bytes) {
  if (bytes < kMinHugePageBytes) return;
  // never splits a mapping: mremap() fails on ranges with different madvise() settings
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE)), at = reinterpret_cast<std::uintptr_t>(start);
  const std::uintptr_t begin = (at + page - 1) / page * page, end = (at + bytes + page - 1) / page * page;
  ::madvise(static_cast<std::byte*>(start) + (begin - at), end - begin, MADV_HUGEPAGE);
}

}  // namespace catena
