// SPDX-License-Identifier: MIT
#include "haptics/device/process/force_table.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/base/clock.h"
#include "engine/base/system_failure.h"

namespace catena::haptics::process {

namespace {

constexpr std::int64_t kPiece = 1 << 20;  // bytes; about 20 s of a force that changes every millisecond
constexpr std::int64_t kAhead = kPiece / 2;
constexpr std::int64_t kLongestRow = 128;

/// Reserves the first `bytes` of the file without changing its size. Returns 0 or an errno code.
int reserve(int descriptor, std::int64_t bytes) {
  const auto limit = resource_limit(RLIMIT_FSIZE);
  if (limit && *limit < static_cast<unsigned long long>(bytes)) return EFBIG;
  while (::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, bytes) != 0) {
    if (errno == EINTR) continue;
    return errno == EOPNOTSUPP || errno == ENOSYS ? 0 : errno;  // a file system without reservation: rows are written without it
  }
  return 0;
}

}  // namespace

Result<FileDescriptor> open_force_table(const std::string& path) {
  if (path.empty()) return FileDescriptor(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  const auto cannot = [&](int code) { return system_error(path + ": cannot write", code); };
  // opened without blocking, because a pipe may have no reader
  struct stat about {};
  const bool was_there = ::stat(path.c_str(), &about) == 0;
  if (was_there && !S_ISREG(about.st_mode))
    return Error{path + ": this is a pipe, a device or a folder, expected the name of a regular file for the table of forces"};
  FileDescriptor table(::open(path.c_str(), O_WRONLY | O_CREAT | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0666));
  if (!table) return cannot(errno);
  if (::fstat(table.get(), &about) != 0 || !S_ISREG(about.st_mode))
    return Error{path + ": this is not a regular file, expected the name of a regular file for the table of forces"};
  int code = reserve(table.get(), kPiece);
  if (code == 0 && (::ftruncate(table.get(), 0) != 0)) code = errno;
  if (code == 0) code = reserve(table.get(), kPiece);
  if (code == 0) return table;
  if (!was_there) ::unlink(path.c_str());
  return cannot(code);
}

ForceTable::ForceTable(int descriptor, std::atomic<int>& error) : descriptor_(descriptor), error_(error) {
  struct stat about {};
  if (::fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode)) reserved_ = kPiece;
  append_row("t,force_x,force_y,force_z\n");
}

ForceTable::~ForceTable() {
  if (reserved_ > size_) static_cast<void>(::ftruncate(descriptor_, size_) == 0);
}

void ForceTable::add(const Vec3& force_n) {
  constexpr std::int64_t kStays = 10'000'000;
  const std::int64_t now = now_ns();
  if (force_n == last_n_ && now - last_ns_ < kStays) return;
  const bool begins_or_ends = (force_n == Vec3(0.0)) != (last_n_ == Vec3(0.0));
  if (!reserve_space() && !begins_or_ends) return;
  last_n_ = force_n;
  last_ns_ = now;
  char row[kLongestRow];
  std::snprintf(row, sizeof row, "%.6f,%.6g,%.6g,%.6g\n", 1e-9 * static_cast<double>(now), 0.0 + force_n.x, 0.0 + force_n.y,
                0.0 + force_n.z);  // no "-0"
  append_row(row);
}

/// Returns whether there is space for a row that does not begin or end a period of force (those rows are always written).
bool ForceTable::reserve_space() {
  if (reserved_ == 0) return true;
  if (error_ != 0) return false;
  if (reserved_ - size_ > kAhead) return true;
  const int code = reserve(descriptor_, reserved_ + kPiece);
  if (code == 0) reserved_ += kPiece;
  if (code != 0) error_ = code;
  return code == 0;
}

void ForceTable::append_row(const char* text) {
  const auto bytes = static_cast<ssize_t>(std::strlen(text));
  const ssize_t written = ::write(descriptor_, text, static_cast<std::size_t>(bytes));
  if (written > 0) size_ += written;
  int none = 0;
  if (written != bytes) error_.compare_exchange_strong(none, written < 0 ? errno : ENOSPC);
}

}  // namespace catena::haptics::process
