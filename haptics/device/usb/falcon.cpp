// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include "engine/base/result.h"
#include "engine/base/threads.h"

namespace catena::haptics::usb {
namespace {

static_assert(std::atomic<FalconState>::is_always_lock_free);
constexpr int kSliceMs = 50;                              // longest delay until the thread notices that it must end
constexpr int kTuneAfter = 3;                             // cycles without a frame after which the line is reconfigured
constexpr int kLookEvery = 500, kStartAgainEvery = 1000;  // cycles between checks of the watchdog process; and after a failed start
constexpr std::uint8_t kOutEndpoint = 0x02;

bool take_realtime(int priority) noexcept {
  if (priority <= 0) return false;
  sched_param parameter{};
  parameter.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) == 0;
}

}  // namespace

DeviceCapabilities Falcon::nominal_capabilities() {
  DeviceCapabilities c;
  c.name = "Novint Falcon";
  c.workspace_m = 0.06;
  c.workspace_center_m = kFalconWorkspaceCenter;
  c.button_count = 4;
  // The data sheet of Novint states more than 2 lbf. The maximum force in every direction is 6.1 N at the center and 4.5 N in the corners
  // of the cube; larger forces are clamped.
  c.max_force_n = 8.9;
  // Assumed, not identified: mass and damping as in the stability table, little friction. The encoder step is derived (one count of an axis
  // at z = 110 mm); the delay is one to two round trips of the bus.
  c.mechanics = {.mass_kg = 0.159, .damping_ns_per_m = 0.5, .friction_n = 0.1, .encoder_step_m = 37.7e-6, .delay_s = 2e-3};
  return c;
}

Result<std::unique_ptr<Falcon>> Falcon::open(std::unique_ptr<TransportSource> source, FalconOptions options) {
  CATENA_ASSERT(source && options.force_gain > 0 && options.lost_after_cycles > 0 && options.clock != nullptr);
  std::unique_ptr<WatchdogSharedMemory> memory;
  if (options.watchdog) {
    CATENA_TRY(memory, WatchdogSharedMemory::make(kOutEndpoint, encode_command({})));
  }
  CATENA_TRY(std::unique_ptr<Transport> transport, source->open());
  auto falcon = std::unique_ptr<Falcon>(new Falcon(std::move(source), std::move(options), std::move(transport), std::move(memory)));
  Ftdi ftdi(*falcon->transport_, falcon->counters_.ftdi);
  CATENA_CHECK(falcon_boot(ftdi, falcon->options_.firmware, falcon->options_.boot, &falcon->counters_.uploads));
  falcon->pose_ = {.position_m = kFalconWorkspaceCenter, .state = FalconState::homing};
  falcon->publish(falcon->pose_);
  CATENA_CHECK(falcon->start_watchdog());
  CATENA_TRY(falcon->thread_, start_thread("the Falcon", [device = falcon.get()] { device->run(); }));
  return falcon;
}

Falcon::Falcon(std::unique_ptr<TransportSource> source, FalconOptions options, std::unique_ptr<Transport> transport,
               std::unique_ptr<WatchdogSharedMemory> memory)
    : options_(std::move(options)), watchdog_memory_(std::move(memory)), source_(std::move(source)), transport_(std::move(transport)) {}

Falcon::~Falcon() {
  quit_ = true;
  if (thread_.joinable()) thread_.join();
  if (watchdog_) watchdog_->quit();  // no thread has run that could have output force
  watchdog_.reset();
  transport_.reset();  // must be destroyed before its source
}

Outcome Falcon::start_watchdog() {
  if (!watchdog_memory_) return Done{};
  watchdog::SharedPage& page = watchdog_memory_->page();
  page.force_active.store(0);
  page.holder.store(watchdog::Holder::program);
  watchdog_.reset();
  CATENA_TRY(watchdog_, options_.watchdog(*transport_, *watchdog_memory_));
  cycles_until_check_ = kLookEvery;
  return Done{};
}

// ---- haptic thread ----

DeviceInput Falcon::read() noexcept {
  poses_.acquire();
  const FalconPose& pose = poses_.front();
  const std::int64_t now_ns = options_.clock();
  DeviceInput input;
  input.position_m = pose.position_m;
  input.buttons = pose.buttons;
  input.age_s = pose.sampled_ns == 0 ? 0 : 1e-9 * static_cast<double>(now_ns - pose.sampled_ns);
  // the I/O thread has cut the force since the last command: the servo must ramp it in
  const bool let_go = last_push_ns_ != 0 && 1e-9 * static_cast<double>(now_ns - last_push_ns_) >= options_.command_timeout_s;
  // the watchdog process has taken the device since the last tick
  const std::uint64_t takeovers = takeovers_.load(std::memory_order_acquire);
  const bool taken = takeovers != acknowledged_takeovers_;
  acknowledged_takeovers_ = takeovers;
  input.forces_on = pose.state == FalconState::ready;
  const bool homed = pose.state == FalconState::ready || pose.state == FalconState::arming;
  if (pose.state == FalconState::booting || pose.state == FalconState::homing)
    input.status = DeviceStatus::starting;
  else if (!homed || !pose.valid || let_go || taken || input.age_s > options_.max_pose_age_s)
    input.status = DeviceStatus::lost;
  return input;
}

void Falcon::write(const DeviceOutput& output) noexcept {
  const ForceCommand order{is_finite(output.force_n) ? output.force_n : Vec3(0.0), options_.clock(), acknowledged_takeovers_};
  if (watchdog_memory_) watchdog_memory_->page().ticks.fetch_add(1, std::memory_order_release);
  last_push_ns_ = max_abs(order.force_n) > 0 ? order.written_ns : 0;
  force_commands_.publish(order);
}

void Falcon::resume() noexcept {
  // a command from before the stop must not take effect
  last_push_ns_ = 0;
  force_commands_.publish({Vec3(0.0), options_.clock(), acknowledged_takeovers_});
  stopped_.store(false);
}

// ---- any thread ----

std::string Falcon::status_text() const {
  const std::uint8_t homed = homed_.load(std::memory_order_relaxed);
  switch (state()) {
    case FalconState::absent: {
      const std::lock_guard lock(problem_mutex_);
      return problem_.empty() ? "Falcon: the connection is lost; check the USB cable and the power" : problem_;
    }
    case FalconState::booting:
      return boot_attempt_ == 0
                 ? std::string("Falcon: the device is connected again and starts")
                 : fmt::format("Falcon: the firmware is being sent, attempt {}, {} %", boot_attempt_.load(), boot_percent_.load());
    case FalconState::homing:
      return fmt::format("Falcon: pull the grip fully out, then push it in (homed: {} of 3 axes)",
                         (homed & 1) + ((homed >> 1) & 1) + ((homed >> 2) & 1));
    case FalconState::arming:
      return "Falcon: pull the grip fully out once to switch the forces on";
    case FalconState::ready:
      break;
  }
  if (unwatched_) {
    const std::lock_guard lock(problem_mutex_);
    return "Falcon: the forces are off: " + problem_;
  }
  return stopped_ ? "Falcon: the forces are stopped" : "";
}

FalconStats Falcon::stats() const {
  const auto get = [](const std::atomic<std::uint64_t>& counter) { return counter.load(std::memory_order_relaxed); };
  const FalconCounters& c = counters_;
  return {.cycles = get(c.cycles),
          .frames = get(c.frames),
          .bad_cycles = get(c.bad_cycles),
          .packets_out = get(c.ftdi.packets_out),
          .packets_in = get(c.ftdi.packets_in),
          .idle_packets = get(c.ftdi.idle_packets),
          .resyncs = get(c.resyncs),
          .dropped_bytes = get(c.dropped_bytes),
          .timeouts = get(c.ftdi.timeouts),
          .stalls = get(c.ftdi.stalls),
          .retries = get(c.ftdi.retries),
          .errors = get(c.ftdi.errors),
          .line_errors = get(c.ftdi.line_errors),
          .jumps = get(c.jumps),
          .out_of_reach = get(c.out_of_reach),
          .saturated = get(c.saturated),
          .stale_commands = get(c.stale_commands),
          .uploads = get(c.uploads),
          .disconnects = get(c.disconnects),
          .reconnects = get(c.reconnects),
          .takeovers = get(takeovers_),
          .watchdog_restarts = get(watchdog_restarts_),
          .realtime = realtime_.load(std::memory_order_relaxed)};
}

// ---- I/O thread ----

void Falcon::publish(const FalconPose& pose) noexcept {
  poses_.publish(pose);
  state_.store(pose.state, std::memory_order_relaxed);
}

void Falcon::set_problem(const std::string& text) {
  const std::lock_guard lock(problem_mutex_);
  problem_ = text;
}

// Takes the newest force command into front(). Returns false if there has been none for command_timeout_s.
bool Falcon::has_fresh_command() noexcept {
  force_commands_.acquire();
  const ForceCommand& order = force_commands_.front();
  const bool fresh = order.written_ns != 0 && 1e-9 * static_cast<double>(options_.clock() - order.written_ns) < options_.command_timeout_s;
  if (had_fresh_command_ && !fresh) increment(counters_.stale_commands);
  had_fresh_command_ = fresh;
  return fresh;
}

void Falcon::run() noexcept {
  realtime_ = take_realtime(options_.realtime_priority);
  while (!quit_) {
    if (transport_)
      run_session();
    else
      wait_for_reconnect();
  }
}

// Sends a packet. If a packet with force was delayed because the program was suspended during the call, a zero-force packet follows.
bool Falcon::send(FalconSession& session, bool forces) noexcept {
  watchdog::SharedPage* page = watchdog_memory_ ? &watchdog_memory_->page() : nullptr;
  if (page != nullptr) {
    page->cycles.fetch_add(1, std::memory_order_relaxed);
    if (forces) page->force_active.store(1, std::memory_order_release);
  }
  const std::int64_t began = options_.clock();
  if (!session.send(force_commands_.front().force_n, forces)) return false;
  const bool late = 1e-9 * static_cast<double>(options_.clock() - began) > options_.command_timeout_s;
  if (forces && (late || (page != nullptr && page->holder.load(std::memory_order_acquire) == watchdog::Holder::watchdog)))
    session.release_force();
  zero_force_confirmed_.store(session.zero_force_confirmed());
  if (page != nullptr && session.zero_force_confirmed()) page->force_active.store(0, std::memory_order_release);
  return true;
}

// Handles a takeover by the watchdog process, which has cut the force: sends a zero-force packet, too, and takes the device back. Data sent
// by the device in between is outdated and discarded.
bool Falcon::handle_takeover(FalconSession& session, Ftdi& ftdi) noexcept {
  if (!watchdog_memory_ || watchdog_memory_->page().holder.load(std::memory_order_acquire) == watchdog::Holder::program) return false;
  session.release_force();
  publish(session.pose());
  ftdi.purge_in();
  takeovers_.fetch_add(1, std::memory_order_release);
  watchdog_memory_->page().holder.store(watchdog::Holder::program, std::memory_order_release);
  return true;
}

// Returns whether the watchdog process runs or none is required. Restarts a process that has ended.
bool Falcon::ensure_watchdog(FalconSession& session) noexcept {
  if (!watchdog_memory_) return true;
  if (--cycles_until_check_ > 0) return watchdog_ != nullptr;
  cycles_until_check_ = kLookEvery;
  if (watchdog_ && watchdog_->is_alive()) return true;
  // starting a process takes time, which is not allowed while force is on
  session.release_force();
  increment(watchdog_restarts_);
  const Outcome started = start_watchdog();
  if (!started) {
    set_problem(started.error().message);
    cycles_until_check_ = kStartAgainEvery;
  }
  unwatched_ = !started;
  return static_cast<bool>(started);
}

// Runs until the device is lost or the thread must end.
void Falcon::run_session() noexcept {
  Ftdi ftdi(*transport_, counters_.ftdi);
  FalconSession session(ftdi, counters_, options_.force_gain, options_.clock, pose_.position_m);
  int silent = 0;
  auto cycle = FalconSession::Cycle::frame;
  while (!quit_ && cycle != FalconSession::Cycle::disconnected && silent < options_.lost_after_cycles) {
    const bool held = handle_takeover(session, ftdi), fresh = has_fresh_command();
    zero_force_confirmed_.store(false);
    const bool forces =
        ensure_watchdog(session) && !held && fresh && !stopped_ && force_commands_.front().acknowledged_takeovers == takeovers_;
    cycle = send(session, forces) ? session.receive() : FalconSession::Cycle::disconnected;
    if (cycle == FalconSession::Cycle::frame) {
      silent = 0;
      homed_.store(session.homed(), std::memory_order_relaxed);
      publish(session.pose());
    } else if (++silent == kTuneAfter) {
      // configuring the line may take a second, which is not allowed while force is on
      session.release_force();
      publish(session.pose());
      increment(counters_.ftdi.retries);
      enter_falcon_run_mode(ftdi);
    }
  }
  session.send_shutdown();
  zero_force_confirmed_.store(session.zero_force_confirmed() || cycle == FalconSession::Cycle::disconnected);
  // a device that has not acknowledged the zero force is left to the watchdog
  if (watchdog_ && (session.zero_force_confirmed() || cycle == FalconSession::Cycle::disconnected)) watchdog_->quit();
  watchdog_.reset();
  transport_.reset();
  if (quit_) return;
  increment(counters_.disconnects);
  set_problem("");
  pose_ = session.pose();
  pose_.state = FalconState::absent;
  pose_.valid = false;
  publish(pose_);
}

// Waits for the device, opens it and starts its firmware, like open(); called until it succeeds.
void Falcon::wait_for_reconnect() noexcept {
  bool arrived = false;
  for (int waited = 0; waited < options_.reconnect_poll_ms && !arrived && !quit_; waited += kSliceMs)
    arrived = source_->wait_for_arrival(std::min(kSliceMs, options_.reconnect_poll_ms - waited));
  if (quit_) return;
  auto opened = source_->open();
  if (!opened) {
    set_problem(opened.error().message);
    return;
  }
  transport_ = std::move(*opened);
  boot_attempt_ = 0;
  pose_.state = FalconState::booting;
  publish(pose_);
  FalconBootOptions boot = options_.boot;
  boot.progress = [this](int attempt, double share) {
    boot_attempt_ = attempt;
    boot_percent_ = static_cast<int>(100 * share);
    return true;
  };
  boot.should_abort = [this] { return quit_.load(); };
  Ftdi ftdi(*transport_, counters_.ftdi);
  Outcome booted = falcon_boot(ftdi, options_.firmware, boot, &counters_.uploads);
  if (booted) booted = start_watchdog();
  if (!booted) {
    set_problem(booted.error().message);
    transport_.reset();
    pose_.state = FalconState::absent;
    publish(pose_);
    return;
  }
  increment(counters_.reconnects);
  pose_.state = FalconState::homing;
  publish(pose_);
}

}  // namespace catena::haptics::usb
