/// TickObserver hands every tick of a running servo to the frame side, where a trial is judged, and on to the recording. The haptic thread
/// copies a few words into a ring and returns; it never waits, and what the ring has no room for is counted, so that a trial with a hole is
/// known.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>

#include "haptics/servo/log/tick_block_writer.h"
#include "haptics/servo/servo.h"

namespace catena::app {

/// What a judge sees of a tick. World units, newtons.
struct ObservedTick {
  std::uint64_t epoch = 0;  ///< of the program that ran
  double t_s = 0;
  Vec3 probe{0.0};  ///< the device's place: the drawn cursor
  Vec3 force_n{0.0};
  bool is_valid = true;  ///< the device was there, and the watchdog has not stopped it
};

class TickObserver final : public haptics::TickSink {
 public:
  /// Room for a minute at 1 kHz: the frame may stand still for so long.
  explicit TickObserver(std::size_t ticks = 60'000);

  // frame side
  /// Before a servo takes it up, or after it has let go of it: nothing is left of before. `next`: gets every tick too (the recording), or
  /// null.
  void begin(haptics::TickSink* next);
  /// The next tick, in order; nothing where there is none yet.
  std::optional<ObservedTick> pop();
  /// A tick did not fit.
  bool has_lost_ticks() const { return has_lost_ticks_.load(std::memory_order_acquire); }

  // haptic thread
  void begin(const haptics::ChainState& state) noexcept override;
  void put(const haptics::ProbeSample& input, const HapticState& output) noexcept override;

 private:
  static constexpr std::size_t kWordsPerTick = 9;

  haptics::log::SpscRing ring_;
  haptics::TickSink* next_sink_ = nullptr;
  std::atomic<bool> has_lost_ticks_{false};
};

}  // namespace catena::app
