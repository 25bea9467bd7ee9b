/// The blocks of a log one after the other, damaged ones passed over (format.h). Every byte is looked at a bounded number of times, and
/// no more memory is taken than a block has bytes in the file. Off the tick.
#pragma once
#include <memory>
#include <string>

#include "haptics/servo/log/format.h"
#include "haptics/servo/log/source.h"

namespace catena::haptics::log {

class BlockReader {
 public:
  explicit BlockReader(std::unique_ptr<Source> source) : source_(std::move(source)) {}

  enum class Found {
    block,
    damaged,  ///< one or more blocks are passed over
    end,      ///< the file ends with the last block
    cut_off   ///< what follows is no complete block
  };
  Found next();

  // of the last block found
  BlockType type() const { return static_cast<BlockType>(head_.type); }
  std::uint64_t sequence() const { return head_.sequence; }
  std::string_view payload() const { return payload_; }

  Source& source() { return *source_; }

 private:
  bool read_head(std::uint64_t at, BlockHead& head);
  bool find_next_head();

  std::unique_ptr<Source> source_;
  std::uint64_t at_ = kPreambleBytes;
  BlockHead head_;
  std::string payload_;
};

}  // namespace catena::haptics::log
