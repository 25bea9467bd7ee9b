// SPDX-License-Identifier: MIT
/// Input and output of a log as blocks (format.h): byte sources, the writer of blocks and the reader of blocks. Off the tick.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

/// Source of bytes with random access. One thread.
class CATENA_EXPORT ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Returns the number of bytes, as it was when the source was opened.
  virtual std::uint64_t size() const = 0;
  /// Reads `bytes` bytes at `offset` into `to`. Returns false if they cannot all be read.
  virtual bool read(std::uint64_t offset, void* to, std::size_t bytes) = 0;
};

/// Opens a regular file. The Error names it.
CATENA_EXPORT Result<std::unique_ptr<ByteSource>> open_file_source(const std::string& path);
/// Returns a source of bytes in memory, which must outlive it.
CATENA_EXPORT std::unique_ptr<ByteSource> make_memory_source(std::string_view bytes);

/// Writer of the blocks of a log: each whole block is written with one write(2) directly to the file under its final name, so that it
/// survives the end of the process at any moment. `sync` (fdatasync) makes it survive a failure of the machine, too.
/// The first error is kept; after it nothing is written. Owns the file descriptor. One thread.
class CATENA_EXPORT BlockFile {
 public:
  /// Creates the file, or replaces an existing one, and writes the preamble. An Error if the file is an input of this program, cannot be
  /// written, or is being recorded into by another process.
  static Result<BlockFile> create(const std::string& path);
  /// Takes over the file of `other`, which is left without one.
  BlockFile(BlockFile&& other) noexcept;
  BlockFile& operator=(BlockFile&&) = delete;
  ~BlockFile();

  /// Appends a block; returns false on failure, see error().
  bool write(BlockType type, std::string_view payload);
  /// Flushes the file to the disk; returns false on failure, see error().
  bool sync();
  /// Closes the file; returns false on failure, see error().
  bool close();
  /// Closes and removes the file, if not even its header could be written.
  void discard();
  /// Returns whether an operation has failed.
  bool failed() const { return error_ != 0; }
  /// Returns the first error, such as "FILE: cannot write: No space left on device"; empty if there was none.
  Error error() const;
  /// Returns the number of bytes written so far.
  std::uint64_t bytes() const { return bytes_; }

 private:
  BlockFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  bool write_all(const void* data, std::size_t size);

  std::string path_, buffer_;
  int descriptor_ = -1, error_ = 0;
  std::uint64_t sequence_ = 0, bytes_ = 0;
};

/// Reader of the blocks of a log in order, which skips damaged ones (format.h). Every byte is read a bounded number of times, and no more
/// memory is used than the block has bytes in the file. Off the tick.
class CATENA_EXPORT BlockReader {
 public:
  /// Creates a reader of a log whose preamble has been checked; it starts at the first block.
  explicit BlockReader(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}

  /// Result of next().
  enum class ReadResult {
    block,     ///< a good block
    damaged,   ///< one or more damaged blocks were skipped
    end,       ///< the file ends with the last block
    truncated  ///< the rest of the file is no complete block
  };
  /// Advances to the next block.
  ReadResult next();

  // properties of the last block found
  /// Returns the type of the block.
  BlockType type() const { return static_cast<BlockType>(header_.type); }
  /// Returns the sequence number of the block, from 0.
  std::uint64_t sequence() const { return header_.sequence; }
  /// Returns the payload of the block, valid until the next call of next().
  std::string_view payload() const { return payload_; }

  /// Returns the source of the bytes.
  ByteSource& source() { return *source_; }

 private:
  bool read_header(std::uint64_t at, BlockHeader& head);
  bool find_next_header();

  std::unique_ptr<ByteSource> source_;
  std::uint64_t at_ = kPreambleBytes;
  BlockHeader header_;
  std::string payload_;
};

}  // namespace catena::haptics::log
