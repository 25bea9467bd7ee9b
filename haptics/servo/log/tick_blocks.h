/// Ticks in their order -> blocks of a log: batches, programs where they take over, gaps where ticks are missing. The writer's thread.
#pragma once
#include <functional>

#include "haptics/chain/state_hash.h"
#include "haptics/servo/log/block_file.h"
#include "haptics/servo/log/contents.h"
#include "haptics/servo/log/record.h"

namespace catena::haptics::log {

class TickBlocks {
 public:
  /// What is known of the program of this epoch; before the first tick also of the one that it took over from.
  using Programs = std::function<std::vector<LogProgram>(std::uint64_t epoch)>;
  TickBlocks(BlockFile file, Programs programs_of);

  struct Tick {
    std::uint64_t number = 0, epoch = 0;
    Shape shape;
  };
  /// `words`: pack() of this tick. Numbers rise; a jump is a gap.
  void add(const Tick& tick, std::span<const std::uint64_t> words);
  void flush();                         ///< what is there becomes a block
  void end(std::uint64_t newest_tick);  ///< the last tick that there was, in the log or lost; closes the file

  BlockFile& file() { return file_; }
  std::uint64_t ticks() const { return ticks_; }             ///< in complete blocks
  std::uint64_t last_tick() const { return last_written_; }  ///< of these

 private:
  void add_gap(std::uint64_t next);
  void begin(const Tick& tick);

  BlockFile file_;
  Programs programs_of_;
  Tick first_;  ///< of the block that is being filled
  std::uint32_t count_ = 0;
  std::string records_;
  Words before_{};
  bool has_program_ = false;
  std::uint64_t epoch_ = 0, last_ = 0;
  std::uint64_t ticks_ = 0, lost_ = 0, last_written_ = 0;
  LogTick unpacked_;
  StateHash hash_;
};

}  // namespace catena::haptics::log
