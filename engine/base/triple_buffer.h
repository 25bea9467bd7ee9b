/// One writer, one reader, neither ever waits: the writer fills a spare slot and swaps it in, the reader takes the newest.
/// Both directions between the frame and the tick use it. T is trivially copyable plain data.
#pragma once
#include <array>
#include <atomic>
#include <type_traits>

namespace catena {

/// Three slots of T, swapped without a lock.
template <class T>
class TripleBuffer {
  static_assert(std::is_trivially_copyable_v<T>, "only plain data crosses threads");
  static_assert(std::atomic<unsigned>::is_always_lock_free);

 public:
  /// Writer's thread only.
  T& back() { return slots_[back_]; }
  /// Hands the back slot over; back() is another one then.
  void publish() { back_ = middle_.exchange(back_ | kFreshBit, std::memory_order_acq_rel) & kIndexMask; }
  /// Writes and hands over.
  void publish(const T& value) {
    back() = value;
    publish();
  }

  /// Reader's thread only. True if something new arrived since the last call.
  bool acquire() {
    if ((middle_.load(std::memory_order_relaxed) & kFreshBit) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndexMask;
    return true;
  }
  /// What take() took last. Reader's thread only.
  const T& front() const { return slots_[front_]; }

 private:
  static constexpr unsigned kIndexMask = 3, kFreshBit = 4;
  std::array<T, 3> slots_{};
  alignas(64) std::atomic<unsigned> middle_{1};
  alignas(64) unsigned back_ = 0;
  alignas(64) unsigned front_ = 2;
};

}  // namespace catena
