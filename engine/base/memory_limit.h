/// How much memory data may take: the one place that decides. Whoever reads something whose size a file, a scene or a person states
/// asks here before the memory is allocated. Any thread.
///   with a limit (--memory MB)   allowed = limit - held         held: what the data in memory counts by MemoryReservation
///   without                      allowed = 3/4 of what is free  MemAvailable of the system, less where a control group allows less; and
///                                                               no more than ulimit -v leaves of this process's addresses
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/result.h"

namespace catena {

/// In bytes; nullopt: three quarters of what is free. `limit_is_address_space`: the limit is what ulimit -v leaves of a process that asks
/// this one.
void set_memory_limit(std::optional<std::uint64_t> bytes, bool of_addresses = false);
/// What was set; nullopt: nothing. Any thread.
std::optional<std::uint64_t> memory_limit();
/// Whether it is the limit on addresses that decides what is allowed.
bool memory_limit_is_address_space();
/// How often memory was refused by the functions below.
std::uint64_t memory_refusal_count();
/// Bytes that data may still take now. Any thread.
std::uint64_t available_memory();

/// Fine, or one line: "WHAT needs 274878 MB of memory, expected at most 15123 MB (--memory MB allows more)"; where the limit on addresses
/// decides, an error of the machine that names it. `bytes` may be of any size.
Outcome check_memory_available(const std::string& what, double bytes);
/// The same against a limit that was asked for earlier.
Outcome check_memory_available(const std::string& what, double bytes, std::uint64_t allowed);

/// The same for texts and what is read from them: less than 1 MB is never refused, so that a scene can be read and edited beside data that
/// fill the limit.
Outcome check_text_memory_available(const std::string& what, double bytes);

/// Lets the allocator keep up to 64 MB of freed memory instead of giving it back to the system at once: a software driver takes and frees
/// as much several times a picture. At the start of a program.
void retain_freed_memory();

/// Counts memory as held by data, for as long as it lives.
class MemoryReservation {
 public:
  MemoryReservation() = default;
  /// Counts `bytes` as held.
  explicit MemoryReservation(std::uint64_t bytes);
  ~MemoryReservation();
  /// Takes the count over; `other` counts nothing then.
  MemoryReservation(MemoryReservation&& other) noexcept : bytes_(std::exchange(other.bytes_, 0)) {}
  /// Exchanges the counts.
  MemoryReservation& operator=(MemoryReservation&& other) noexcept {
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
class AllocationCounter {
 public:
  AllocationCounter() : start_(thread_allocations) {}
  /// Allocations of this thread since then.
  std::uint64_t count() const { return thread_allocations - start_; }

 private:
  std::uint64_t start_;
};

}  // namespace catena
