// SPDX-License-Identifier: MIT
/// Force table that `catena-device` writes while it runs: t,force_x,force_y,force_z, seconds of CLOCK_MONOTONIC and newtons, device axes. A
/// row where the force has changed, and 100 rows per second where it is constant. Disk space is reserved ahead of the rows, so that a full
/// disk is detected while there is still space for the rows that end a push: from then on only the first and last rows of pushes are
/// written, and `error` has the cause.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "engine/base/helper_process.h"
#include "engine/base/vec.h"

namespace catena::haptics::process {

/// Opens the table and reserves its first block, before the device is opened; an empty path is /dev/null. Errors: a pipe, a device or a
/// folder (bad input); a full disk, ulimit -f (machine error). The content of an existing file is kept if it cannot be replaced.
Result<FileDescriptor> open_force_table(const std::string& path);

/// Writer of an open table. One thread.
class ForceTable {
 public:
  /// Writes the header. `error`: errno code of the first row that was lost, or of the first reservation that failed.
  ForceTable(int descriptor, std::atomic<int>& error);
  ForceTable(const ForceTable&) = delete;
  ~ForceTable();  ///< frees the reserved space that was not used

  /// Adds the force of a period, device axes.
  void add(const Vec3& force_n);

 private:
  bool reserve_space();
  void append_row(const char* text);

  int descriptor_;
  std::atomic<int>& error_;
  std::int64_t size_ = 0, reserved_ = 0;  ///< bytes; reserved_ 0: not a regular file
  Vec3 last_n_{0.0};
  std::int64_t last_ns_ = 0;
};

}  // namespace catena::haptics::process
