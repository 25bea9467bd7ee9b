#include "haptics/servo/servo.h"

#include <ctime>

#include "engine/base/assert.h"
#include "engine/base/clock.h"

namespace catena::haptics {

static_assert(std::atomic<bool>::is_always_lock_free);

Servo::Servo(Device& device, std::shared_ptr<const Program> program, const ServoOptions& options) : device_(device), options_(options) {
  CATENA_ASSERT(program && program->links.size() <= static_cast<std::size_t>(kMaxLinks) && options.rate_hz > 0);
  program_ = program.get();
  programs_.push_back(std::move(program));
}

Servo::~Servo() { stop(); }

void Servo::start() {
  CATENA_ASSERT(!thread_.joinable());
  stop_.store(false, std::memory_order_release);
  running_.store(true, std::memory_order_release);
  thread_ = std::thread([this] { loop(); });
}

void Servo::stop() {
  stop_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

void Servo::set_program(std::shared_ptr<const Program> program) {
  CATENA_ASSERT(program && program->links.size() <= static_cast<std::size_t>(kMaxLinks));
  next_program_.publish(program.get());
  programs_.push_back(std::move(program));
}

bool Servo::take(exchange::HapticState& state) {
  if (!published_.take()) return false;
  state = published_.front();
  // a published epoch proves that no later tick can name an older program
  std::size_t newest = 0;
  for (std::size_t i = 0; i < programs_.size(); ++i)
    if (programs_[i]->epoch == state.program_epoch) newest = i;
  programs_.erase(programs_.begin(), programs_.begin() + static_cast<std::ptrdiff_t>(newest));
  return true;
}

void Servo::one_tick(double t_s, exchange::HapticState& out) noexcept {
  if (next_program_.take()) {
    const Program* newer = next_program_.front();
    rebind(*program_, *newer, state_, scratch_);
    program_ = newer;
  }
  const DeviceInput input = device_.read();
  // device metres -> world: origin + R p / S
  ProbeSample probe;
  probe.buttons = input.buttons;
  probe.t_s = input.recorded ? input.t_s : t_s;
  probe.position = input.recorded
                       ? input.position_m
                       : program_->workspace_origin + program_->workspace_rotation * input.position_m * (1 / program_->metres_per_unit);
  // the tool's orientation turns with the workspace; a recorded one is in world axes already
  probe.orientation = input.recorded ? input.orientation : glm::quat_cast(program_->workspace_rotation) * input.orientation;
  probe.condition = input.status == DeviceStatus::ready ? Condition::normal : Condition::no_device;
  probe.forces_on = input.forces_on;
  tick(*program_, probe, state_, scratch_, out);
  // v * R = R^T v: back to the device's axes
  device_.write({out.force_n * program_->workspace_rotation, out.torque_nm * program_->workspace_rotation});
  if (options_.sink != nullptr) options_.sink->put(probe, out);
}

void Servo::loop() noexcept {
  const auto period_ns = static_cast<std::int64_t>(1e9 / options_.rate_hz);
  const std::int64_t first_deadline = now_ns() + period_ns;
  std::int64_t deadline = first_deadline;
  exchange::HapticState out;
  for (std::uint64_t k = 0; !stop_.load(std::memory_order_acquire) && (options_.max_ticks == 0 || k < options_.max_ticks); ++k) {
    if (options_.paced) {
      const timespec wake{static_cast<std::time_t>(deadline / 1000000000), static_cast<long>(deadline % 1000000000)};
      while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) != 0 && !stop_.load(std::memory_order_acquire)) {
      }
    }
    const std::int64_t woke = now_ns();
    const double nominal_s =
        options_.paced ? 1e-9 * static_cast<double>(deadline - first_deadline) : static_cast<double>(k) / options_.rate_hz;
    one_tick(nominal_s, out);
    hash_.add(out);
    out.compute_us = static_cast<double>(now_ns() - woke) * 1e-3;
    // a tick that ends after the next deadline has missed it: skip to the next one that can still be met
    deadline += period_ns;
    if (options_.paced) {
      for (int skipped = 0; deadline < now_ns() && skipped < 1000; ++skipped) {
        ++out.missed_deadlines;
        deadline += period_ns;
      }
      if (deadline < now_ns()) deadline = now_ns() + period_ns;
    }
    published_.publish(out);
  }
  device_.write({});
  running_.store(false, std::memory_order_release);
}

}  // namespace catena::haptics
