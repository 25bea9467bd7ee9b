/// Reads a log, whole or cut off at any byte: programs, ticks and gaps in their order. Memory: one block. Off the tick.
///   CATENA_TRY(LogReader log, LogReader::open(path));
///   for (LogEvent e = log.next(); e != LogEvent::done; e = log.next()) if (e == LogEvent::tick) use(log.tick());
#pragma once
#include <array>

#include "haptics/servo/log/block_file.h"
#include "haptics/servo/log/contents.h"
#include "haptics/servo/log/poses.h"
#include "haptics/servo/log/record.h"

namespace catena::haptics::log {

/// What next() came to.
enum class LogEvent {
  program,  ///< takes over with the next tick
  state,    ///< the log begins after tick state().tick
  tick,
  gap,    ///< ticks that are not there
  poses,  ///< of some pictures of a headset; those of a session without one have none
  done
};

/// A log that is being read. One thread.
class LogReader {
 public:
  /// The error says what is wrong with the file's first bytes.
  static Result<LogReader> open(const std::string& path);
  static Result<LogReader> open(std::unique_ptr<ByteSource> source,
                                const std::string& name);  ///< The same of any source; `name` begins every message.

  /// What was known before the first tick.
  const LogHeader& header() const { return header_; }
  /// Goes on to the next event.
  LogEvent next();
  const LogProgram& program() const { return program_; }  ///< that of the ticks that follow
  /// After LogEvent::tick.
  const LogTick& tick() const { return tick_; }
  const RecordWords& record_words() const { return record_words_; }  ///< the same tick (record.h)
  /// After LogEvent::gap.
  const LogGap& gap() const { return gap_; }
  /// After LogEvent::state.
  const LogState& state() const { return state_; }
  /// After LogEvent::poses.
  const std::vector<LogPoses>& poses() const { return poses_; }

  /// Number of the newest tick so far.
  std::uint64_t last_tick() const { return last_tick_; }
  /// Once done: the end that the writer wrote; none: the log was cut off.
  const std::optional<LogEnd>& end() const { return end_; }
  bool damaged() const { return damaged_; }  ///< some block was not as it was written
  /// Once done, one line: "ends cleanly with tick 5", "cut off after tick 5", and whether it is damaged.
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
  std::optional<LogEnd> end_;
  bool has_program_ = false, damaged_ = false, finished_ = false, reprocess_block_ = false;
  std::uint64_t next_sequence_ = 1, last_tick_ = 0;

  // the block of ticks that is being read
  std::string_view records_;
  std::uint32_t records_left_ = 0;
  RecordLayout layout_;
};

}  // namespace catena::haptics::log
