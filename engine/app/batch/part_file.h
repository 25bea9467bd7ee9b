// SPDX-License-Identifier: MIT
/// Parts of an output that several shards compute: one file per shard, beside the output (part_path()). A part ends with a line that states
/// its shard, the run it belongs to, its size and its hash, so that a truncated, changed or foreign part is recognized:
///   # {"part": "2/4", "command": "trace", "run": "0123456789abcdef", "bytes": 5120, "hash": "fedcba9876543210"}
/// A part is written atomically; a repeated shard replaces its own part.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/app/batch/shard.h"
#include "engine/base/hash.h"
#include "engine/base/output_file.h"

namespace catena::app {

/// Writes one part. One thread.
class PartWriter {
 public:
  /// Opens the part of `shard` for the output `path`. `command`: "trace"; `run`: key of the run (run_key.h).
  static Result<PartWriter> open(const std::string& path, const Shard& shard, std::string command, std::string run);
  void write(std::string_view text);  ///< Errors are reported when the file is committed
  /// Writes the last line, after which the file is committed.
  void end();
  /// The file, to be committed after end().
  OutputFile& file() { return file_; }

 private:
  PartWriter(OutputFile file, const Shard& shard, std::string command, std::string run)
      : file_(std::move(file)), shard_(shard), command_(std::move(command)), run_(std::move(run)) {}

  OutputFile file_;
  Shard shard_;
  std::string command_, run_;
  std::uint64_t bytes_ = 0;
  Fnv1a hash_;
};

/// A complete part. Plain data.
struct Part {
  std::string path;         ///< File name
  Shard shard;              ///< The shard that wrote it
  std::uint64_t bytes = 0;  ///< Size without the last line
};

/// Finds the parts of the output `path` and checks that there is one for each shard, all written by `command` in one run, none truncated or
/// changed. Ordered by shard. Error: the first deviation, and which shards are to be run.
Result<std::vector<Part>> find_parts(const std::string& path, const std::string& command);

/// Reads the lines of a part in order, without its last one. The file is open only while a block is read, so that any number of parts can
/// be read at the same time. One thread.
class PartLines {
 public:
  /// `block_bytes`: size of the buffer.
  PartLines(Part part, std::size_t block_bytes) : part_(std::move(part)), block_bytes_(block_bytes) {}
  /// Gets the next line without its end, valid until the next call; false after the last one. Error: the file cannot be read.
  Result<bool> next(std::string_view& line);
  const Part& part() const { return part_; }

 private:
  Outcome fill();

  Part part_;
  std::size_t block_bytes_;
  std::string buffer_;
  std::size_t at_ = 0;      ///< Position in the buffer
  std::uint64_t read_ = 0;  ///< Bytes of the file that were read
};

}  // namespace catena::app
