/// The files that a confined reader has opened by name: which they are, what was refused, and the processor time that their size is worth.
/// Any thread.
#pragma once
#include <sys/stat.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/input_files.h"

namespace catena::reader {

/// Processor time that reading so many bytes may take: 5 s, and 60 s for every MB, since a byte can expand to a thousand.
std::uint64_t seconds_for(std::uint64_t bytes);

/// Opened files are counted from now on. `most_s`: the processor time that may be had at most. `dicom_only`: a folder is searched for
/// DICOM images; other files in it are looked at, but they are no part of the data.
void count_opened(std::uint64_t most_s, bool dicom_only);
/// Whether files are counted: then only regular files and folders can be opened.
bool counts_opened();
/// A regular file has been opened. Raises the limit of processor time.
void add_opened(int descriptor, const struct stat& about);
/// A name that leads to a pipe, a socket or a device.
void add_refused(const std::string& path);
/// More processor time, for work that the size of the files does not tell.
void allow_time(double seconds);

struct OpenedFiles {
  std::vector<FileId> files;
  std::string refused;         ///< the first name that was; empty: none
  std::int64_t newest_ns = 0;  ///< when the youngest of the files was last changed, as it was opened; since 1970
};
OpenedFiles opened_files();

}  // namespace catena::reader
