// SPDX-License-Identifier: MIT
/// Replay of a log: runs the tick on the recorded inputs and compares all results with the recorded ones, bit by bit. Off the tick.
#pragma once
#include <functional>
#include <memory>

#include "haptics/servo/log/reader.h"
#include "haptics/servo/replay.h"

namespace catena::haptics::log {

/// Result of the replay of a log.
struct LogReplay {
  ReplayStats stats;                  ///< statistics of the replayed ticks
  std::uint64_t differing = 0;        ///< number of ticks whose result differs
  std::uint64_t first_differing = 0;  ///< number of the first differing tick
  std::string difference;             ///< first difference, such as "force_x recorded 1, replayed 2"
  std::string stop_reason;            ///< why the replay stopped early: a gap, an unknown program; empty: all ticks ran

  /// Returns whether all ticks ran and are bit-identical to the recorded ones.
  bool exact() const { return differing == 0 && stop_reason.empty(); }
};

/// Functions that a replay calls.
struct LogReplayHooks {
  /// Builds the program that the log names. Its links then get the recorded spec hashes, so that they keep their state as in the recording.
  std::function<Result<std::shared_ptr<const HapticProgram>>(const LogProgram&)> build;
  /// Receives the replayed result of every tick; may be empty.
  std::function<void(const LogProgram&, const HapticState&)> on_tick;
};

/// Replays the log to its end, also after differences. Stops at a gap, since the state after it is not in the log. An Error if a program
/// cannot be built or does not match the log, or if a recorded state is invalid or of another build of Catena.
Result<LogReplay> replay_log(LogReader& log, const LogReplayHooks& hooks);

}  // namespace catena::haptics::log
