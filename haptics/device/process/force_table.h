/// The table that `catena-device` writes while it runs: t,force_x,force_y,force_z, seconds of CLOCK_MONOTONIC and newtons, device axes. A
/// row where the force has changed, and 100 rows a second where it stays. Space on the disk is reserved ahead of the rows, so that a disk
/// that fills up is noticed while the rows that end a push still have their place: from then on only the beginnings and ends of pushes are
/// written, and `error` says why.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "engine/base/helper_process.h"
#include "engine/base/vec.h"

namespace catena::haptics::process {

/// Opens the table and reserves its first piece, before the device is opened; an empty path is /dev/null. Errors: a pipe, a device or a
/// folder (bad input); a disk that is full, ulimit -f (of the machine). What was in a file stays there when it cannot be replaced.
Result<FileDescriptor> open_force_table(const std::string& path);

class ForceTable {
 public:
  /// Writes the header. `error`: the code of errno of the first row that was lost, or of the first reservation that failed.
  ForceTable(int descriptor, std::atomic<int>& error);
  ForceTable(const ForceTable&) = delete;
  ~ForceTable();  ///< gives back what was reserved and not used

  void add(const Vec3& force_n);

 private:
  bool reserve_space();
  void append_row(const char* text);

  int descriptor_;
  std::atomic<int>& error_;
  std::int64_t size_ = 0, reserved_ = 0;  ///< bytes; reserved_bytes_ 0: no regular file
  Vec3 last_n_{0.0};
  std::int64_t last_ns_ = 0;
};

}  // namespace catena::haptics::process
