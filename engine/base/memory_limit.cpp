#include "engine/base/memory_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>

namespace catena {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
std::atomic<std::uint64_t> chosen_limit{kNoLimit};
std::atomic<std::uint64_t> held_bytes{0};

/// MemAvailable of /proc/meminfo; where it cannot be read, nothing is known and nothing is refused.
std::uint64_t free_on_the_machine() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word)
    if (std::uint64_t kib = 0; word == "MemAvailable:" && file >> kib) return kib * 1024;
  return kNoLimit;
}

/// What the control group of this process leaves; most have no limit ("max").
std::uint64_t free_in_the_group() {
  std::uint64_t most = 0, current = 0;
  std::ifstream limit("/sys/fs/cgroup/memory.max"), used("/sys/fs/cgroup/memory.current");
  if (!(limit >> most) || !(used >> current)) return kNoLimit;
  return most > current ? most - current : 0;
}

}  // namespace

void set_memory_limit(std::optional<std::uint64_t> bytes) { chosen_limit = bytes.value_or(kNoLimit); }

std::uint64_t allowed_memory() {
  const std::uint64_t limit = chosen_limit, held = held_bytes;
  if (limit != kNoLimit) return limit > held ? limit - held : 0;
  const std::uint64_t available = std::min(free_on_the_machine(), free_in_the_group());
  return available == kNoLimit ? available : available / 4 * 3;
}

Outcome ask_for_memory(const std::string& what, double bytes, std::uint64_t allowed) {
  if (bytes <= static_cast<double>(allowed)) return Done{};
  constexpr double kMegabyte = 1e6;
  return Error{fmt::format("{} needs {:.0f} MB of memory, expected at most {:.0f} MB (--memory MB allows more)", what,
                           std::ceil(bytes / kMegabyte), std::floor(static_cast<double>(allowed) / kMegabyte))};
}

Outcome ask_for_memory(const std::string& what, double bytes) { return ask_for_memory(what, bytes, allowed_memory()); }

Outcome ask_for_text_memory(const std::string& what, double bytes) {
  constexpr double kAlwaysAllowed = 1e6;
  if (bytes <= kAlwaysAllowed) return Done{};
  return ask_for_memory(what, bytes);
}

HeldMemory::HeldMemory(std::uint64_t bytes) : bytes_(bytes) { held_bytes += bytes; }
HeldMemory::~HeldMemory() { held_bytes -= bytes_; }

}  // namespace catena
