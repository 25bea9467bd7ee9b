// SPDX-License-Identifier: MIT
/// TickObserver copies every tick of a running servo to the frame thread, where a trial is scored, and forwards it to the recording. The
/// haptic thread copies a few words into a ring buffer and never waits. A tick that does not fit into the buffer sets a flag, so that a
/// trial with dropped ticks is detected.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>

#include "haptics/servo/log/tick_block_writer.h"
#include "haptics/servo/servo.h"

namespace catena::app {

/// The part of a tick that a trial scorer needs. World units, newtons.
struct ObservedTick {
  std::uint64_t epoch = 0;  ///< Epoch of the program that ran
  double t_s = 0;
  Vec3 probe{0.0};  ///< Position of the device: the rendered cursor
  Vec3 force_n{0.0};
  bool is_valid = true;  ///< The device was connected, and the watchdog had not stopped it
};

/// One haptic thread writes, one frame thread reads.
class TickObserver final : public haptics::TickSink {
 public:
  /// `ticks`: capacity. The default is a minute at 1 kHz: the frame thread may stall for that long.
  explicit TickObserver(std::size_t ticks = 60'000);

  // Frame thread.
  /// Clears the buffer. Call it before a servo uses this sink, or after the servo has released it. `next`: also receives every tick (the
  /// recording), or null.
  void begin(haptics::TickSink* next);
  /// Returns the next tick, in order; empty if there is none yet.
  std::optional<ObservedTick> pop();
  /// Whether a tick was dropped because the buffer was full.
  bool has_lost_ticks() const { return has_lost_ticks_.load(std::memory_order_acquire); }

  // Haptic thread.
  void begin(const haptics::ChainState& state) noexcept override;
  void put(const haptics::ProbeSample& input, const HapticState& output) noexcept override;

  // Planning thread of the pager of bricks.
  void add_bricks(const field::BrickSnapshot& bricks) override {
    if (next_sink_ != nullptr) next_sink_->add_bricks(bricks);
  }

 private:
  static constexpr std::size_t kWordsPerTick = 9;

  haptics::log::SpscRing ring_;
  haptics::TickSink* next_sink_ = nullptr;
  std::atomic<bool> has_lost_ticks_{false};
};

}  // namespace catena::app
