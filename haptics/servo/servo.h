// SPDX-License-Identifier: MIT
/// The servo, which runs the ticks in the haptic thread, and the sink that receives every tick.
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/base/triple_buffer.h"
#include "haptics/chain/state_hash.h"
#include "haptics/chain/tick.h"
#include "haptics/device/device.h"
#include "haptics/servo/deadline_clock.h"
#include "haptics/servo/servo_stats.h"

namespace catena::haptics {

/// Receiver of every tick, such as a recording (haptics/servo/log/). Called on the haptic thread after each tick, before the state is
/// published: no allocation, lock or throw, no waiting. `begin` is called before the first `put` of a sink that is set while the servo
/// runs.
class CATENA_EXPORT TickSink {
 public:
  virtual ~TickSink() = default;
  /// Receives the state before the tick of the next `put`, when a running servo starts to use the sink.
  virtual void begin(const ChainState& state) noexcept { static_cast<void>(state); }
  /// Receives input and output of a tick; the servo's timings are in `output`.
  virtual void put(const ProbeSample& input, const HapticState& output) noexcept = 0;
  /// Receives a snapshot of the bricks of a program's paged grids (brick_pager.h), before a tick can use it. Not on the haptic thread.
  virtual void add_bricks(const field::BrickSnapshot& bricks) { static_cast<void>(bricks); }
};

class BrickPager;
class Watchdog;

/// Options of a servo.
struct ServoOptions {
  static constexpr double kMinRateHz = 100, kMaxRateHz = 10000;  ///< allowed rates

  double rate_hz = 1000;          ///< ticks per second, kMinRateHz..kMaxRateHz
  bool paced = true;              ///< false: as fast as possible (soak tests, determinism); never late, no watchdog, normal priority
  std::uint64_t max_ticks = 0;    ///< number of ticks to run; 0: until stop()
  TickSink* sink = nullptr;       ///< receives every tick; must outlive the servo or be removed by set_sink; null: none
  bool forces_enabled = true;     ///< initial state of the user's force switch; later set_forces_enabled()
  double watchdog_s = 0.05;       ///< time without a finished tick after which the watchdog acts, raised to at least four periods; 0: none
  RealtimeOptions realtime = {};  ///< real-time properties of a paced servo's thread
};

/// Servo: one device, one haptic thread, one program at a time. Each cycle wakes at an absolute deadline (deadline_clock.h), reads the
/// device, takes the newest program without waiting, runs the tick, writes the force and publishes one HapticState.
/// Two threads use a Servo: the frame thread calls the public functions, the haptic thread runs the loop; a third one, the watchdog, reads
/// a time stamp. They share two triple buffers, flags, counters and two pointers, all lock-free. The haptic thread never frees memory: the
/// frame thread keeps each program until a published epoch shows that a newer one has run.
///
/// Condition of a tick:
///   WATCHDOG   no tick ended for watchdog_s, as detected by the watchdog or, if the whole program was stopped (SIGSTOP), by the haptic
///              thread. The device has been stopped; the next tick resumes it. A tick that itself takes longer than watchdog_s stops the
///              device before it writes the force, and the next tick has this condition.
///   NO_DEVICE  the device is not ready
///   LATE       the time of the tick is more than two periods after that of the last tick
///   NORMAL     else
/// A paced servo whose ticks miss deadlines 1000 times in a row, or in every tick for 1 s, releases its fixed priority.
class CATENA_EXPORT Servo {
 public:
  /// Creates a servo. The device must outlive it. Nothing runs before start().
  Servo(Device& device, std::shared_ptr<const HapticProgram> program, const ServoOptions& options = {});
  ~Servo();
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  // frame thread
  /// Copies the state of the chain from a stopped servo, when another device replaces its device; call it before start(). The force starts
  /// at zero, as always. Epochs of programs must be unique over both servos.
  void resume_from(const Servo& other);
  /// Starts the haptic thread; returns when it is prepared, just before its first tick. An Error if no thread can be created; then nothing
  /// runs.
  Outcome start();
  /// Stops and joins the haptic thread; the device has received a last zero force and is stopped.
  void stop();
  /// Passes a new program to the haptic thread. Its epoch must be unique: older programs are freed when it is published.
  void set_program(std::shared_ptr<const HapticProgram> program);
  /// Gets the newest published state and frees older programs. Returns false, with `state` unchanged, if there is no newer one.
  bool receive(HapticState& state);
  /// Sets another sink, or none, from one of the next ticks on. Waits a tick or two, at most `timeout_s`, until the haptic thread uses it.
  /// Returns true if the old sink is not in use; on false it must stay alive until stop() or until a call returns true.
  bool set_sink(TickSink* sink, double timeout_s = 1);
  /// Returns the hash of all ticks (StateHash); after stop().
  std::uint64_t state_hash() const { return hash_.value(); }
  /// Returns the number of programs that are kept: the one that runs and those that a tick may still use.
  std::size_t live_program_count() const { return programs_.size(); }

  // any thread
  /// Returns whether the haptic thread runs: from start() until max_ticks or stop().
  bool running() const { return running_.load(std::memory_order_acquire); }
  /// Sets the user's force switch, from the next tick on. While it or the device's own switch is off there is no force; the force goes to
  /// zero over DeviceLimits::ramp_out_s (force_limiter.h).
  void set_forces_enabled(bool on) { forces_enabled_.store(on, std::memory_order_relaxed); }
  /// Returns whether the user's force switch is on; the device's own switch may be off.
  bool forces_enabled() const { return forces_enabled_.load(std::memory_order_relaxed); }
  /// Returns the statistics; after start(), also while it runs.
  ServoStats stats() const;

 private:
  void loop() noexcept;
  void await_first_bricks();
  void run_tick(double t_s, const TickTiming& beat, HapticState& out) noexcept;
  void page_bricks(const HapticProgram& program);
  void observe_bricks(TickSink* sink);
  void release_priority_if_overloaded(bool missed, std::int64_t now_ns) noexcept;

  static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::uint64_t>::is_always_lock_free &&
                std::atomic<const HapticProgram*>::is_always_lock_free && std::atomic<TickSink*>::is_always_lock_free);
  Device& device_;
  ServoOptions options_;
  TripleBuffer<const HapticProgram*> next_program_;
  TripleBuffer<HapticState> published_;
  std::atomic<bool> stop_{false}, running_{false}, prepared_{false}, forces_enabled_;
  std::atomic<TickSink*> requested_sink_, active_sink_;
  std::atomic<BrickPager*> active_pager_{nullptr};  ///< that of pager_
  ServoCounters counters_;

  // used by the haptic thread only, after start()
  const HapticProgram* program_ = nullptr;
  TickSink* sink_ = nullptr;
  ChainState state_;
  ChainScratch scratch_;
  StateHash hash_;
  std::optional<DeviceInput> first_input_;  ///< of the next tick, if it has been read
  bool stopped_ = false;          ///< the watchdog has stopped the device
  bool stalled_in_tick_ = false;  ///< the last tick took longer than the watchdog's limit
  int misses_in_row_ = 0;
  std::int64_t missing_since_ns_ = 0;

  // used by the frame thread only; realtime_ is written by the haptic thread before it sets prepared_
  RealtimeReport realtime_;
  std::vector<std::shared_ptr<const HapticProgram>> programs_;
  std::unique_ptr<Watchdog> watchdog_;  ///< null: no watchdog
  std::unique_ptr<BrickPager> pager_;   ///< null: no program had paged grids
  std::thread thread_;
};

}  // namespace catena::haptics
