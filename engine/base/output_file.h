/// Outputs: the check before anything is written, the unfinished file (TemporaryFile), and the output that is whole or not there
/// (OutputFile).
///
/// The rule that no output of a run is one of its inputs, and no two outputs are one file: said before anything is opened for writing.
/// Two names are one file where they lead to one thing on the disk (device and inode: links of both kinds, ./x, x/../x), or, where nothing
/// is there yet, to one place once links on the way are followed. Letters keep their case. Devices and pipes are nobody's own.
#pragma once
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"

namespace catena {

/// A file that a run will write; an empty path: it will not.
struct PlannedOutput {
  std::string option;  ///< that names it: "--stats"
  std::string path;
};

/// One line: a missing folder, a folder as the file, an output that is one of the inputs, or two outputs that are one file.
Outcome check_outputs(const std::vector<PlannedOutput>& outputs, const std::vector<std::string>& inputs);
/// The same for one output.
Outcome check_output(const std::string& path, const std::vector<std::string>& inputs);

/// Two names of one place, whether or not it exists yet. Devices and pipes are nobody's own.
bool is_same_file(const std::string& a, const std::string& b);

/// Whether a place, there or not, lies anywhere below a folder.
bool is_path_within(const std::string& place, const std::string& folder);

/// The unfinished file that an output is written to before it is renamed to its place, so that the place holds the old content or the new
/// one, whole. It lies beside its place under a name of its own, NAME.part<pid>-<random>; it is made by this program alone (O_EXCL: never
/// what somebody put there, never through a link) and locked (flock) while it is written. What programs that have ended left of the same
/// output is removed when it is written again.
class TemporaryFile {
 public:
  /// `owner_only`: nobody else may read it. A place that exists keeps its permissions. Error: "PATH: cannot write: why".
  static Result<TemporaryFile> create(const std::string& path, bool owner_only = false);
  ~TemporaryFile();  ///< removes it, unless it was committed
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  const std::string& path() const { return path_; }
  const std::string& name() const { return name_; }
  int descriptor() const { return descriptor_; }
  /// Renames it to its place. An error leaves what was there.
  Outcome commit();
  /// As commit(), but for a place where nothing may be: false where something is.
  Result<bool> commit_new();
  /// The file's descriptor, and with it the lock, are the caller's from now on. After a commit.
  int release();

 private:
  TemporaryFile(std::string path, std::string name, int descriptor)
      : path_(std::move(path)), name_(std::move(name)), descriptor_(descriptor) {}

  std::string path_, name_;  ///< name_ empty: nothing to remove
  int descriptor_ = -1;
};

/// Whether an output of that name is written directly: the place is a pipe, a socket or a device.
bool is_written_directly(const std::string& path);

/// The name of an unfinished file or folder for `path`; another one at every call.
std::string temporary_name(const std::string& path);

/// Removes unfinished files and folders for `path` whose programs have ended. Who makes such a folder locks it (folder_lock.h).
void remove_stale_temporaries(const std::string& path);

/// An output that is either complete or not there: written to an unfinished file beside its place, renamed by commit().
/// Places that are no regular files (/dev/stdout, /dev/full, pipes) are written directly. Errors name the path and why.
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
  OutputFile(std::string path, std::optional<TemporaryFile> part, std::FILE* file);

  std::string path_;
  std::optional<TemporaryFile> temporary_;  ///< none: written directly
  std::FILE* file_ = nullptr;
  int error_ = 0;
};

/// Finishes all, and only then renames all.
Outcome commit_all(const std::vector<OutputFile*>& files);

}  // namespace catena
