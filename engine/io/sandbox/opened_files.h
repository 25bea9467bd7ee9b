/// The files that a confined reader has opened by name: which they are, what was refused, and the processor time that their size is worth.
/// Any thread.
#pragma once
#include <sys/stat.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/input_files.h"

namespace catena::sandbox {

/// Processor time that reading so many bytes may take: 5 s, and 60 s for every MB, since a byte can expand to a thousand.
std::uint64_t cpu_limit_s(std::uint64_t bytes);

/// ImportedData files are counted from now on. `most_s`: the processor time that may be had at most. `dicom_only`: a folder is searched for
/// DICOM images; other files in it are looked at, but they are no part of the data.
void track_opened_files(std::uint64_t most_s, bool dicom_only);
/// Whether files are counted: then only regular files and folders can be opened.
bool is_tracking_opened_files();
/// A regular file has been opened. Raises the limit of processor time.
void record_opened(int descriptor, const struct stat& about);
/// A name that leads to a pipe, a socket or a device.
void record_refused(const std::string& path);
/// More processor time, for work that the size of the files does not tell.
void extend_cpu_limit(double seconds);

struct OpenedFiles {
  std::vector<FileId> files;
  std::string refused_path;          ///< the first name that was; empty: none
  std::int64_t newest_mtime_ns = 0;  ///< when the youngest of the files was last changed, as it was opened; since 1970
};
OpenedFiles opened_files();

}  // namespace catena::sandbox
