// SPDX-License-Identifier: MIT
#include "engine/base/vtk_xml_writer.h"

#include <fmt/format.h>

#include <bit>
#include <iterator>

namespace catena {

static_assert(std::endian::native == std::endian::little, "the appended data is written as it lies in memory");

std::string escape_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out;
}

void write_bytes(OutputFile& out, const void* data, std::size_t size) { out.write({static_cast<const char*>(data), size}); }

VtkXmlWriter::VtkXmlWriter(OutputFile& out, const std::string& kind, const std::string& attributes, const std::string& piece)
    : out_(out), kind_(kind) {
  out_.write(fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<{}{}>\n"
      "<Piece {}>\n",
      kind, kind, attributes.empty() ? "" : " " + attributes, piece));
}

void VtkXmlWriter::add_section(const std::string& name, const std::string& attributes, std::vector<AppendedArray> arrays) {
  out_.write(fmt::format("<{}{}>\n", name, attributes.empty() ? "" : " " + attributes));
  for (const AppendedArray& array : arrays) {
    out_.write(fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", array.type,
                           escape_xml(array.name), array.components, offset_));
    offset_ += sizeof(std::uint64_t) + array.bytes;
  }
  out_.write(fmt::format("</{}>\n", name));
  std::move(arrays.begin(), arrays.end(), std::back_inserter(arrays_));
}

void VtkXmlWriter::finish() {
  out_.write(fmt::format("</Piece>\n</{}>\n<AppendedData encoding=\"raw\">\n_", kind_));
  for (const AppendedArray& array : arrays_) {
    write_bytes(out_, &array.bytes, sizeof array.bytes);
    if (!out_.failed()) array.write(out_);
  }
  out_.write("\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace catena
