// SPDX-License-Identifier: MIT
/// Shared helpers of the recording tests: a fully read log, and a device that limits the servo to the log's speed.
#pragma once
#include <gtest/gtest.h>

#include <atomic>

#include "tests/haptics/device/scripted_device.h"
#include "tests/haptics/servo/run_servo.h"
#include "tests/support/recording_fixture.h"
#include "tests/support/results.h"

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

/// Plays a path in a loop; its reads block after `allowed` ticks, and while the writer is 3000 ticks behind.
class PathDevice final : public ScriptedDevice {
 public:
  explicit PathDevice(std::vector<ProbeSample> path, std::uint64_t allowed_ticks = 0, const LogWriter* writer = nullptr)
      : allowed(allowed_ticks), path_(std::move(path)), writer_(writer) {}
  DeviceInput read() noexcept override {
    while (reads_ >= allowed || (writer_ != nullptr && reads_ > writer_->status().ticks + 3000)) std::this_thread::yield();
    const ProbeSample& p = path_[reads_++ % path_.size()];
    DeviceInput now;
    now.position_m = p.position;
    now.orientation = p.orientation;
    now.buttons = p.buttons;
    now.forces_on = p.forces_on;
    now.status = p.condition == TickCondition::no_device ? DeviceStatus::lost : DeviceStatus::ready;
    return now;
  }
  std::atomic<std::uint64_t> allowed;  ///< counted from the start

 private:
  std::vector<ProbeSample> path_;
  const LogWriter* writer_;
  std::uint64_t reads_ = 0;
};

/// Replay of a recording; an error of it ends the test case.
inline LogReplay replay_of(Result<LogReader> reader, const std::vector<ProgramChange>& changes) {
  return value_of(replay_log(*reader, make_replay_hooks(changes)));
}

inline std::shared_ptr<const HapticProgram> make_numbered_program(std::uint64_t epoch) {
  return epoch % 3 == 0 ? make_level_program(epoch, {"a"}) : make_level_program(epoch, {"b", "a"});
}

/// Replay of a recording with make_numbered_program(), which must be exact.
inline LogReplay replay_numbered(LogReader& reader) {
  LogReplayHooks hooks;
  hooks.build = [](const LogProgram& p) -> Result<std::shared_ptr<const HapticProgram>> { return make_numbered_program(p.epoch); };
  LogReplay result = value_of(replay_log(reader, hooks));
  EXPECT_TRUE(result.exact()) << result.first_differing << " " << result.difference << result.stop_reason;
  return result;
}

inline LogOptions fast_flush() {
  LogOptions options;
  options.flush_s = 0.001;
  options.sync_s = 0.2;
  return options;
}

}  // namespace catena::test
