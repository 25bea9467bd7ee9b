/// The writing end of a log: whole blocks, each with one write(2), straight into the file under its own name, so that what is
/// written survives the death of the process at any moment. `sync` (fdatasync) makes it survive the machine's, too.
/// The first failure is kept; after it nothing is written. One thread.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "haptics/servo/log/format.h"

namespace catena::haptics::log {

class BlockFile {
 public:
  /// Replaces what is there, unless another process is writing it. Writes the preamble.
  static Result<BlockFile> create(const std::string& path);
  BlockFile(BlockFile&& other) noexcept;
  BlockFile& operator=(BlockFile&&) = delete;
  ~BlockFile();

  bool write(BlockType type, std::string_view payload);
  bool sync();
  bool close();
  void discard();  ///< closes and removes it: not even its header could be written
  bool failed() const { return error_ != 0; }
  std::string error() const;  ///< "FILE: cannot write: No space left on device"
  std::uint64_t bytes() const { return bytes_; }

 private:
  BlockFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  bool write_all(const void* data, std::size_t size);

  std::string path_, buffer_;
  int descriptor_ = -1, error_ = 0;
  std::uint64_t sequence_ = 0, bytes_ = 0;
};

}  // namespace catena::haptics::log
