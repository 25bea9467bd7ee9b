/// Counts heap allocations of the calling thread, so that a test can show that a tick makes none.
/// The counting operators new and delete are linked into the tests only (tests/support); without them it stays 0
/// (there is nothing to count with).
#pragma once
#include <cstdint>

namespace catena {

/// Allocations made by this thread so far, as far as they are counted.
inline thread_local std::uint64_t thread_allocations = 0;

class AllocationGuard {
 public:
  AllocationGuard() : start_(thread_allocations) {}
  std::uint64_t count() const { return thread_allocations - start_; }

 private:
  std::uint64_t start_;
};

}  // namespace catena
