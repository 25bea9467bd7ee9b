// SPDX-License-Identifier: MIT
#include "haptics/servo/servo.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/result.h"
#include "engine/base/threads.h"
#include "haptics/servo/brick_pager.h"
#include "haptics/servo/servo_tick.h"
#include "haptics/servo/watchdog.h"

namespace catena::haptics {

namespace {

// SCHED_FIFO priority is given up after this many consecutive late ticks, or after this time with every tick late
constexpr int kMissesUntilNormal = 1000;
constexpr std::int64_t kMissesUntilNormalNs = 1'000'000'000;

void add_one(std::atomic<std::uint64_t>& counter, std::uint64_t n = 1) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + n, std::memory_order_relaxed);
}

double microseconds(std::int64_t ns) noexcept { return 1e-3 * static_cast<double>(ns); }

void sleep_until(std::int64_t ns, const std::atomic<bool>& stop) noexcept {
  const timespec wake{static_cast<std::time_t>(ns / 1000000000), static_cast<long>(ns % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) != 0 && !stop.load(std::memory_order_acquire)) {
  }
}

/// Real-time options of a run. Unpaced runs must not occupy the machine, and do not benefit from locked memory.
RealtimeOptions realtime_options(const ServoOptions& options) {
  if (options.paced) return options.realtime;
  return {.fifo = false, .lock_memory = false, .cpu = RealtimeOptions::kUnbound};
}

}  // namespace

Servo::Servo(Device& device, std::shared_ptr<const HapticProgram> program, const ServoOptions& options)
    : device_(device),
      options_(options),
      forces_enabled_(options.forces_enabled),
      requested_sink_(options.sink),
      active_sink_(options.sink),
      sink_(options.sink) {
  CATENA_ASSERT(program && program->links.size() <= static_cast<std::size_t>(kMaxLinks));
  CATENA_ASSERT(options.rate_hz >= ServoOptions::kMinRateHz && options.rate_hz <= ServoOptions::kMaxRateHz && options.watchdog_s >= 0);
  program_ = program.get();
  page_bricks(*program);
  programs_.push_back(std::move(program));
}

Servo::~Servo() { stop(); }

/// Keeps the bricks around the hand in memory, if the program has paged grids. Frame thread.
void Servo::page_bricks(const HapticProgram& program) {
  if (!pager_ && program.paged_grids.empty()) return;
  if (!pager_) {
    auto pager = BrickPager::start(BrickPager::default_bytes());
    if (!pager) return print_message("note: " + pager.error().message + "; a coarser level is felt");
    pager_ = std::move(*pager);
    if (thread_.joinable()) observe_bricks(requested_sink_.load(std::memory_order_relaxed));
    active_pager_.store(pager_.get(), std::memory_order_release);
  }
  pager_->set_grids(program.paged_grids);
}

/// Passes all further snapshots to a sink. Frame thread.
void Servo::observe_bricks(TickSink* sink) {
  if (!pager_) return;
  pager_->set_observer(sink == nullptr ? BrickPager::Observer() : [sink](const field::BrickSnapshot& bricks) { sink->add_bricks(bricks); });
}

Outcome Servo::start() {
  CATENA_ASSERT(!thread_.joinable());
  observe_bricks(requested_sink_.load(std::memory_order_relaxed));
  if (options_.paced && options_.watchdog_s > 0) {
    const double limit_s = std::max(options_.watchdog_s, 4 / options_.rate_hz);
    CATENA_TRY(watchdog_, Watchdog::make(device_, limit_s, counters_.watchdog_trips));
  }
  stop_.store(false, std::memory_order_release);
  running_.store(true, std::memory_order_release);
  prepared_.store(false, std::memory_order_release);
  auto thread = start_thread("the servo", [this] { loop(); });
  if (!thread) {
    running_.store(false, std::memory_order_release);
    watchdog_.reset();
    return thread.error();
  }
  thread_ = std::move(*thread);
  prepared_.wait(false, std::memory_order_acquire);
  return Done{};
}

void Servo::resume_from(const Servo& other) {
  CATENA_ASSERT(!thread_.joinable() && !other.thread_.joinable());
  state_ = other.state_;
  rebind_program(*other.program_, *program_, state_, scratch_);
}

void Servo::stop() {
  stop_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
  observe_bricks(nullptr);  // the sink may end before the servo
  watchdog_.reset();
}

void Servo::set_program(std::shared_ptr<const HapticProgram> program) {
  CATENA_ASSERT(program && program->links.size() <= static_cast<std::size_t>(kMaxLinks));
  for (const auto& alive : programs_) CATENA_ASSERT(alive->epoch != program->epoch);
  page_bricks(*program);
  next_program_.publish(program.get());
  programs_.push_back(std::move(program));
}

bool Servo::set_sink(TickSink* sink, double timeout_s) {
  observe_bricks(sink);
  requested_sink_.store(sink, std::memory_order_release);
  const std::int64_t began = now_ns();
  while (running() && active_sink_.load(std::memory_order_acquire) != sink) {
    if (1e-9 * static_cast<double>(now_ns() - began) > timeout_s) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

bool Servo::receive(HapticState& state) {
  if (!published_.acquire()) return false;
  state = published_.front();
  // a published epoch proves that no later tick can refer to an older program
  std::size_t newest = 0;
  for (std::size_t i = 0; i < programs_.size(); ++i)
    if (programs_[i]->epoch == state.program_epoch) newest = i;
  programs_.erase(programs_.begin(), programs_.begin() + static_cast<std::ptrdiff_t>(newest));
  return true;
}

ServoStats Servo::stats() const {
  const auto read = [](const auto& counter) { return counter.load(std::memory_order_relaxed); };
  ServoStats out;
  out.rate_hz = options_.rate_hz;
  out.paced = options_.paced;
  out.ticks = read(counters_.ticks);
  out.missed_deadlines = read(counters_.missed_deadlines);
  out.late_ticks = read(counters_.late_ticks);
  out.lost_ticks = read(counters_.lost_ticks);
  out.watchdog_trips = read(counters_.watchdog_trips);
  out.period = counters_.period.summarize();
  out.compute = counters_.compute.summarize();
  out.device = counters_.device.summarize();
  const std::int64_t started = read(counters_.started_ns), ended = read(counters_.ended_ns);
  if (started != 0) out.seconds = 1e-9 * static_cast<double>((ended != 0 ? ended : now_ns()) - started);
  if (prepared_.load(std::memory_order_acquire)) out.realtime = realtime_;
  if (read(counters_.released_fifo)) {
    out.realtime.fifo = false;
    out.realtime.notes.push_back("real-time scheduling was given up, because the ticks take longer than the period");
  }
  return out;
}

void Servo::run_tick(double t_s, const TickTiming& beat, HapticState& out) noexcept {
  // read before the program, because a sink in use must have received each program published before
  TickSink* wanted = requested_sink_.load(std::memory_order_acquire);
  const bool takes_up = wanted != sink_;

  const std::int64_t began = now_ns();
  const DeviceInput input = first_input_ ? *first_input_ : device_.read();
  first_input_.reset();
  const std::int64_t has_read = now_ns();

  if (next_program_.acquire()) {
    const HapticProgram* newer = next_program_.front();
    rebind_program(*program_, *newer, state_, scratch_);
    program_ = newer;
  }
  if (takes_up) {
    sink_ = wanted;
    active_sink_.store(wanted, std::memory_order_release);
    const field::BrickSnapshot* bricks = scratch_.bricks;
    scratch_ = ChainScratch{};
    scratch_.bricks = bricks;
    if (sink_ != nullptr) sink_->begin(state_);
  }
  ProbeSample probe = make_probe_sample(*program_, input, t_s);
  probe.forces_on = input.forces_on && forces_enabled();
  // a recording begins with the bricks of the tick before it
  BrickPager* pager = active_pager_.load(std::memory_order_acquire);
  if (pager != nullptr) probe.bricks = takes_up ? scratch_.bricks : pager->newest();

  // a tick that finds the watchdog's flag outputs no force; the next tick may drive the device
  const bool stalled = watchdog_ && (beat.stalled || stalled_in_tick_);
  if (watchdog_ && beat.stalled) watchdog_->report_stall();
  const bool tripped = (watchdog_ && watchdog_->consume_trip()) || stalled;
  if (stopped_ && !tripped) device_.resume();
  stopped_ = tripped;
  const bool lost = input.status != DeviceStatus::ready;
  probe.condition = tripped     ? TickCondition::watchdog
                    : lost      ? TickCondition::no_device
                    : beat.late ? TickCondition::late
                                : TickCondition::normal;
  tick(*program_, probe, state_, scratch_, out);
  const std::int64_t computed = now_ns();
  if (pager != nullptr) pager->put(out);
  stalled_in_tick_ = watchdog_ && computed - began > watchdog_->limit_ns();
  if (stalled_in_tick_) watchdog_->report_stall();

  device_.write(make_device_output(*program_, out, state_));
  const std::int64_t ended = now_ns();
  hash_.add(out);

  const std::int64_t device_ns = (has_read - began) + (ended - computed);
  counters_.compute.add(computed - has_read);
  counters_.device.add(device_ns);
  if (lost) add_one(counters_.lost_ticks);
  add_one(counters_.ticks);
  out.compute_us = microseconds(computed - has_read);
  out.device_us = microseconds(device_ns);
  out.missed_deadlines = counters_.missed_deadlines.load(std::memory_order_relaxed);
  if (sink_ != nullptr) sink_->put(probe, out);
}

/// Releases SCHED_FIFO priority after a second of missed ticks: it is for ticks that fit into their period.
void Servo::release_priority_if_overloaded(bool missed, std::int64_t now_ns) noexcept {
  if (!missed) misses_in_row_ = 0;
  if (!missed || !realtime_.fifo || counters_.released_fifo.load(std::memory_order_relaxed)) return;
  if (misses_in_row_++ == 0) missing_since_ns_ = now_ns;
  if (misses_in_row_ < kMissesUntilNormal && now_ns - missing_since_ns_ < kMissesUntilNormalNs) return;
  release_fifo_priority();
  counters_.released_fifo.store(true, std::memory_order_relaxed);
}

/// Reads the device for the first tick, and waits a moment for the bricks around the probe.
void Servo::await_first_bricks() {
  constexpr double kMaxWait_s = 0.3;
  BrickPager* pager = active_pager_.load(std::memory_order_acquire);
  if (pager == nullptr || !options_.paced) return;
  first_input_ = device_.read();
  HapticState at;
  at.probe = make_probe_sample(*program_, *first_input_, 0).position;
  pager->put(at);
  pager->wait_until_idle(kMaxWait_s);
}

void Servo::loop() noexcept {
  const RealtimeThread realtime(realtime_options(options_), this, sizeof *this);
  realtime_ = realtime.report();
  await_first_bricks();
  if (watchdog_) watchdog_->start(now_ns(), realtime_.fifo ? options_.realtime.priority + 1 : 0);
  HapticState out;
  device_.resume();
  stopped_ = stalled_in_tick_ = false;
  misses_in_row_ = 0;
  state_.force_limiter = {};  // each run starts at zero force, whatever an earlier run sent
  pause_passivity(state_.passivity);

  const auto period_ns = static_cast<std::int64_t>(1e9 / options_.rate_hz);
  DeadlineClock pace(period_ns, now_ns() + period_ns, watchdog_ ? watchdog_->limit_ns() : DeadlineClock::kNeverStalls);
  counters_.started_ns.store(now_ns(), std::memory_order_relaxed);
  counters_.ended_ns.store(0, std::memory_order_relaxed);
  prepared_.store(true, std::memory_order_release);
  prepared_.notify_all();

  std::int64_t last_begin = 0;
  for (std::uint64_t k = 0; !stop_.load(std::memory_order_acquire) && (options_.max_ticks == 0 || k < options_.max_ticks); ++k) {
    if (options_.paced) sleep_until(pace.next_wake_ns(), stop_);
    const std::int64_t began = now_ns();
    if (last_begin != 0) {
      counters_.period.add(began - last_begin);
      out.period_us = microseconds(began - last_begin);
    }
    last_begin = began;

    double t_s = static_cast<double>(k) / options_.rate_hz;
    TickTiming beat;
    if (options_.paced) {
      beat = pace.begin_tick(began);
      t_s = 1e-9 * static_cast<double>(beat.time_ns);
      add_one(counters_.missed_deadlines, static_cast<std::uint64_t>(beat.missed));
      if (beat.late) add_one(counters_.late_ticks);
      release_priority_if_overloaded(beat.missed > 0, began);
    }
    run_tick(t_s, beat, out);
    published_.publish(out);

    const std::int64_t ended = now_ns();
    pace.end_tick(ended);
    // the thread may also have stalled after the force was computed: in the device, or before this line
    if (watchdog_ && !stalled_in_tick_ && ended - began > watchdog_->limit_ns()) {
      stalled_in_tick_ = true;
      watchdog_->report_stall();
    }
    if (watchdog_) watchdog_->tick_ended(ended);
  }
  device_.write({.forces_active = false});
  device_.stop();
  counters_.ended_ns.store(now_ns(), std::memory_order_relaxed);
  running_.store(false, std::memory_order_release);
}

}  // namespace catena::haptics
