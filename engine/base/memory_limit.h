// SPDX-License-Identifier: MIT
/// Memory budget for data: the single place that decides how much may be allocated. Code that reads data whose size comes from a file, a
/// scene or the user checks the budget here before it allocates. Any thread.
///   with a limit (--memory MB)   available = limit - reserved       reserved: bytes counted by MemoryReservation
///   without a limit              available = 3/4 of free memory     free: MemAvailable of the system, or what the control group leaves
///                                                                   when that is less; at most what ulimit -v leaves of this process's
///                                                                   address space
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/export.h"
#include "engine/base/result.h"

namespace catena {

/// Sets the limit in bytes; nullopt: three quarters of the free memory. `of_addresses`: the limit is what ulimit -v leaves of the process
/// that started this one; the error messages then name it.
CATENA_EXPORT void set_memory_limit(std::optional<std::uint64_t> bytes, bool of_addresses = false);
/// Returns the limit that was set; nullopt: none. Any thread.
CATENA_EXPORT std::optional<std::uint64_t> memory_limit();
/// Returns true when the address-space limit (ulimit -v) determines the available memory.
CATENA_EXPORT bool memory_limit_is_address_space();
/// Returns how often the functions below have refused memory.
CATENA_EXPORT std::uint64_t memory_refusal_count();
/// Returns the number of bytes that data may still allocate. Any thread.
CATENA_EXPORT std::uint64_t available_memory();

/// Checks that `bytes` are available; nothing is allocated or reserved. Error: "WHAT needs 274878 MB of memory, expected at most 15123 MB
/// (--memory MB allows more)"; a system failure that names the limit when the address-space limit determines it. `bytes` may have any size.
CATENA_EXPORT Outcome check_memory_available(const std::string& what, double bytes);
/// Checks that `bytes` are at most `allowed`, an earlier result of available_memory(); errors as above.
CATENA_EXPORT Outcome check_memory_available(const std::string& what, double bytes, std::uint64_t allowed);

/// Checks that `bytes` are available for a text and the objects read from it; errors as above. Less than 1 MB is never refused, so that a
/// scene can be read and edited while data fill the limit.
CATENA_EXPORT Outcome check_text_memory_available(const std::string& what, double bytes);

/// Lets the allocator retain up to 64 MB of freed memory instead of returning it to the system at once: a software renderer allocates and
/// frees that much several times per image. To be called at the start of a program.
CATENA_EXPORT void retain_freed_memory();

/// Counts memory as reserved by data during the lifetime of the object.
class CATENA_EXPORT MemoryReservation {
 public:
  MemoryReservation() = default;
  /// Reserves `bytes`.
  explicit MemoryReservation(std::uint64_t bytes);
  ~MemoryReservation();
  /// Transfers the reservation; `other` reserves nothing afterwards.
  MemoryReservation(MemoryReservation&& other) noexcept : bytes_(std::exchange(other.bytes_, 0)) {}
  /// Exchanges the reservations.
  MemoryReservation& operator=(MemoryReservation&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
  }

 private:
  std::uint64_t bytes_ = 0;
};

/// Counter of heap allocations of the calling thread, for tests that show that a tick allocates nothing. The counting operators new and
/// delete are linked into the tests only (tests/support); without them the count stays 0.

/// Number of allocations of this thread, where they are counted.
inline thread_local std::uint64_t thread_allocations = 0;

/// Counts the allocations of the calling thread since its construction.
class AllocationCounter {
 public:
  AllocationCounter() : start_(thread_allocations) {}
  /// Returns the number of allocations of this thread since construction.
  std::uint64_t count() const { return thread_allocations - start_; }

 private:
  std::uint64_t start_;
};

}  // namespace catena
