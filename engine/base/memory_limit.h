/// How much memory data may take: the one place that decides. Whoever reads something whose size a file, a scene or a person states
/// asks here before the memory is allocated. Any thread.
///   with a limit (--memory MB)   allowed = limit - held         held: what the data in memory counts by HeldMemory
///   without                      allowed = 3/4 of what is free  MemAvailable of the system, less where a control group allows less; and
///                                                               no more than ulimit -v leaves of this process's addresses
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/result.h"

namespace catena {

/// In bytes; nullopt: three quarters of what is free. `of_addresses`: the limit is what ulimit -v leaves of a process that asks this one.
void set_memory_limit(std::optional<std::uint64_t> bytes, bool of_addresses = false);
/// What was set; nullopt: nothing. Any thread.
std::optional<std::uint64_t> stated_memory();
/// Whether it is the limit on addresses that decides what is allowed.
bool memory_is_of_addresses();
/// How often memory was refused by the functions below.
std::uint64_t memory_refusals();
/// Bytes that data may still take now. Any thread.
std::uint64_t allowed_memory();

/// Fine, or one line: "WHAT needs 274878 MB of memory, expected at most 15123 MB (--memory MB allows more)"; where the limit on addresses
/// decides, an error of the machine that names it. `bytes` may be of any size.
Outcome ask_for_memory(const std::string& what, double bytes);
/// The same against a limit that was asked for earlier.
Outcome ask_for_memory(const std::string& what, double bytes, std::uint64_t allowed);

/// The same for texts and what is read from them: less than 1 MB is never refused, so that a scene can be read and edited beside data that
/// fill the limit.
Outcome ask_for_text_memory(const std::string& what, double bytes);

/// Lets the allocator keep up to 64 MB of freed memory instead of giving it back to the system at once: a software driver takes and frees
/// as much several times a picture. At the start of a program.
void keep_freed_memory();

/// Counts memory as held by data, for as long as it lives.
class HeldMemory {
 public:
  HeldMemory() = default;
  /// Counts `bytes` as held.
  explicit HeldMemory(std::uint64_t bytes);
  ~HeldMemory();
  /// Takes the count over; `other` counts nothing then.
  HeldMemory(HeldMemory&& other) noexcept : bytes_(std::exchange(other.bytes_, 0)) {}
  /// Exchanges the counts.
  HeldMemory& operator=(HeldMemory&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
  }

 private:
  std::uint64_t bytes_ = 0;
};

/// Counts heap allocations of the calling thread, so that a test can show that a tick makes none.
/// The counting operators new and delete are linked into the tests only (tests/support); without them it stays 0
/// (there is nothing to count with).

/// Allocations made by this thread so far, as far as they are counted.
inline thread_local std::uint64_t thread_allocations = 0;

/// Counts from where it is made.
class AllocationGuard {
 public:
  AllocationGuard() : start_(thread_allocations) {}
  /// Allocations of this thread since then.
  std::uint64_t count() const { return thread_allocations - start_; }

 private:
  std::uint64_t start_;
};

}  // namespace catena
