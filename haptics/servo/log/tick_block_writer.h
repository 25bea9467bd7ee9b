/// RecordWords from one thread to another, neither ever waits: the writer is told when there is no room. All memory is taken, and
/// touched, at the start. One message is put whole or not at all.
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

class SpscRing {
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  explicit SpscRing(std::size_t bytes) : words_(std::bit_ceil(std::max<std::size_t>(bytes, 64) / 8), 0), mask_(words_.size() - 1) {}

  /// Writer's thread. False: no room, nothing was put.
  bool try_push(std::span<const std::uint64_t> message) noexcept {
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
  std::uint64_t seen_tail_ = 0;  ///< the writer's
  alignas(64) std::atomic<std::uint64_t> tail_{0};
};

/// Ticks in their order -> blocks of a log: batches, programs where they take over, gaps where ticks are missing. The writer's thread.
class TickBlockWriter {
 public:
  /// What is known of the program of this epoch; before the first tick also of the one that it took over from.
  using ProgramLookup = std::function<std::vector<LogProgram>(std::uint64_t epoch)>;
  TickBlockWriter(BlockFile file, ProgramLookup programs_of);

  struct Tick {
    std::uint64_t number = 0, epoch = 0;
    RecordLayout layout;
  };
  /// `words`: pack() of this tick. NumberArray rise; a jump is a gap.
  void add(const Tick& tick, std::span<const std::uint64_t> words);
  /// The log begins while the servo runs: the state before its first tick. Before any tick.
  void begin_after(const ChainState& state);
  void flush();                         ///< what is there becomes a block
  void end(std::uint64_t newest_tick);  ///< the last tick that there was, in the log or lost; closes the file

  BlockFile& file() { return file_; }
  std::uint64_t ticks() const { return ticks_; }             ///< in complete blocks
  std::uint64_t last_tick() const { return last_written_; }  ///< of these

 private:
  void add_gap(std::uint64_t next);
  void begin(const Tick& tick);

  BlockFile file_;
  ProgramLookup find_programs_;
  Tick first_;  ///< of the block that is being filled
  std::uint32_t count_ = 0;
  std::string records_;
  RecordWords previous_words_{};
  bool has_program_ = false;
  std::uint64_t epoch_ = 0, last_ = 0;
  std::uint64_t ticks_ = 0, lost_ = 0, last_written_ = 0;
  LogTick unpacked_;
  StateHash hash_;
};

}  // namespace catena::haptics::log
