/// The unfinished file that an output is written to before it is renamed to its place, so that the place holds the old content or the new
/// one, whole. It lies beside its place under a name of its own, NAME.part<pid>-<random>; it is made by this program alone (O_EXCL: never
/// what somebody put there, never through a link) and locked (flock) while it is written. What programs that have ended left of the same
/// output is removed when it is written again.
#pragma once
#include <string>

#include "engine/base/result.h"

namespace catena {

class PartFile {
 public:
  /// `owner_only`: nobody else may read it. A place that exists keeps its permissions. Error: "PATH: cannot write: why".
  static Result<PartFile> create(const std::string& path, bool owner_only = false);
  ~PartFile();  ///< removes it, unless it was committed
  PartFile(PartFile&& other) noexcept;
  PartFile& operator=(PartFile&&) = delete;

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
  PartFile(std::string path, std::string name, int descriptor) : path_(std::move(path)), name_(std::move(name)), descriptor_(descriptor) {}

  std::string path_, name_;  ///< name_ empty: nothing to remove
  int descriptor_ = -1;
};

/// The name of an unfinished file or folder for `path`; another one at every call.
std::string part_name(const std::string& path);

/// Removes unfinished files and folders for `path` whose programs have ended.
void remove_stale_parts(const std::string& path);

}  // namespace catena
