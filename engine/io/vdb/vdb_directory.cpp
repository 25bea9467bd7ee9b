// SPDX-License-Identifier: MIT
#include "engine/io/vdb/vdb_directory.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "engine/base/text.h"

namespace catena::vdb {
namespace {

constexpr std::int64_t magic = 0x56444220;
constexpr std::uint32_t oldest_version = 222;  // OpenVDB 2.0 (2013)

/// Reader of little-endian numbers that records the first failure.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  T number() {
    T v{};
    if (const std::byte* from = take(sizeof v)) std::memcpy(&v, from, sizeof v);
    return v;
  }
  std::string text() {
    const auto length = number<std::uint32_t>();
    const std::byte* from = take(length);
    return from ? std::string(reinterpret_cast<const char*>(from), length) : std::string();
  }
  void skip(std::uint64_t count) { take(count); }
  /// Seeks forward only, so that an offset table cannot cause an endless loop.
  void seek(std::uint64_t offset) {
    ok_ = ok_ && offset >= at_ && offset <= bytes_.size();
    if (ok_) at_ = offset;
  }
  std::uint64_t at() const { return at_; }
  bool ok() const { return ok_; }

 private:
  const std::byte* take(std::uint64_t count) {
    ok_ = ok_ && count <= bytes_.size() - at_;
    if (!ok_) return nullptr;
    at_ += count;
    return bytes_.data() + at_ - count;
  }

  std::span<const std::byte> bytes_;
  std::uint64_t at_ = 0;
  bool ok_ = true;
};

VdbEntry entry_of(std::string unique_name, std::string type) {
  VdbEntry e;
  // repeated names are stored with a number after the ASCII record separator
  const auto separator = unique_name.find('\x1e');
  e.name = separator == std::string::npos ? unique_name
                                          : fmt::format("{}[{}]", unique_name.substr(0, separator), unique_name.substr(separator + 1));
  e.unique_name = std::move(unique_name);
  constexpr std::string_view half = "_HalfFloat";
  e.half = type.ends_with(half);
  e.tree_type = e.half ? type.substr(0, type.size() - half.size()) : std::move(type);
  return e;
}

}  // namespace

Result<VdbDirectory> read_vdb_directory(std::span<const std::byte> file, const std::string& path) {
  const std::uint64_t size = file.size();
  Reader reader(file);
  const auto truncated = [&](const std::string& where) {
    return Error{fmt::format("{}: the file is truncated or damaged ({} bytes, the error is in {}), expected a complete .vdb file", path,
                             size, where)};
  };

  // the header
  const auto first = reader.number<std::int64_t>();
  if (size < sizeof magic || first != magic)
    return Error{fmt::format("{}: this is not a .vdb file (the first bytes are not those of OpenVDB)", path)};
  const auto version = reader.number<std::uint32_t>();
  reader.number<std::uint32_t>();
  reader.number<std::uint32_t>();
  const auto has_offsets = reader.number<std::uint8_t>();
  if (!reader.ok()) return truncated("the header");
  if (version < oldest_version)
    return Error{fmt::format("{}: version {} of the .vdb format is too old, expected {} or newer", path, version, oldest_version)};
  constexpr std::uint64_t uuid_bytes = 36;
  reader.skip(uuid_bytes);
  const auto metadata = reader.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < metadata && reader.ok(); ++i) {
    reader.text();
    reader.text();
    reader.skip(reader.number<std::uint32_t>());
  }
  const auto count = reader.number<std::int32_t>();
  if (!reader.ok() || count < 0) return truncated("the header");

  // the grids
  VdbDirectory directory;
  directory.is_streamed = !has_offsets;
  for (std::int32_t i = 0; i < count && has_offsets; ++i) {
    const std::uint64_t at = reader.at();
    std::string name = reader.text(), type = reader.text();
    const bool shares_tree = !reader.text().empty();
    const auto begin = reader.number<std::int64_t>(), blocks = reader.number<std::int64_t>(), end = reader.number<std::int64_t>();
    if (!reader.ok()) return truncated(fmt::format("the entry of grid {}", i + 1));
    VdbEntry entry = entry_of(std::move(name), std::move(type));
    const bool in_order = shares_tree ? begin <= end : begin <= blocks && blocks <= end;  // a shared tree has no blocks
    if (begin <= 0 || !in_order || static_cast<std::uint64_t>(end) > size) return truncated(fmt::format("grid \"{}\"", entry.name));
    entry.offset = at;
    reader.seek(static_cast<std::uint64_t>(end));
    if (!reader.ok()) return truncated(fmt::format("grid \"{}\"", entry.name));
    directory.entries.push_back(std::move(entry));
  }
  return directory;
}

std::string type_name(const VdbEntry& entry) {
  // Tree_float_5_4_3 -> float
  std::string word = entry.tree_type;
  if (word.starts_with("Tree_")) word = word.substr(5);
  if (word.ends_with("_5_4_3")) word = word.substr(0, word.size() - 6);
  if (!entry.half) return word;
  return word == "float" ? word.replace(0, 5, "half") : word.insert(0, "half ");
}

bool is_scalar_type(const std::string& word) {
  return word == "float" || word == "half" || word == "double" || word == "half double" || word == "int32" || word == "int64";
}

bool is_vector_type(const std::string& word) {
  return word == "vec3s" || word == "half vec3s" || word == "vec3d" || word == "half vec3d" || word == "vec3i";
}

std::string format_entries(const std::vector<VdbEntry>& entries) {
  std::vector<std::string> each;
  for (std::size_t i = 0; i < std::min(entries.size(), kMaxListedNames); ++i)
    each.push_back(fmt::format("{} ({})", entries[i].name, type_name(entries[i])));
  std::vector<std::string_view> words(each.begin(), each.end());
  words.resize(entries.size());  // names beyond this number are only counted
  return entries.empty() ? "nothing" : join_words(words);
}

}  // namespace catena::vdb
