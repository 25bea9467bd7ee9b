// SPDX-License-Identifier: MIT
/// Tracks the files that a sandboxed reader opens by name: their identity, refused names, and the CPU time limit that depends on their
/// size. Any thread.
#pragma once
#include <sys/stat.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/input_files.h"

namespace catena::sandbox {

/// CPU time limit for reading this many bytes: 5 s, and 60 s per MB, since a byte can expand to a thousand. Seconds.
std::uint64_t cpu_limit_s(std::uint64_t bytes);

/// Starts tracking of opened files. `max_cpu_s`: upper bound of the CPU time limit, seconds. `dicom_only`: a folder is searched for DICOM
/// images; other files in it may be opened, but are not counted as data.
void track_opened_files(std::uint64_t max_cpu_s, bool dicom_only);
/// Returns whether files are tracked: then only regular files and folders can be opened.
bool is_tracking_opened_files();
/// Records an opened regular file and raises the CPU time limit.
void record_opened(int descriptor, const struct stat& about);
/// Records a name that leads to a pipe, a socket or a device.
void record_refused(const std::string& path);
/// Raises the CPU time limit by `seconds`, for work that does not depend on the size of the files.
void extend_cpu_limit(double seconds);

/// The opened and refused files.
struct OpenedFiles {
  std::vector<FileId> files;
  std::string refused_path;          ///< First refused file name; empty: none.
  std::int64_t newest_mtime_ns = 0;  ///< Latest modification time of the files when they were opened, ns since 1970.
};
/// Returns what has been recorded so far.
OpenedFiles opened_files();

}  // namespace catena::sandbox
