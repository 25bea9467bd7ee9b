/// The data files that this process has read, by device and inode: what an output of the program may not replace. Names do not decide, so
/// that links of both kinds count. Any thread.
#pragma once
#include <sys/stat.h>

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena {

/// A regular file on the disk, whatever its names are.
struct FileId {
  std::uint64_t device = 0, inode = 0;
  auto operator<=>(const FileId&) const = default;
};
FileId to_file_id(const struct stat& about);
/// When a file was last changed, in nanoseconds since 1970.
std::int64_t modified_ns(const struct stat& about);
/// Nothing: there is no regular file of that name.
std::optional<FileId> find_file_id(const std::string& path);

/// From now on these files count as inputs.
void register_inputs(const std::vector<FileId>& files);
/// From now on check_not_input refuses. The program says so at its start; the library does not, since its callers may write what they read.
void protect_inputs(bool protect);
/// Error: "PATH: is also an input: expected another name for the output".
Outcome check_not_input(const std::string& path);

}  // namespace catena
