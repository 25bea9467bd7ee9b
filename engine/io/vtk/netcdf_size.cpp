// SPDX-License-Identifier: MIT
// The header (NetCDF's "classic format specification"), big-endian; N is 4 bytes, in CDF-5 8; OFFSET is 4 bytes, in CDF-2 and CDF-5 8:
//   "CDF" version, N records (all ones: not known), dimensions, attributes, variables; each list is a 4-byte tag, N entries, the entries
//   dimension   name, N length (0: that of the records)
//   attribute   name, 4-byte type, N values, the values
//   variable    name, N dimensions and each one's N, attributes, 4-byte type, N bytes (ignored), OFFSET of its first value
//   name        N bytes, the bytes; everything is padded to multiples of 4 bytes
#include "engine/io/vtk/netcdf_size.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "engine/io/vtk/truncation_check.h"

namespace catena::vtk {
namespace {

constexpr std::uint64_t kMaxEntries = 1'000'000;

class Header {
 public:
  explicit Header(const std::string& path) : in_(path, std::ios::binary) {}
  bool ok() const { return static_cast<bool>(in_); }
  void fail() { in_.setstate(std::ios::failbit); }

  std::uint64_t bytes(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | static_cast<std::uint64_t>(in_.get() & 0xff);
    return ok() ? value : 0;
  }
  std::uint64_t number() { return bytes(version_ == 5 ? 8 : 4); }
  std::uint64_t offset() { return bytes(version_ == 1 ? 4 : 8); }
  /// Returns the number of entries of a list, after its tag.
  std::uint64_t entries() {
    bytes(4);
    const std::uint64_t count = number();
    if (count > kMaxEntries) fail();
    return ok() ? count : 0;
  }
  void skip(std::uint64_t count) {
    if (count > kMaxEntries * 1024) fail();
    in_.ignore(static_cast<std::streamsize>((count + 3) / 4 * 4));
  }
  void skip_name() { skip(number()); }
  void skip_attributes() {
    for (std::uint64_t n = entries(); n > 0 && ok(); --n) {
      skip_name();
      const std::uint64_t size = type_bytes(bytes(4)), count = number();
      if (count > kMaxEntries * 1024) fail();
      skip(size * count);
    }
  }
  /// Returns the bytes of NC_BYTE, NC_CHAR, NC_SHORT, NC_INT, NC_FLOAT, NC_DOUBLE, NC_UBYTE, NC_USHORT, NC_UINT, NC_INT64, NC_UINT64, which
  /// are 1 to 11.
  std::uint64_t type_bytes(std::uint64_t type) {
    constexpr std::uint64_t kBytes[] = {1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    if (type < 1 || type > std::size(kBytes)) fail();
    return ok() ? kBytes[type - 1] : 0;
  }
  bool is_classic() {
    const std::uint64_t magic = bytes(3);
    version_ = static_cast<int>(bytes(1));
    return ok() && magic == 0x434446 && (version_ == 1 || version_ == 2 || version_ == 5);
  }

 private:
  std::ifstream in_;
  int version_ = 0;
};

struct Variable {
  std::uint64_t begin, bytes;  ///< offset of the first value, and size; for a record variable: size of one record
  bool of_records;
};

}  // namespace

Outcome check_netcdf_size(const std::string& path) {
  std::error_code code;
  const std::uint64_t size = std::filesystem::file_size(path, code);
  Header header(path);
  if (code || !header.is_classic()) return Done{};
  const std::uint64_t records = header.number();
  const bool known = records != 0xffffffff && records != ~std::uint64_t{0};
  std::vector<std::uint64_t> lengths;
  for (std::uint64_t n = header.entries(); n > 0 && header.ok(); --n) {
    header.skip_name();
    lengths.push_back(header.number());
  }
  header.skip_attributes();
  std::vector<Variable> variables;
  for (std::uint64_t n = header.entries(); n > 0 && header.ok(); --n) {
    header.skip_name();
    double values = 1;
    bool of_records = false;
    std::uint64_t dimensions = header.number();
    if (dimensions > kMaxEntries) header.fail();
    for (std::uint64_t d = 0; d < dimensions && header.ok(); ++d) {
      const std::uint64_t dimension = header.number(), length = dimension < lengths.size() ? lengths[dimension] : 0;
      of_records = of_records || (d == 0 && length == 0);
      if (d > 0 || length > 0) values *= static_cast<double>(length);
    }
    header.skip_attributes();
    values *= static_cast<double>(header.type_bytes(header.bytes(4)));
    header.number();
    const std::uint64_t begin = header.offset();
    if (values > 1e15) return Done{};
    variables.push_back({begin, static_cast<std::uint64_t>(values), of_records});
  }
  if (!header.ok()) return Done{};
  // record variables are interleaved, each padded to 4 bytes unless it is the only one
  const auto count = std::ranges::count_if(variables, &Variable::of_records);
  double record = 0;
  for (const Variable& v : variables)
    if (v.of_records) record += static_cast<double>(count == 1 ? v.bytes : (v.bytes + 3) / 4 * 4);
  double end = 0;
  for (const Variable& v : variables) {
    if (v.bytes == 0 || (v.of_records && (!known || records == 0))) continue;
    const double bytes_before = v.of_records ? record * static_cast<double>(records - 1) : 0;
    end = std::max(end, static_cast<double>(v.begin) + bytes_before + static_cast<double>(v.bytes));
  }
  if (end > static_cast<double>(size)) return Error{kTruncatedMessage};
  return Done{};
}

}  // namespace catena::vtk
