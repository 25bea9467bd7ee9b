// SPDX-License-Identifier: MIT
/// Ring buffer from the haptic thread to the writer's thread of a log, and the conversion of ticks to blocks.
#pragma once
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "haptics/chain/state_hash.h"
#include "haptics/servo/log/block_file.h"
#include "haptics/servo/log/contents.h"
#include "haptics/servo/log/record.h"

namespace catena::haptics::log {

/// Ring buffer of 64-bit words between one producer thread and one consumer thread. Wait-free: a push without enough space fails. All
/// memory is allocated and touched by the constructor. A message is pushed as a whole or not at all.
class SpscRing {
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  /// Creates a ring of at least this size, rounded up to a power of two words.
  explicit SpscRing(std::size_t bytes) : words_(std::bit_ceil(std::max<std::size_t>(bytes, 64) / 8), 0), mask_(words_.size() - 1) {}

  /// Pushes a message. Returns false if there is not enough space; then nothing is pushed. Producer thread.
  bool try_push(std::span<const std::uint64_t> message) noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (words_.size() - (head - cached_tail_) < message.size()) {
      cached_tail_ = tail_.load(std::memory_order_acquire);
      if (words_.size() - (head - cached_tail_) < message.size()) return false;
    }
    const std::size_t at = head & mask_, first = std::min(message.size(), words_.size() - at);
    std::copy_n(message.begin(), first, words_.begin() + static_cast<std::ptrdiff_t>(at));
    std::copy(message.begin() + static_cast<std::ptrdiff_t>(first), message.end(), words_.begin());
    head_.store(head + message.size(), std::memory_order_release);
    return true;
  }

  /// Returns the number of words that can be popped. Consumer thread.
  std::size_t available() const noexcept { return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_relaxed); }
  /// Pops the next words into `out`, which must not be longer than available(). Consumer thread.
  void pop(std::span<std::uint64_t> out) noexcept {
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
  std::uint64_t cached_tail_ = 0;  ///< tail as last read by the producer
  alignas(64) std::atomic<std::uint64_t> tail_{0};
};

/// Converts ticks in their order to blocks of a log: batches of ticks, programs where they take over, gaps where ticks are missing.
/// Writer's thread.
class TickBlockWriter {
 public:
  /// Returns what is known of the program of this epoch; before the first tick, preceded by the first program if that is another one.
  using ProgramLookup = std::function<std::vector<LogProgram>(std::uint64_t epoch)>;
  /// Returns the bricks in memory, sorted, of a snapshot for a program with these paged grids (LogProgram::paged_grids).
  using BrickLookup = std::function<std::vector<LogBrick>(const std::vector<std::uint64_t>& paged_grids, std::uint64_t snapshot)>;
  /// Creates a writer to the file; the functions are called when the epoch, or it or the snapshot, changes.
  TickBlockWriter(BlockFile file, ProgramLookup programs_of, BrickLookup bricks_of);

  /// Identification of a tick.
  struct Tick {
    std::uint64_t number = 0, epoch = 0;  ///< number of the tick; epoch of its program
    RecordLayout layout;                  ///< layout of its record
    std::uint64_t snapshot = 0;           ///< snapshot of bricks that it samples; 0: none
  };
  /// Adds a tick. `words`: its record, from pack_tick(). Tick numbers increase; a jump is written as a gap.
  void add(const Tick& tick, std::span<const std::uint64_t> words);
  /// Writes the state before the first tick, if the log begins while the servo runs. Call it before any tick.
  void begin_after(const ChainState& state);
  /// Writes the ticks collected so far as a block.
  void flush();
  /// Writes the rest and the end block, and closes the file. `newest_tick`: last tick of the servo, in the log or lost.
  void end(std::uint64_t newest_tick);

  /// Returns the file.
  BlockFile& file() { return file_; }
  /// Returns the number of ticks in complete blocks.
  std::uint64_t ticks() const { return ticks_; }
  /// Returns the number of the last tick in a complete block.
  std::uint64_t last_tick() const { return last_written_; }

 private:
  void add_gap(std::uint64_t next);
  void begin(const Tick& tick);
  void write_bricks(const Tick& tick);

  BlockFile file_;
  ProgramLookup find_programs_;
  BrickLookup find_bricks_;
  std::vector<LogBrick> bricks_;  ///< bricks in memory, as written last
  std::uint64_t snapshot_ = 0;
  Tick first_;  ///< first tick of the block that is being filled
  std::uint32_t count_ = 0;
  std::string records_;
  RecordWords previous_words_{};
  bool has_program_ = false;
  std::vector<std::uint64_t> paged_grids_;  ///< of the program
  std::uint64_t epoch_ = 0, last_ = 0;
  std::uint64_t ticks_ = 0, lost_ = 0, last_written_ = 0;
  LogTick unpacked_;
  StateHash hash_;
};

}  // namespace catena::haptics::log
