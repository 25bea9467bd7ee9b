// SPDX-License-Identifier: MIT
/// Lock-free triple buffer between one writer thread and one reader thread; neither ever waits. The writer fills a spare slot and publishes
/// it, the reader acquires the newest one. Used in both directions between the frame thread and the haptic tick. T is trivially copyable.
#pragma once
#include <array>
#include <atomic>
#include <type_traits>

#include "engine/base/export.h"

namespace catena {

/// Three slots of T, exchanged without a lock.
template <class T>
class CATENA_EXPORT TripleBuffer {
  static_assert(std::is_trivially_copyable_v<T>, "only plain data crosses threads");
  static_assert(std::atomic<unsigned>::is_always_lock_free);

 public:
  /// Returns the slot that the writer fills. Writer thread only.
  T& back() { return slots_[back_]; }
  /// Publishes the back slot; back() is a different slot afterwards. Writer thread only.
  void publish() { back_ = middle_.exchange(back_ | kFreshBit, std::memory_order_acq_rel) & kIndexMask; }
  /// Copies the value to the back slot and publishes it. Writer thread only.
  void publish(const T& value) {
    back() = value;
    publish();
  }

  /// Makes the newest published value the front slot. Returns true when one was published since the last call. Reader thread only.
  bool acquire() {
    if ((middle_.load(std::memory_order_relaxed) & kFreshBit) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndexMask;
    return true;
  }
  /// Returns the value that acquire() obtained last. Reader thread only.
  const T& front() const { return slots_[front_]; }

 private:
  static constexpr unsigned kIndexMask = 3, kFreshBit = 4;
  std::array<T, 3> slots_{};
  alignas(64) std::atomic<unsigned> middle_{1};
  alignas(64) unsigned back_ = 0;
  alignas(64) unsigned front_ = 2;
};

}  // namespace catena
