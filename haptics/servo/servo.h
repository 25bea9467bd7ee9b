/// The servo, which is the haptic thread around the tick, and the sink that gets every tick.
#pragma once
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/triple_buffer.h"
#include "haptics/chain/state_hash.h"
#include "haptics/chain/tick.h"
#include "haptics/device/device.h"
#include "haptics/servo/deadline_clock.h"
#include "haptics/servo/servo_stats.h"

namespace catena::haptics {

/// What gets every tick, such as a recording (haptics/servo/log/). Called on the haptic thread after each tick, before it is published: no
/// allocation, lock or throw, and it returns at once. `begin` comes before the first `put` of a sink that is taken up.
class TickSink {
 public:
  virtual ~TickSink() = default;
  /// A sink that a running servo takes up: the state before the tick that `put` gets next.
  virtual void begin(const ChainState& state) noexcept { static_cast<void>(state); }
  /// `input` and `output` as the tick had them; the servo's timings are in `output`.
  virtual void put(const ProbeSample& input, const HapticState& output) noexcept = 0;
};

class Watchdog;

/// How a servo runs.
struct ServoOptions {
  static constexpr double kMinRateHz = 100, kMaxRateHz = 10000;  ///< rates that it takes

  double rate_hz = 1000;          ///< kMinRateHz..kMaxRateHz
  bool paced = true;              ///< false: as fast as it goes (soaks, determinism); never late, no watchdog, normal priority
  std::uint64_t max_ticks = 0;    ///< 0: until stop()
  TickSink* sink = nullptr;       ///< gets every tick; outlives the servo, or is taken away by set_sink
  bool forces_enabled = true;     ///< at the start; set_forces_enabled() later
  double watchdog_s = 0.05;       ///< at least four periods; 0: none
  RealtimeOptions realtime = {};  ///< of a paced servo
};

/// A servo: one device, one haptic thread, one program at a time. It is a thin shell around the tick: it wakes at absolute deadlines
/// (pace.h), reads the device, takes the newest program (never waits), runs the tick, writes the force and publishes one HapticState.
/// Two threads touch a Servo: the frame side calls the public functions, the haptic thread runs the loop; a third one, the watchdog,
/// looks at a time stamp. They share two triple buffers, flags, counters and two pointers, all lock-free. The haptic thread never frees:
/// programs are kept by the frame side until a published epoch shows that a newer one has run.
///
/// The condition of a tick:
///   WATCHDOG   no tick had ended for watchdog_s. The watchdog saw it or, where the whole program stood still (SIGSTOP), the haptic thread
///              itself. The device has been stopped; the next tick resumes it. A tick that itself takes longer than watchdog_s stops the
///              device before it writes, and the next one has this condition.
///   NO_DEVICE  the device is not ready
///   LATE       the tick's time is more than two periods after the last tick's
///   NORMAL     else
class Servo {
 public:
  /// The device must outlive the servo. Nothing runs before start().
  Servo(Device& device, std::shared_ptr<const HapticProgram> program, const ServoOptions& options = {});
  ~Servo();
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  // frame side
  /// Before start(): what the chain remembers comes from a servo that has been stopped (another device takes over). The force begins at
  /// zero, as it always does. ProgramLookup need epochs of their own over both.
  void resume_from(const Servo& other);
  /// Returns when the thread is prepared, just before its first tick. Where this machine gives no thread: an error, and nothing runs.
  Outcome start();
  void stop();                                                     ///< joins; the device has had a last zero force and is stopped
  void set_program(std::shared_ptr<const HapticProgram> program);  ///< of an epoch of its own: by it the older ones are freed
  bool receive(HapticState& state);                                ///< true if there was something newer
  /// Another sink from one of the next ticks on, or none. True: the old one is not used any more. The tick takes it up by itself; the
  /// caller waits for that, a tick or two, and at most `patience_s`: then false, and the old one must live on (until stop(), or a true).
  bool set_sink(TickSink* sink, double patience_s = 1);
  std::uint64_t state_hash() const { return hash_.value(); }  ///< after stop()
  /// ProgramLookup that it keeps: the one that runs and those that a tick may still name.
  std::size_t live_program_count() const { return programs_.size(); }

  // any thread
  /// From the start until max_ticks, stop(), or an end of its own.
  bool running() const { return running_.load(std::memory_order_acquire); }
  /// The person's switch, from the next tick on. While it or the device's own switch is off the hand gets no force; the force goes to zero
  /// over DeviceLimits::ramp_out_s (guard.h).
  void set_forces_enabled(bool on) { forces_enabled_.store(on, std::memory_order_relaxed); }
  /// Whether the person's switch is on; it does not tell whether the device's own is.
  bool forces_enabled() const { return forces_enabled_.load(std::memory_order_relaxed); }
  ServoStats stats() const;  ///< after start(), also while it runs

 private:
  void loop() noexcept;
  void run_tick(double t_s, const TickTiming& beat, HapticState& out) noexcept;
  void release_priority_if_overloaded(bool missed, std::int64_t now_ns) noexcept;

  static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::uint64_t>::is_always_lock_free &&
                std::atomic<const HapticProgram*>::is_always_lock_free && std::atomic<TickSink*>::is_always_lock_free);
  Device& device_;
  ServoOptions options_;
  TripleBuffer<const HapticProgram*> next_program_;
  TripleBuffer<HapticState> published_;
  std::atomic<bool> stop_{false}, running_{false}, prepared_{false}, forces_enabled_;
  std::atomic<TickSink*> requested_sink_, active_sink_;
  ServoCounters counters_;

  // haptic thread only, once started
  const HapticProgram* program_ = nullptr;
  TickSink* sink_ = nullptr;
  ChainState state_;
  ChainScratch scratch_;
  StateHash hash_;
  bool stopped_ = false;          ///< the watchdog has stopped the device
  bool stalled_in_tick_ = false;  ///< the last tick did
  int misses_in_row_ = 0;
  std::int64_t missing_since_ns_ = 0;

  // frame side only; realtime_ is written before prepared_
  RealtimeReport realtime_;
  std::vector<std::shared_ptr<const HapticProgram>> programs_;
  std::unique_ptr<Watchdog> watchdog_;  ///< null: none
  std::thread thread_;
};

}  // namespace catena::haptics
