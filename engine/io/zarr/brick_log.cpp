// SPDX-License-Identifier: MIT
#include "engine/io/zarr/brick_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <limits>

#include "engine/base/hash.h"
#include "engine/base/system_failure.h"

namespace catena::field {
namespace {

static_assert(sizeof(BrickLog::Record) == 48);

std::uint64_t hash_of(const BrickLog::Record& record) { return hash_bytes(&record, offsetof(BrickLog::Record, hash)); }

Error log_error(const std::string& path, int code) { return {fmt::format("{}: cannot write: {}", path, describe_errno(code)), true}; }

}  // namespace

BrickLog::BrickLog(std::string path, const std::vector<BrickLevel>& levels)
    : path_(std::move(path)), min_(std::numeric_limits<double>::infinity()), max_(-std::numeric_limits<double>::infinity()) {
  for (const BrickLevel& level : levels) {
    const Index3 n = brick_counts(level);
    counts_.push_back(n);
    states_.emplace_back(brick_count(n), BrickState::missing);
    checksums_.emplace_back(states_.back().size());
  }
}

/// Calls the body for each record until it returns false; returns the number of records.
Result<std::uint64_t> BrickLog::for_records(const std::function<bool(const Record&)>& body) const {
  std::array<Record, 1024> records;
  for (std::uint64_t count = 0;;) {
    const ssize_t got = ::pread(file_.get(), records.data(), sizeof records, static_cast<off_t>(count * sizeof(Record)));
    if (got < 0) return log_error(path_, errno);
    const std::size_t whole = static_cast<std::size_t>(got) / sizeof(Record);
    if (whole == 0) return count;
    for (std::size_t i = 0; i < whole; ++i, ++count)
      if (!body(records[i])) return Error{path_ + ": the record of complete bricks is damaged; the unfinished store can be removed"};
  }
}

Result<BrickLog> BrickLog::open(const std::string& path, const std::vector<BrickLevel>& levels) {
  BrickLog log(path, levels);
  log.file_ = FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (!log.file_) return log_error(path, errno);
  CATENA_TRY(const std::uint64_t count, log.for_records([&](const Record& record) {
    const bool is_valid = record.state == static_cast<int>(BrickState::empty) || record.state == static_cast<int>(BrickState::stored);
    if (!is_valid || record.hash != hash_of(record) || !log.has(record.level, record.brick)) return false;
    log.add(record);
    return true;
  }));
  // the end of a record that was not written completely
  if (::ftruncate(log.file_.get(), static_cast<off_t>(count * sizeof(Record))) != 0) return log_error(path, errno);
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

void BrickLog::add(const Record& record) {
  const auto level = static_cast<std::size_t>(record.level);
  const std::size_t number = number_of(record.level, record.brick);
  states_[level][number] = static_cast<BrickState>(record.state);
  checksums_[level][number] = record.checksum;
  if (level > 0 || !(record.min <= record.max)) return;
  if (record.min < min_) min_ = record.min;
  if (record.max > max_) max_ = record.max;
}

Outcome BrickLog::record(int level, const Index3& brick, BrickState state, const BrickRange& range, std::uint32_t checksum) {
  Record record{level, static_cast<std::int32_t>(state), brick, checksum, range.min, range.max};
  record.hash = hash_of(record);
  const std::scoped_lock lock(*mutex_);
  const ssize_t written = ::write(file_.get(), &record, sizeof record);
  if (written != static_cast<ssize_t>(sizeof record)) return log_error(path_, written < 0 ? errno : ENOSPC);
  add(record);
  return Done{};
}

Result<BrickIndex> BrickLog::read_index(double fill_value) const {
  BrickIndex index{0, fill_value, {}};
  for (std::size_t level = 0; level < states_.size(); ++level)
    index.levels.emplace_back(counts_[level], [&](std::uint64_t number) { return states_[level][number] == BrickState::stored; });
  CATENA_CHECK(for_records([&](const Record& record) {
    if (!has(record.level, record.brick)) return false;
    index.levels[static_cast<std::size_t>(record.level)].set(number_of(record.level, record.brick), {true, true, record.min, record.max},
                                                             record.checksum);
    return true;
  }));
  return index;
}

BrickRange BrickLog::range() const { return {true, true, min_, max_}; }

}  // namespace catena::field
