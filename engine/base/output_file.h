/// An output that is either complete or not there: written to a temporary file beside its place, renamed by commit().
/// Places that are no regular files (/dev/stdout, /dev/full, pipes) are written directly. Errors name the path and why.
#pragma once
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena {

/// Refuses, before any work is done: a missing folder, a folder as the file, a place that cannot be written, an output that is
/// one of the inputs.
Outcome check_output(const std::string& path, const std::vector<std::string>& inputs);

/// Two names of one place, whether or not it exists yet. Devices and pipes are nobody's own.
bool same_file(const std::string& a, const std::string& b);

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
  /// finish(), then the rename to the final name.
  Outcome commit();
  std::FILE* stream() { return file_; }

 private:
  OutputFile(std::string path, std::string temporary, std::FILE* file);

  std::string path_, temporary_;  ///< temporary_ empty: written directly
  std::FILE* file_ = nullptr;
  int error_ = 0;
};

/// Finishes all, and only then renames all.
Outcome commit_all(const std::vector<OutputFile*>& files);

}  // namespace catena
