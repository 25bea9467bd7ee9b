/// Where a log's bytes come from: a file, or memory. Off the tick.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

/// Bytes with random access. One thread.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  virtual std::uint64_t size() const = 0;  ///< as it was when it was opened
  /// False where the bytes cannot be read.
  virtual bool read(std::uint64_t offset, void* to, std::size_t bytes) = 0;
};

/// A regular file. An error names it.
Result<std::unique_ptr<ByteSource>> open_file_source(const std::string& path);
std::unique_ptr<ByteSource> make_memory_source(std::string_view bytes);  ///< which outlive it

/// The writing end of a log: whole blocks, each with one write(2), straight into the file under its own name, so that what is
/// written survives the death of the process at any moment. `sync` (fdatasync) makes it survive the machine's, too.
/// The first failure is kept; after it nothing is written. One thread.
class BlockFile {
 public:
  /// Replaces what is there, unless another process is writing it. Writes the preamble.
  static Result<BlockFile> create(const std::string& path);
  /// Takes the file over; `other` is closed then.
  BlockFile(BlockFile&& other) noexcept;
  BlockFile& operator=(BlockFile&&) = delete;
  ~BlockFile();

  /// Appends a block; false: it could not, see error().
  bool write(BlockType type, std::string_view payload);
  /// Brings what was written to the disk; false: see error().
  bool sync();
  /// Closes the file; false: see error().
  bool close();
  void discard();  ///< closes and removes it: not even its header could be written
  /// Whether something could not be written.
  bool failed() const { return error_ != 0; }
  Error error() const;  ///< "FILE: cannot write: No space left on device"
  /// ImageWriteResult so far.
  std::uint64_t bytes() const { return bytes_; }

 private:
  BlockFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  bool write_all(const void* data, std::size_t size);

  std::string path_, buffer_;
  int descriptor_ = -1, error_ = 0;
  std::uint64_t sequence_ = 0, bytes_ = 0;
};

/// The blocks of a log one after the other, damaged ones passed over (format.h). Every byte is looked at a bounded number of times, and
/// no more memory is taken than a block has bytes in the file. Off the tick.
class BlockReader {
 public:
  /// Of a log's bytes, from the first on.
  explicit BlockReader(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}

  /// What next() came to.
  enum class ReadResult {
    block,
    damaged,   ///< one or more blocks are passed over
    end,       ///< the file ends with the last block
    truncated  ///< what follows is no complete block
  };
  /// Goes to the next good block.
  ReadResult next();

  // of the last block found
  /// What it holds.
  BlockType type() const { return static_cast<BlockType>(header_.type); }
  /// Its number, from 0.
  std::uint64_t sequence() const { return header_.sequence; }
  /// Its bytes, until the next call.
  std::string_view payload() const { return payload_; }

  /// Where the bytes come from.
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
