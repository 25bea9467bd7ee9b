// SPDX-License-Identifier: MIT
#include "engine/base/memory_limit.h"

#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>

#include "engine/base/system_failure.h"

namespace catena {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
std::atomic<std::uint64_t> chosen_limit{kNoLimit};
std::atomic<std::uint64_t> reserved_bytes{0}, refusals{0};
std::atomic<bool> chosen_of_addresses{false};

/// Returns MemAvailable of /proc/meminfo in bytes; kNoLimit if it cannot be read, so that no request is refused.
std::uint64_t free_system_memory() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word)
    if (std::uint64_t kib = 0; word == "MemAvailable:" && file >> kib) return kib * 1024;
  return kNoLimit;
}

/// Returns the free bytes in the memory limit of this process's control group; kNoLimit if there is none ("max").
std::uint64_t free_group_memory() {
  std::uint64_t maximum = 0, current = 0;
  std::ifstream limit("/sys/fs/cgroup/memory.max"), current_file("/sys/fs/cgroup/memory.current");
  if (!(limit >> maximum) || !(current_file >> current)) return kNoLimit;
  return maximum > current ? maximum - current : 0;
}

/// Returns the free bytes below RLIMIT_AS. Without /proc the address space in use is unknown; half of the limit counts as free.
std::uint64_t free_addresses() {
  const auto limit = resource_limit(RLIMIT_AS);
  if (!limit) return kNoLimit;
  std::uint64_t pages = 0;
  if (!(std::ifstream("/proc/self/statm") >> pages)) return *limit / 2;
  const std::uint64_t used = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return *limit > used ? *limit - used : 0;
}

}  // namespace

void set_memory_limit(std::optional<std::uint64_t> bytes, bool of_addresses) {
  chosen_limit = bytes.value_or(kNoLimit);
  chosen_of_addresses = of_addresses;
}

bool memory_limit_is_address_space() {
  if (chosen_limit != kNoLimit) return chosen_of_addresses;
  const std::uint64_t addresses = free_addresses();
  return addresses != kNoLimit && addresses <= std::min(free_system_memory(), free_group_memory()) / 4 * 3;
}

std::uint64_t memory_refusal_count() { return refusals; }

std::optional<std::uint64_t> memory_limit() {
  const std::uint64_t limit = chosen_limit;
  return limit == kNoLimit ? std::nullopt : std::optional(limit);
}

std::uint64_t available_memory() {
  const std::uint64_t limit = chosen_limit, reserved = reserved_bytes;
  if (limit != kNoLimit) return limit > reserved ? limit - reserved : 0;
  const std::uint64_t available = std::min(free_system_memory(), free_group_memory());
  return std::min(available == kNoLimit ? available : available / 4 * 3, free_addresses());
}

Outcome check_memory_available(const std::string& what, double bytes, std::uint64_t allowed) {
  if (bytes <= static_cast<double>(allowed)) return Done{};
  ++refusals;
  constexpr double kMegabyte = 1e6;
  const bool of_addresses = memory_limit_is_address_space();
  return Error{fmt::format("{} needs {:.0f} MB of memory, expected at most {:.0f} MB ({})", what, std::ceil(bytes / kMegabyte),
                           std::floor(static_cast<double>(allowed) / kMegabyte),
                           of_addresses ? "ulimit -v allows no more" : "--memory MB allows more"),
               of_addresses};
}

Outcome check_memory_available(const std::string& what, double bytes) { return check_memory_available(what, bytes, available_memory()); }

Outcome check_text_memory_available(const std::string& what, double bytes) {
  constexpr double kAlwaysAllowed = 1e6;
  if (bytes <= kAlwaysAllowed) return Done{};
  return check_memory_available(what, bytes);
}

MemoryReservation::MemoryReservation(std::uint64_t bytes) : bytes_(bytes) { reserved_bytes += bytes; }
MemoryReservation::~MemoryReservation() { reserved_bytes -= bytes_; }

void retain_freed_memory() {
#if defined(__GLIBC__)
  ::mallopt(M_TRIM_THRESHOLD, 64 << 20);
  ::mallopt(M_MMAP_THRESHOLD, 2 << 20);  // setting one threshold turns off the allocator's dynamic choice of the other
#endif
}

}  // namespace catena
