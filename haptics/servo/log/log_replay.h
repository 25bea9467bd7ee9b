/// Runs the tick again over what a log recorded, and compares everything that came out with what was recorded, bit by bit. Off the tick.
#pragma once
#include <functional>
#include <memory>

#include "haptics/servo/log/reader.h"
#include "haptics/servo/replay.h"

namespace catena::haptics::log {

struct LogReplay {
  ReplayStats stats;  ///< of the ticks that ran again
  std::uint64_t differing = 0;
  std::uint64_t first_differing = 0;  ///< tick
  std::string difference;             ///< "force_x recorded 1, replayed 2"
  std::string stop_reason;            ///< why not all ticks could run again: a gap, an unknown program. Empty: all have

  bool exact() const { return differing == 0 && stop_reason.empty(); }
};

struct LogReplayHooks {
  /// The program that the log names, built anew. Its links get the recorded recipes, so that they keep their state as they did.
  std::function<Result<std::shared_ptr<const HapticProgram>>(const LogProgram&)> build;
  /// After every tick: what the replay gave.
  std::function<void(const LogProgram&, const HapticState&)> on_tick;
};

/// To the end of the log, past differences. Stops at a gap: the state after it is not in the log.
Result<LogReplay> replay_log(LogReader& log, const LogReplayHooks& hooks);

}  // namespace catena::haptics::log
