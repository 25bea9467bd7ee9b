// SPDX-License-Identifier: MIT
// Loads STL: binary with an 80-byte header of any content, the number of triangles, and 50 bytes for each (normal, three corners, two
// ignored bytes), little-endian floats; or text, "solid NAME / facet normal x y z / outer loop / vertex x y z (3 times) / endloop /
// endfacet / ... / endsolid". A file is binary if its length matches its number of triangles, whatever its first word is.
#include <bit>
#include <cstring>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/geometry/mesh/checked_growth.h"
#include "engine/io/formats.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/mesh/write_mesh.h"
#include "engine/io/parse_file.h"

namespace catena::mesh {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is copied without swapping bytes");

constexpr std::size_t kHeader = 84, kRecord = 50;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }

/// The words of a text with their line numbers.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  int line() const { return line_; }  ///< line of the last word

  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_here_ += text_[at_++] == '\n' ? 1 : 0;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    line_ = line_here_;
    return text_.substr(begin, at_ - begin);
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_here_ = 1, line_ = 1;
};

bool is_word(std::string_view word, std::string_view lower_case) {
  if (word.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((word[i] | 0x20) != lower_case[i]) return false;
  return true;
}

struct TextReader {
  const std::string& name;
  double text_bytes;
  Words words;

  Error failed(std::string_view found, std::string_view expected) const {
    const std::string what = found.empty() ? "the file ends too early" : "found " + in_quotes(found);
    return Error{one_line(name + ":" + std::to_string(words.line()) + ": " + what + "; " + std::string(expected) + " was expected")};
  }
  Outcome expect(std::string_view lower_case) {
    const std::string_view word = words.next();
    if (!is_word(word, lower_case)) return failed(word, in_quotes(lower_case));
    return Done{};
  }
  Result<Vec3> corner() {
    CATENA_CHECK(expect("vertex"));
    Vec3 v(0.0);
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = words.next();
      const auto number = word.empty() ? std::nullopt : parse_double(word);
      if (!number || !std::isfinite(*number)) return failed(word, "a finite number");
      v[i] = *number;
    }
    return v;
  }

  Result<TriangleSoup> read() {
    TriangleSoup soup;
    std::string_view word = words.next();
    if (!is_word(word, "solid")) return failed(word, "\"solid\" or a binary STL");
    while (!word.empty()) {
      if (!is_word(word, "solid")) return failed(word, "\"solid\" or the end of the file");
      words.skip_line();
      for (word = words.next(); !is_word(word, "endsolid"); word = words.next()) {
        if (!is_word(word, "facet")) return failed(word, "\"facet\" or \"endsolid\"");
        if (soup.triangles.size() >= kMaxTriangles)
          return failed(word, "a mesh of at most " + std::to_string(kMaxTriangles) + " triangles");
        CATENA_CHECK(expect("normal"));
        for (int i = 0; i < 3; ++i)
          if (const std::string_view number = words.next(); number.empty()) return failed(number, "a normal");
        CATENA_CHECK(expect("outer"));
        CATENA_CHECK(expect("loop"));
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        CATENA_CHECK(reserve_checked(soup.triangles, text_bytes + capacity_bytes(soup.vertices), name, "triangles"));
        for (int i = 0; i < 3; ++i) {
          CATENA_TRY(const Vec3 v, corner());
          CATENA_CHECK(reserve_checked(soup.vertices, text_bytes + capacity_bytes(soup.triangles), name, "corners"));
          soup.vertices.push_back(v);
        }
        CATENA_CHECK(expect("endloop"));
        CATENA_CHECK(expect("endfacet"));
        soup.triangles.push_back({first, first + 1, first + 2});
      }
      words.skip_line();
      word = words.next();
    }
    return soup;
  }
};

Result<TriangleSoup> read_binary(std::string_view bytes, std::size_t count, const std::string& name) {
  TriangleSoup soup;
  CATENA_CHECK(check_text_memory_available(fmt::format("{}: a mesh of {} triangles", name, count),
                                           static_cast<double>(bytes.size() + count * (3 * sizeof(Vec3) + sizeof(Triangle)))));
  soup.vertices.reserve(3 * count);
  soup.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = kHeader + i * kRecord + 12;
    float corners[9];
    std::memcpy(corners, bytes.data() + at, sizeof corners);
    for (int k = 0; k < 9; ++k)
      if (!std::isfinite(corners[k]))
        return Error{one_line(name + ": byte " + std::to_string(at + 4 * static_cast<std::size_t>(k)) + ": a corner of triangle " +
                              std::to_string(i + 1) + " is not finite; finite numbers were expected")};
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (int k = 0; k < 3; ++k)
      soup.vertices.push_back(
          {static_cast<double>(corners[3 * k]), static_cast<double>(corners[3 * k + 1]), static_cast<double>(corners[3 * k + 2])});
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

bool looks_like_text(std::string_view bytes) {
  Words words(strip_bom(bytes.substr(0, 512)));
  if (!is_word(words.next(), "solid")) return false;
  for (const char c : bytes.substr(0, 512))
    if (c == '\0') return false;
  return true;
}

}  // namespace

Result<TriangleSoup> parse_stl(std::string_view bytes, const std::string& name) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, sizeof count);
  const std::uint64_t expected_size = kHeader + std::uint64_t{kRecord} * count;
  const bool fits = bytes.size() >= kHeader && expected_size == bytes.size();
  if (!fits && looks_like_text(bytes)) return TextReader{name, static_cast<double>(bytes.size()), Words(strip_bom(bytes))}.read();
  if (bytes.size() < kHeader)
    return Error{one_line(name + ": has " + std::to_string(bytes.size()) +
                          " bytes and does not begin with \"solid\"; a binary STL of at least 84 bytes, or an ASCII STL, was expected")};
  const std::uint32_t other_order = count >> 24 | (count >> 8 & 0xff00) | (count << 8 & 0xff0000) | count << 24;
  if (!fits && kHeader + std::uint64_t{kRecord} * other_order == bytes.size())
    return Error{one_line(
        name + ": byte 80: the number of triangles matches the file size in big-endian order only; a little-endian STL was expected")};
  if (!fits)
    return Error{one_line(name + ": byte 80: the number of triangles is " + std::to_string(count) + ", which takes " +
                          std::to_string(expected_size) + " bytes, but the file has " + std::to_string(bytes.size()) +
                          "; a complete STL file was expected")};
  if (count > kMaxTriangles)
    return Error{one_line(name + ": byte 80: the number of triangles is " + std::to_string(count) + "; at most " +
                          std::to_string(kMaxTriangles) + " were expected")};
  return read_binary(bytes, count, name);
}

}  // namespace catena::mesh

namespace catena::io {

Format stl_format() {
  return {.name = "STL",
          .extensions = {".stl"},
          .read_mesh = parse_file<mesh::parse_stl, DataKind::mesh, 4>,
          .write_mesh = mesh::write_stl,
          .has_float_positions = true};
}

}  // namespace catena::io
