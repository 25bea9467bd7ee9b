// SPDX-License-Identifier: MIT
// Loads Wavefront OBJ: lines "v x y z", "f a b c ..." with corners "v", "v/vt", "v//vn", "v/vt/vn" (from 1, or negative: from the last),
// '#' starts a comment up to the end of the line, '\' continues on the next line. All other known statements are ignored.
#include <algorithm>
#include <array>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/geometry/mesh/checked_growth.h"
#include "engine/io/formats.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/mesh/write_mesh.h"
#include "engine/io/parse_file.h"

namespace catena::mesh {
namespace {

constexpr std::size_t kMaxVertices = 3 * kMaxTriangles;

constexpr std::array<std::string_view, 38> kPassedOver = {
    "vt",     "vn",    "vp",       "g",        "o",    "s",          "mg",        "usemtl", "mtllib", "usemap", "maplib", "l",  "p",
    "cstype", "deg",   "bmat",     "step",     "curv", "curv2",      "surf",      "parm",   "trim",   "hole",   "scrv",   "sp", "end",
    "con",    "bevel", "c_interp", "d_interp", "lod",  "shadow_obj", "trace_obj", "ctech",  "stech",  "call",   "csh",    "res"};

struct ObjReader {
  std::string_view text;
  const std::string& name;
  std::size_t at = 0;
  int line = 1;        ///< number of the next line
  int line_begin = 1;  ///< number of the current line
  std::string joined_line;
  TriangleSoup soup;

  Error failed(const std::string& what) const { return Error{one_line(name + ":" + std::to_string(line_begin) + ": " + what)}; }

  /// Gets the next line without its end and its comment; continued lines are joined. Returns false at the end of the text.
  bool next_line(std::string_view& out) {
    if (at >= text.size()) return false;
    line_begin = line;
    bool joined = false;
    while (true) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      std::string_view part = text.substr(at, end - at);
      at = end + 1;
      ++line;
      if (part.ends_with('\r')) part.remove_suffix(1);
      part = part.substr(0, part.find('#'));
      const bool goes_on = part.ends_with('\\');
      if (goes_on) part.remove_suffix(1);
      if (!joined && !goes_on) {
        out = part;
        return true;
      }
      if (!joined) joined_line.clear();
      joined = true;
      joined_line += part;
      joined_line += ' ';
      if (goes_on && at < text.size()) continue;
      out = joined_line;
      return true;
    }
  }

  static std::string_view next_word(std::string_view& remaining) {
    std::size_t begin = 0;
    while (begin < remaining.size() && (remaining[begin] == ' ' || remaining[begin] == '\t' || remaining[begin] == '\r')) ++begin;
    std::size_t end = begin;
    while (end < remaining.size() && remaining[end] != ' ' && remaining[end] != '\t' && remaining[end] != '\r') ++end;
    const std::string_view word = remaining.substr(begin, end - begin);
    remaining.remove_prefix(end);
    return word;
  }

  Outcome read_vertex(std::string_view remaining) {
    Vec3 v(0.0);
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = next_word(remaining);
      const auto number = word.empty() ? std::nullopt : parse_double(word);
      if (!number || !std::isfinite(*number))
        return failed((word.empty() ? std::string("a vertex has too few coordinates") : in_quotes(word) + " is not a valid coordinate") +
                      "; three finite numbers were expected");
      v[i] = *number;
    }
    if (soup.vertices.size() >= kMaxVertices)
      return failed("too many vertices; at most " + std::to_string(kMaxVertices) + " were expected");
    CATENA_CHECK(reserve_checked(soup.vertices, static_cast<double>(text.size()) + capacity_bytes(soup.triangles), name, "vertices"));
    soup.vertices.push_back(v);
    return Done{};
  }

  Result<std::uint32_t> read_corner(std::string_view word) const {
    const std::string_view digits = word.substr(0, word.find('/'));
    const auto index = parse_integer(digits);
    const auto count = static_cast<long long>(soup.vertices.size());
    if (!index || *index == 0)
      return failed(in_quotes(word) + " is not a valid corner; a vertex number (v, v/vt, v//vn or v/vt/vn) was expected");
    const long long found = *index > 0 ? *index - 1 : count + *index;
    if (*index > count || *index < -count)
      return failed(in_quotes(word) + " refers to a vertex that does not exist; " +
                    (count > 0 ? "1 to " + std::to_string(count) : "a vertex before the face") + " was expected");
    return static_cast<std::uint32_t>(found);
  }

  Outcome read_face(std::string_view remaining) {
    std::uint32_t first = 0, last = 0;
    int corners = 0;
    for (std::string_view word = next_word(remaining); !word.empty(); word = next_word(remaining)) {
      CATENA_TRY(const std::uint32_t v, read_corner(word));
      ++corners;
      if (corners == 1) first = v;
      if (corners > 2) {
        if (soup.triangles.size() >= kMaxTriangles)
          return failed("too many triangles; at most " + std::to_string(kMaxTriangles) + " were expected");
        CATENA_CHECK(reserve_checked(soup.triangles, static_cast<double>(text.size()) + capacity_bytes(soup.vertices), name, "triangles"));
        soup.triangles.push_back({first, last, v});
      }
      last = v;
    }
    if (corners < 3) return failed("a face has " + std::to_string(corners) + " corners; at least 3 were expected");
    return Done{};
  }

  Result<TriangleSoup> read() {
    std::string_view remaining;
    while (next_line(remaining)) {
      const std::string_view word = next_word(remaining);
      if (word.empty()) continue;
      if (word == "v") {
        CATENA_CHECK(read_vertex(remaining));
      } else if (word == "f" || word == "fo") {
        CATENA_CHECK(read_face(remaining));
      } else if (std::find(kPassedOver.begin(), kPassedOver.end(), word) == kPassedOver.end()) {
        return failed(in_quotes(word) + " is not a statement of an OBJ file; v, f, vt, vn, g, o, s, usemtl or mtllib was expected");
      }
    }
    return std::move(soup);
  }
};

}  // namespace

Result<TriangleSoup> parse_obj(std::string_view text, const std::string& name) {
  return ObjReader{strip_bom(text), name, 0, 1, 1, {}, {}}.read();
}

}  // namespace catena::mesh

namespace catena::io {

Format obj_format() {
  return {.name = "Wavefront OBJ",
          .extensions = {".obj"},
          .read_mesh = parse_file<mesh::parse_obj, DataKind::mesh, 4>,
          .write_mesh = mesh::write_obj};
}

}  // namespace catena::io
