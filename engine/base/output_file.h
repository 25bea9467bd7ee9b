// SPDX-License-Identifier: MIT
/// Output files: checks before anything is written, temporary files (TemporaryFile), and atomic output (OutputFile).
///
/// The checks make sure, before any file is opened for writing, that no output of a run is also an input and that no two outputs are the
/// same file. Two names are the same file when they lead to the same object on the disk (device and inode: symbolic and hard links, ./x,
/// x/../x) or, when nothing exists there, to the same path after links are resolved. Upper and lower case differ. Devices and pipes are
/// never considered the same.
#pragma once
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena {

/// File that a run will write.
struct PlannedOutput {
  std::string option;  ///< command-line option that names the file: "--stats"
  /// Empty: the file is not written.
  std::string path;
};

/// Checks the outputs of a run. Error (one line): the folder does not exist, the path is a folder, an output is one of the inputs, or two
/// outputs are the same file.
Outcome check_outputs(const std::vector<PlannedOutput>& outputs, const std::vector<std::string>& inputs);
/// Checks one output as check_outputs() does; an empty path is an Error.
Outcome check_output(const std::string& path, const std::vector<std::string>& inputs);

/// Returns true when two names lead to the same file, existing or not. False for devices and pipes.
bool is_same_file(const std::string& a, const std::string& b);

/// Returns true when a path, existing or not, is anywhere below a folder.
bool is_path_within(const std::string& path, const std::string& folder);

/// Temporary file to which an output is written before it is renamed to its final path, so that the final path always has the complete old
/// or the complete new content. It is in the same folder and is called NAME.part<pid>-<random>. It is created exclusively (O_EXCL: never an
/// existing file, never through a link) and locked (flock) while it is written. Creating one removes stale temporary files that ended
/// programs have left of the same output.
class TemporaryFile {
 public:
  /// Creates the temporary file for the output `path`. `owner_only`: only the owner may read it; otherwise an existing output keeps its
  /// permissions. Error: "PATH: cannot write: why", or the output is an input of this process.
  static Result<TemporaryFile> create(const std::string& path, bool owner_only = false);
  /// Removes the file unless it was committed.
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  const std::string& path() const { return path_; }
  const std::string& name() const { return name_; }
  /// Returns the descriptor; -1 after release().
  int descriptor() const { return descriptor_; }
  /// Renames the file to its final path, and replaces an existing file. On an Error the old content stays.
  Outcome commit();
  /// Like commit(), but never replaces a file: returns false when something exists at the final path.
  Result<bool> commit_new();
  /// Transfers the descriptor, and with it the lock, to the caller. To be called after a commit.
  int release();

 private:
  TemporaryFile(std::string path, std::string name, int descriptor)
      : path_(std::move(path)), name_(std::move(name)), descriptor_(descriptor) {}

  std::string path_, name_;  ///< name_ empty: there is nothing to remove
  int descriptor_ = -1;
};

/// Returns true when an output of that name is written directly: the path is a pipe, a socket or a device.
bool is_written_directly(const std::string& path);

/// Returns a name for a temporary file or folder of the output `path`; a different one at every call.
std::string temporary_name(const std::string& path);

/// Removes temporary files and folders of `path` whose programs have ended. A program that creates such a folder must lock it
/// (folder_lock.h).
void remove_stale_temporaries(const std::string& path);

/// Atomic output file: written to a temporary file in the same folder and renamed by commit(). Paths that are no regular files
/// (/dev/stdout, /dev/full, pipes) are written directly. Errors name the path and the cause. Not thread-safe.
class OutputFile {
 public:
  /// Opens the output `path`; a symbolic link is followed to the file that it names. Error: as for TemporaryFile::create(), or nothing
  /// reads from the pipe or socket.
  static Result<OutputFile> open(const std::string& path);
  /// Without a commit the temporary file is removed.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  void write(std::string_view text);  ///< errors are reported by finish()
  /// Returns true when an operation has failed.
  bool failed() const { return error_ != 0; }
  /// Sets the position of the next write, bytes from the start. Regular files only; errors are reported by finish().
  void seek(std::uint64_t position);
  /// Flushes and closes the file. Error: the first failed operation.
  Outcome finish();
  /// Waits until the data is on the disk, so that it survives a crash of the system. To be called before finish(), which reports errors.
  void sync();
  /// Calls finish(), then renames the file to its final path.
  Outcome commit();
  /// Returns the stream for direct writing; null after finish().
  std::FILE* stream() { return file_; }

 private:
  OutputFile(std::string path, std::optional<TemporaryFile> part, std::FILE* file);

  std::string path_;
  std::optional<TemporaryFile> temporary_;  ///< empty: written directly
  std::FILE* file_ = nullptr;
  int error_ = 0;
};

/// Calls finish() on all files, and renames them only when all of them succeeded.
Outcome commit_all(const std::vector<OutputFile*>& files);

}  // namespace catena
