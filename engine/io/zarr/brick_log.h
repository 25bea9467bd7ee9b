// SPDX-License-Identifier: MIT
/// Record of the bricks of a store that are complete: an append-only file, which a killed program leaves valid. Private to this folder.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/base/helper_process.h"
#include "engine/field/bricks/brick_index.h"
#include "engine/field/bricks/brick_source.h"

namespace catena::field {

/// State of a brick in the store. empty: complete, all voxels have the fill value, and nothing is stored.
enum class BrickState : std::uint8_t { missing, empty, stored };

/// The log of one store. Any thread; a brick is recorded by the thread that completes it, and read by others after that thread was joined.
class BrickLog {
 public:
  /// A record of the file, plain bytes.
  struct Record {
    std::int32_t level = 0, state = 0;
    Index3 brick;
    std::uint32_t checksum = 0;  ///< Of the values.
    double min = 0, max = 0;
    std::uint64_t hash = 0;  ///< Of the record before this number.
  };

  /// Opens the file, or creates it, and reads its records. The Error is a complete message.
  static Result<BrickLog> open(const std::string& path, const std::vector<BrickLevel>& levels);
  BrickLog(BrickLog&&) = default;

  /// Returns the state of a brick.
  BrickState state(int level, const Index3& brick) const { return states_[static_cast<std::size_t>(level)][number_of(level, brick)]; }
  /// Returns the brick_checksum() of a complete brick.
  std::uint32_t checksum(int level, const Index3& brick) const {
    return checksums_[static_cast<std::size_t>(level)][number_of(level, brick)];
  }
  /// Records a brick as complete; the range is that of its finite values.
  Outcome record(int level, const Index3& brick, BrickState state, const BrickRange& range, std::uint32_t checksum);
  /// Reads the index of the stored bricks of all levels; the others have the fill value.
  Result<BrickIndex> read_index(double fill_value) const;
  /// Returns the range of the finite values of level 0, of the bricks that are complete.
  BrickRange range() const;
  /// Returns whether bricks had been completed before the log was opened.
  bool is_continued() const { return is_continued_; }

 private:
  BrickLog(std::string path, const std::vector<BrickLevel>& levels);
  std::size_t number_of(int level, const Index3& brick) const;
  bool has(int level, const Index3& brick) const;
  void add(const Record& record);
  Result<std::uint64_t> for_records(const std::function<bool(const Record&)>& body) const;

  std::string path_;
  FileDescriptor file_;
  std::vector<Index3> counts_;                   ///< Bricks of each level.
  std::vector<std::vector<BrickState>> states_;  ///< By level, x fastest.
  std::vector<std::vector<std::uint32_t>> checksums_;
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
  double min_, max_;
  bool is_continued_ = false;
};

}  // namespace catena::field
