// SPDX-License-Identifier: MIT
/// Registry of the data files that this process has read, by device and inode, so that outputs do not overwrite inputs. Names are not
/// compared, so symbolic and hard links are recognized. Any thread.
#pragma once
#include <sys/stat.h>

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena {

/// Identity of a regular file on the disk, independent of its names.
struct FileId {
  std::uint64_t device = 0, inode = 0;
  auto operator<=>(const FileId&) const = default;
};
/// Returns the identity of the file that stat() described.
FileId to_file_id(const struct stat& about);
/// Returns the time of the last modification of a file, in nanoseconds since 1970.
std::int64_t modified_ns(const struct stat& about);
/// Returns the identity of a regular file; nullopt when there is no regular file of that name.
std::optional<FileId> find_file_id(const std::string& path);

/// Registers files as inputs of this process.
void register_inputs(const std::vector<FileId>& files);
/// Switches check_not_input() on or off; off by default. The program switches it on at its start; the library does not, because its callers
/// may overwrite files that they have read.
void protect_inputs(bool protect);
/// Checks that a file is not a registered input. Error: "PATH: is also an input: expected another name for the output". Always succeeds
/// while protection is off.
Outcome check_not_input(const std::string& path);

}  // namespace catena
