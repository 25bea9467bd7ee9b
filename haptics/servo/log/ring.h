/// Words from one thread to another, neither ever waits: the writer is told when there is no room. All memory is taken, and
/// touched, at the start. One message is put whole or not at all.
#pragma once
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace catena::haptics::log {

class Ring {
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  explicit Ring(std::size_t bytes) : words_(std::bit_ceil(std::max<std::size_t>(bytes, 64) / 8), 0), mask_(words_.size() - 1) {}

  /// Writer's thread. False: no room, nothing was put.
  bool put(std::span<const std::uint64_t> message) noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (words_.size() - (head - seen_tail_) < message.size()) {
      seen_tail_ = tail_.load(std::memory_order_acquire);
      if (words_.size() - (head - seen_tail_) < message.size()) return false;
    }
    const std::size_t at = head & mask_, first = std::min(message.size(), words_.size() - at);
    std::copy_n(message.begin(), first, words_.begin() + static_cast<std::ptrdiff_t>(at));
    std::copy(message.begin() + static_cast<std::ptrdiff_t>(first), message.end(), words_.begin());
    head_.store(head + message.size(), std::memory_order_release);
    return true;
  }

  /// Reader's thread: how many words there are, and the next ones of them (`out` is at most that long).
  std::size_t available() const noexcept { return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_relaxed); }
  void take(std::span<std::uint64_t> out) noexcept {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t at = tail & mask_, first = std::min(out.size(), words_.size() - at);
    std::copy_n(words_.begin() + static_cast<std::ptrdiff_t>(at), first, out.begin());
    std::copy_n(words_.begin(), out.size() - first, out.begin() + static_cast<std::ptrdiff_t>(first));
    tail_.store(tail + out.size(), std::memory_order_release);
  }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t mask_;
  alignas(64) std::atomic<std::uint64_t> head_{0};
  std::uint64_t seen_tail_ = 0;  ///< the writer's
  alignas(64) std::atomic<std::uint64_t> tail_{0};
};

}  // namespace catena::haptics::log
