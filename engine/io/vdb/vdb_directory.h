/// The table of contents of a .vdb file, read without OpenVDB. Names and types cost nothing this way, and a file that is cut short is
/// found before OpenVDB trusts it.
///   header: magic i64, file version u32, library major and minor u32, has-offsets u8, uuid 36 bytes; metadata; grid count i32;
///   per grid: name, type, parent (strings with u32 lengths), begin, blocks, end (i64 offsets), then the grid itself up to `end`
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::vdb {

struct VdbEntry {
  std::string unique_name;   ///< as stored; a second grid of the same name has a suffix behind a separator
  std::string name;          ///< as shown: "density", "density[1]"
  std::string tree_type;     ///< "Tree_float_5_4_3"
  bool half = false;         ///< stored as half floats
  std::uint64_t offset = 0;  ///< where its entry begins in the file
};

struct VdbDirectory {
  std::vector<VdbEntry> entries;  ///< empty and `streamed` for the rare file without offsets
  bool is_streamed = false;
};

/// `path` is for the message.
Result<VdbDirectory> read_vdb_directory(std::span<const std::byte> file, const std::string& path);

/// "float", "half", "double", "int32", "int64", "bool", "mask", "vec3s", "half vec3s", "vec3d", "vec3i", or the tree's own word.
std::string type_name(const VdbEntry& entry);
bool is_scalar_type(const std::string& word);
bool is_vector_type(const std::string& word);
/// "density (half), velocity (half vec3s)"; "nothing" when empty.
std::string format_entries(const std::vector<VdbEntry>& entries);

}  // namespace catena::vdb
