// SPDX-License-Identifier: MIT
/// Exclusive lock on a folder: only one process at a time writes to it.
#pragma once
#include <string>

#include "engine/base/export.h"
#include "engine/base/result.h"

namespace catena {

/// Exclusive lock on a folder, implemented by flock(2) on the folder itself. The lock ends with its process, however that ends, and leaves
/// no file behind. On file systems without such locks (some network file systems) acquiring always succeeds.
class CATENA_EXPORT FolderLock {
 public:
  /// Acquires the lock without waiting. Error: another process or this one already has it ("FOLDER: another session writes to it; ..."), or
  /// the folder cannot be opened.
  static Result<FolderLock> acquire(const std::string& folder);
  ~FolderLock();
  /// Transfers the lock; `other` has none afterwards.
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace catena
