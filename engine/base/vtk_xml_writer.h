/// The shape that VTK's XML files share: a header that tells where the arrays lie, then the arrays as raw little-endian bytes. An array is
/// declared in a section of the header, and its bytes are made when its turn comes, so that nothing of its size is in memory.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/output_file.h"

namespace catena {

/// Text as it may stand in an attribute of XML 1.0: markup is escaped, control characters become blanks.
std::string escape_xml(std::string_view text);

struct AppendedArray {
  std::string type;  ///< "Float32", "Float64", "UInt8", "Int64"
  std::string name;
  int components = 1;
  std::uint64_t bytes = 0;
  std::function<void(OutputFile&)> write;  ///< exactly that many
};

class VtkXmlWriter {
 public:
  /// Writes the beginning: `kind` is "PolyData", "ImageData"; `attributes` of its element and of its one piece.
  VtkXmlWriter(OutputFile& out, const std::string& kind, const std::string& attributes, const std::string& piece);

  /// <NAME ATTRIBUTES>, the arrays, </NAME>.
  void add_section(const std::string& name, const std::string& attributes, std::vector<AppendedArray> arrays);
  /// The end of the header, and the bytes of all arrays in the order of their sections. The file's own errors are kept for its commit().
  void finish();

 private:
  OutputFile& out_;
  std::string kind_;
  std::uint64_t offset_ = 0;
  std::vector<AppendedArray> arrays_;
};

void write_bytes(OutputFile& out, const void* data, std::size_t size);

}  // namespace catena
