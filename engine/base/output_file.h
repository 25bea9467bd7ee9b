/// An output that is either complete or not there: written to an unfinished file beside its place (part_file.h), renamed by commit().
/// Places that are no regular files (/dev/stdout, /dev/full, pipes) are written directly. Errors name the path and why.
#pragma once
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/output_check.h"
#include "engine/base/part_file.h"
#include "engine/base/result.h"

namespace catena {

class OutputFile {
 public:
  static Result<OutputFile> open(const std::string& path);
  ~OutputFile();  ///< without a commit nothing stays behind
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  void write(std::string_view text);  ///< failures are kept for finish()
  bool failed() const { return error_ != 0; }
  void seek(std::uint64_t position);  ///< regular files; failures are kept for finish()
  /// Everything is on its way to the disk, or one line why not.
  Outcome finish();
  /// Before finish(): waits until all of it is on the disk, so that it survives the machine, too. Failures are kept for finish().
  void sync();
  /// finish(), then the rename to the final name.
  Outcome commit();
  std::FILE* stream() { return file_; }

 private:
  OutputFile(std::string path, std::optional<PartFile> part, std::FILE* file);

  std::string path_;
  std::optional<PartFile> part_;  ///< none: written directly
  std::FILE* file_ = nullptr;
  int error_ = 0;
};

/// Finishes all, and only then renames all.
Outcome commit_all(const std::vector<OutputFile*>& files);

}  // namespace catena
