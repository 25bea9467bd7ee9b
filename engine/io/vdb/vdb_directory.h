// SPDX-License-Identifier: MIT
/// The directory of a .vdb file, read without OpenVDB. Names and types are cheap to read this way, and truncation is detected before
/// OpenVDB reads the file.
///   header: magic i64, file version u32, library major and minor u32, has-offsets u8, uuid 36 bytes; metadata; grid count i32;
///   per grid: name, type, parent (strings with u32 lengths), begin, blocks, end (i64 offsets), then the grid itself up to `end`
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::vdb {

/// A grid in the directory.
struct VdbEntry {
  std::string unique_name;   ///< Name as stored; a second grid with the same name has a suffix after a separator.
  std::string name;          ///< Displayed name: "density", "density[1]".
  std::string tree_type;     ///< Stored tree type, such as "Tree_float_5_4_3".
  bool half = false;         ///< Values are stored as half floats.
  std::uint64_t offset = 0;  ///< Offset of its entry in the file, bytes.
};

/// The grids of a .vdb file.
struct VdbDirectory {
  std::vector<VdbEntry> entries;  ///< Grids in the order of the file; read_vdb_directory() leaves it empty for a streamed file.
  /// The file has no offsets (rare).
  bool is_streamed = false;
};

/// Reads the directory; `path` begins the message of an Error.
Result<VdbDirectory> read_vdb_directory(std::span<const std::byte> file, const std::string& path);

/// Short name of the type: "float", "half", "double", "int32", "int64", "bool", "mask", "vec3s", "half vec3s", "vec3d", "vec3i", or the
/// stored tree type.
std::string type_name(const VdbEntry& entry);
bool is_scalar_type(const std::string& word);
bool is_vector_type(const std::string& word);
/// Lists grids as "density (half), velocity (half vec3s)"; "nothing" when empty.
std::string format_entries(const std::vector<VdbEntry>& entries);

}  // namespace catena::vdb
