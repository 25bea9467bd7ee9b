// SPDX-License-Identifier: MIT
/// Writer for VTK XML files with appended data: a header with the offset of each array, then the arrays as raw little-endian bytes. An
/// array is declared in a section of the header; its bytes are generated only when they are written, so no memory of its size is needed.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/output_file.h"

namespace catena {

/// Escapes text for an attribute in XML 1.0: markup is escaped, control characters become blanks.
std::string escape_xml(std::string_view text);

/// Array whose bytes follow the header.
struct AppendedArray {
  std::string type;  ///< "Float32", "Float64", "UInt8", "Int64"
  std::string name;
  int components = 1;
  std::uint64_t bytes = 0;
  std::function<void(OutputFile&)> write;  ///< writes exactly `bytes` bytes
};

/// Writes one VTK XML file: constructor, add_section() for each section, finish(). The OutputFile must outlive it.
class VtkXmlWriter {
 public:
  /// Writes the start of the file. `kind`: "PolyData", "ImageData"; `attributes`: attributes of its element; `piece`: those of its single
  /// piece.
  VtkXmlWriter(OutputFile& out, const std::string& kind, const std::string& attributes, const std::string& piece);

  /// Writes <NAME ATTRIBUTES>, the declarations of the arrays, </NAME>.
  void add_section(const std::string& name, const std::string& attributes, std::vector<AppendedArray> arrays);
  /// Writes the end of the header and the bytes of all arrays in the order of their sections. Write errors are reported by the file's
  /// commit().
  void finish();

 private:
  OutputFile& out_;
  std::string kind_;
  std::uint64_t offset_ = 0;
  std::vector<AppendedArray> arrays_;
};

/// Writes `size` bytes to the file.
void write_bytes(OutputFile& out, const void* data, std::size_t size);

}  // namespace catena
