/// A folder that one program at a time writes to.
#pragma once
#include <string>

#include "engine/base/result.h"

namespace catena {

/// A lock on a folder, by flock(2) on the folder itself: it goes with its process, however that ends, and leaves nothing. Where a file
/// system knows no such locks (some of networks) everybody has it.
class FolderLock {
 public:
  /// An error where another process has it, or this one already: "FOLDER: another session writes to it; ...".
  static Result<FolderLock> acquire(const std::string& folder);
  ~FolderLock();
  /// Takes the lock over; `other` holds none then.
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace catena
