// SPDX-License-Identifier: MIT
/// Reads a log, complete or truncated at any byte: programs, ticks and gaps in their order. Uses the memory of one block. Off the tick.
///   CATENA_TRY(LogReader log, LogReader::open(path));
///   for (LogEvent e = log.next(); e != LogEvent::done; e = log.next()) if (e == LogEvent::tick) use(log.tick());
#pragma once
#include <array>

#include "engine/base/export.h"
#include "haptics/servo/log/block_file.h"
#include "haptics/servo/log/contents.h"
#include "haptics/servo/log/poses.h"
#include "haptics/servo/log/record.h"

namespace catena::haptics::log {

/// Event returned by LogReader::next().
enum class LogEvent {
  program,  ///< a program takes over with the next tick
  state,    ///< the log begins after tick state().tick
  tick,     ///< a tick
  gap,      ///< ticks are missing
  poses,    ///< poses of some frames of a headset
  bricks,   ///< other bricks of paged grids are in memory from the next tick on
  done      ///< end of the log
};

/// Reader of a log. One thread.
class CATENA_EXPORT LogReader {
 public:
  /// Opens a file and reads its header. An Error if it cannot be read, is no recording, or has another version or byte order or a damaged
  /// header.
  static Result<LogReader> open(const std::string& path);
  /// Opens a log from any source; every error message starts with `name`.
  static Result<LogReader> open(std::unique_ptr<ByteSource> source, const std::string& name);

  /// Returns the header.
  const LogHeader& header() const { return header_; }
  /// Advances to the next event.
  LogEvent next();
  /// Returns the program of the ticks that follow.
  const LogProgram& program() const { return program_; }
  /// Returns the tick; after LogEvent::tick.
  const LogTick& tick() const { return tick_; }
  /// Returns the record of the same tick (record.h).
  const RecordWords& record_words() const { return record_words_; }
  /// Returns the gap; after LogEvent::gap.
  const LogGap& gap() const { return gap_; }
  /// Returns the state from which the log begins; after LogEvent::state.
  const LogState& state() const { return state_; }
  /// Returns the poses; after LogEvent::poses.
  const std::vector<LogPoses>& poses() const { return poses_; }
  /// Returns the bricks in memory, sorted.
  const std::vector<LogBrick>& bricks() const { return bricks_; }

  /// Returns the number of the last tick so far, missing ones included.
  std::uint64_t last_tick() const { return last_tick_; }
  /// Returns the end block, after LogEvent::done; none: the log is truncated.
  const std::optional<LogEnd>& end() const { return end_; }
  /// Returns whether damage has been found so far.
  bool damaged() const { return damaged_; }
  /// Returns one line, after LogEvent::done: "ends cleanly with tick 5" or "truncated after tick 5", and whether the log is damaged.
  std::string end_summary() const;

 private:
  explicit LogReader(BlockReader blocks) : blocks_(std::move(blocks)) {}
  LogEvent next_record();
  std::optional<LogEvent> read_block();
  std::optional<LogEvent> read_program();
  std::optional<LogEvent> read_ticks();
  std::optional<LogEvent> read_state();
  std::optional<LogEvent> read_gap();
  std::optional<LogEvent> read_poses();
  std::optional<LogEvent> read_bricks();
  std::optional<LogEvent> read_end();
  LogEvent report_gap_before(std::uint64_t next);
  bool mark_damaged();

  BlockReader blocks_;
  LogHeader header_;
  LogProgram program_;
  LogTick tick_;
  RecordWords record_words_{};
  LogGap gap_;
  LogState state_;
  std::vector<LogPoses> poses_;
  std::vector<LogBrick> bricks_;
  std::optional<LogEnd> end_;
  bool has_program_ = false, damaged_ = false, finished_ = false, reprocess_block_ = false;
  std::uint64_t next_sequence_ = 1, last_tick_ = 0;

  // block of ticks that is being read
  std::string_view records_;
  std::uint32_t records_left_ = 0;
  RecordLayout layout_;
};

}  // namespace catena::haptics::log
