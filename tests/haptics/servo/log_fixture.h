// SPDX-License-Identifier: MIT
/// Shared helpers of the recording tests: a fully read log, and a device that limits the servo to the log's speed.
#pragma once
#include <gtest/gtest.h>
#include <atomic>

#include <thread>

#include "haptics/servo/servo.h"
#include "tests/support/recording_fixture.h"

namespace catena::test {

using namespace haptics;
using namespace haptics::log;

struct LogContents {
  std::vector<std::uint64_t> ticks;
  std::vector<LogGap> gaps;
  int programs = 0;
  bool clean = false, damaged = false, opened = false;
  std::string ending;
};

inline LogContents read_all(std::string_view bytes) {
  LogContents out;
  auto reader = LogReader::open(make_memory_source(bytes), "x.catlog");
  if (!reader) {
    out.ending = reader.error().message;
    return out;
  }
  out.opened = true;
  for (LogEvent e = reader->next(); e != LogEvent::done; e = reader->next()) {
    if (e == LogEvent::tick) out.ticks.push_back(reader->tick().output.tick);
    if (e == LogEvent::gap) out.gaps.push_back(reader->gap());
    if (e == LogEvent::program) ++out.programs;
  }
  out.clean = reader->end().has_value();
  out.damaged = reader->damaged();
  out.ending = reader->end_summary();
  return out;
}

inline bool rising_from_one(const std::vector<std::uint64_t>& ticks) {
  for (std::size_t i = 0; i < ticks.size(); ++i)
    if (ticks[i] != i + 1) return false;
  return true;
}

// A device that limits the servo to the speed at which the log is written.
class ThrottledDevice final : public Device {
 public:
  ThrottledDevice(const LogWriter& writer, std::vector<ProbeSample> path) : writer_(writer), path_(std::move(path)) {}
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override {
    while (reads_ > writer_.status().ticks + 3000 || reads_ >= allowed_.load(std::memory_order_acquire)) std::this_thread::yield();
    const ProbeSample& p = path_[reads_ % path_.size()];
    DeviceInput input;
    input.position_m = p.position;
    input.orientation = p.orientation;
    input.buttons = p.buttons;
    input.forces_on = p.forces_on;
    input.status = p.condition == TickCondition::no_device ? DeviceStatus::lost : DeviceStatus::ready;
    ++reads_;
    return input;
  }
  void write(const DeviceOutput&) noexcept override {}
  void allow(std::uint64_t ticks) { allowed_.store(ticks, std::memory_order_release); }  ///< counted from the start

 private:
  const LogWriter& writer_;
  std::atomic<std::uint64_t> allowed_{~std::uint64_t{0}};
  std::vector<ProbeSample> path_;
  DeviceCapabilities capabilities_;
  std::uint64_t reads_ = 0;
};

inline std::shared_ptr<const HapticProgram> make_numbered_program(std::uint64_t epoch) {
  return epoch % 3 == 0 ? make_level_program(epoch, {"a"}) : make_level_program(epoch, {"b", "a"});
}

inline Result<LogReplay> replay_numbered(LogReader& reader) {
  LogReplayHooks hooks;
  hooks.build = [](const LogProgram& p) -> Result<std::shared_ptr<const HapticProgram>> { return make_numbered_program(p.epoch); };
  return replay_log(reader, hooks);
}

inline LogOptions fast_flush() {
  LogOptions options;
  options.flush_s = 0.001;
  options.sync_s = 0.2;
  return options;
}

}  // namespace catena::test
