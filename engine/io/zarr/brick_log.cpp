// SPDX-License-Identifier: MIT
#include "engine/io/zarr/brick_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <limits>

#include "engine/base/system_failure.h"

namespace catena::field {
namespace {

/// A record, plain bytes.
struct BrickRecord {
  std::int32_t level = 0, state = 0;
  Index3 brick;
  std::int32_t padding = 0;
  double min = 0, max = 0;
};
static_assert(sizeof(BrickRecord) == 40);

Error log_error(const std::string& path, int code) { return {fmt::format("{}: cannot write: {}", path, describe_errno(code)), true}; }

}  // namespace

BrickLog::BrickLog(std::string path, const std::vector<BrickLevel>& levels)
    : path_(std::move(path)), min_(std::numeric_limits<double>::infinity()), max_(-std::numeric_limits<double>::infinity()) {
  for (const BrickLevel& level : levels) {
    const Index3 n = brick_counts(level);
    counts_.push_back(n);
    states_.emplace_back(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z),
                         BrickState::missing);
  }
}

Result<BrickLog> BrickLog::open(const std::string& path, const std::vector<BrickLevel>& levels) {
  BrickLog log(path, levels);
  log.file_ = FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (!log.file_) return log_error(path, errno);
  std::array<BrickRecord, 1024> records;
  std::uint64_t count = 0;
  for (;;) {
    const ssize_t got = ::pread(log.file_.get(), records.data(), sizeof records, static_cast<off_t>(count * sizeof(BrickRecord)));
    if (got < 0) return log_error(path, errno);
    const std::size_t whole = static_cast<std::size_t>(got) / sizeof(BrickRecord);
    if (whole == 0) break;
    for (std::size_t i = 0; i < whole; ++i) {
      const BrickRecord& record = records[i];
      const bool is_valid = record.state == static_cast<int>(BrickState::empty) || record.state == static_cast<int>(BrickState::stored);
      if (!is_valid || !log.has(record.level, record.brick))
        return Error{path + ": the record of the import is damaged; the unfinished store can be removed"};
      log.add(record.level, record.brick, static_cast<BrickState>(record.state), record.min, record.max);
    }
    count += whole;
  }
  // the end of a record that was not written completely
  if (::ftruncate(log.file_.get(), static_cast<off_t>(count * sizeof(BrickRecord))) != 0) return log_error(path, errno);
  log.is_continued_ = count > 0;
  return log;
}

std::size_t BrickLog::number_of(int level, const Index3& brick) const {
  return static_cast<std::size_t>(brick_number(counts_[static_cast<std::size_t>(level)], brick));
}

bool BrickLog::has(int level, const Index3& brick) const {
  if (level < 0 || static_cast<std::size_t>(level) >= counts_.size()) return false;
  const Index3& n = counts_[static_cast<std::size_t>(level)];
  return brick.x >= 0 && brick.y >= 0 && brick.z >= 0 && brick.x < n.x && brick.y < n.y && brick.z < n.z;
}

void BrickLog::add(int level, const Index3& brick, BrickState state, double min, double max) {
  states_[static_cast<std::size_t>(level)][number_of(level, brick)] = state;
  if (level > 0 || !(min <= max)) return;
  if (min < min_) min_ = min;
  if (max > max_) max_ = max;
}

Outcome BrickLog::record(int level, const Index3& brick, BrickState state, const BrickRange& range) {
  const BrickRecord record{level, static_cast<std::int32_t>(state), brick, 0, range.min, range.max};
  const std::scoped_lock lock(*mutex_);
  const ssize_t written = ::write(file_.get(), &record, sizeof record);
  if (written != static_cast<ssize_t>(sizeof record)) return log_error(path_, written < 0 ? errno : ENOSPC);
  add(level, brick, state, range.min, range.max);
  return Done{};
}

BrickRange BrickLog::range() const { return {true, true, min_, max_}; }

}  // namespace catena::field
