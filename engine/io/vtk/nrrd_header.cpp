// SPDX-License-Identifier: MIT
#include "engine/io/vtk/nrrd_header.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "engine/base/numbers.h"

namespace catena::vtk {
namespace {

constexpr std::size_t kMaxHeader = 1 << 20, kMaxAxes = 16;

std::string in_lower_case(std::string_view text, bool keep_blanks = true) {
  std::string out;
  for (const char c : text)
    if (keep_blanks || c != ' ') out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

/// Parses "(1,0,0) none (0,2,0)"; "none" gives an empty vector.
Result<std::vector<std::vector<double>>> vectors_of(std::string_view text) {
  std::vector<std::vector<double>> vectors;
  while (!(text = trim(text)).empty()) {
    if (vectors.size() >= kMaxAxes) return Error{fmt::format("more than {} vectors", kMaxAxes)};
    vectors.emplace_back();
    if (text.front() != '(') {
      const std::string_view word = text.substr(0, text.find_first_of(" \t("));
      if (in_lower_case(word) != "none") return Error{"\"" + std::string(word) + "\", expected vectors such as (1,0,0), or none"};
      text.remove_prefix(word.size());
      continue;
    }
    const std::size_t end = text.find(')');
    if (end == std::string_view::npos) return Error{"a vector without a closing bracket"};
    for (std::string_view remaining = text.substr(1, end - 1); !remaining.empty();) {
      const std::size_t comma = std::min(remaining.find(','), remaining.size());
      const auto number = parse_double(remaining.substr(0, comma));
      if (!number || vectors.back().size() >= kMaxAxes)
        return Error{"\"" + std::string(remaining.substr(0, comma)) + "\", expected a number"};
      vectors.back().push_back(*number);
      remaining.remove_prefix(std::min(comma + 1, remaining.size()));
    }
    text.remove_prefix(end + 1);
  }
  return vectors;
}

bool is_unknown(const std::string& kind) { return kind.empty() || kind == "???" || in_lower_case(kind) == "none"; }
bool is_domain(const std::string& kind) {
  const std::string word = in_lower_case(kind);
  return is_unknown(kind) || word == "domain" || word == "space" || word == "time";
}

}  // namespace

Result<NrrdHeader> parse_nrrd_header(const std::string& text) {
  NrrdHeader header;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) break;
    const std::size_t colon = line.find(':');
    if (line[0] == '#' || colon == std::string::npos || line.compare(colon, 2, ":=") == 0) continue;
    const std::string field = in_lower_case(line.substr(0, colon), false);
    const std::string_view value = trim(std::string_view(line).substr(colon + 1));
    constexpr std::size_t kMaxName = 4096;
    if (field == "datafile" && value.size() > kMaxName)
      return Error{fmt::format("\"data file\" has a name of {} characters, expected at most {}", value.size(), kMaxName)};
    if (field == "space") {
      for (const char c : in_lower_case(value))
        if (c != '-' && c != ' ') header.space += c;
      header.space_dimension = header.space.ends_with("time") || header.space.size() == 4 ? 4 : 3;
    } else if (field == "spacedimension") {
      header.space_dimension = static_cast<std::size_t>(std::max(0LL, parse_integer(value).value_or(0)));
    } else if (field == "kinds") {
      std::istringstream words{std::string(value)};
      for (std::string word; header.kinds.size() < kMaxAxes && words >> word;) header.kinds.push_back(word);
    } else if (field == "spacedirections" || field == "spaceorigin" || field == "measurementframe") {
      const auto vectors = vectors_of(value);
      if (!vectors) return Error{fmt::format("\"{}\" has {}", line.substr(0, std::min<std::size_t>(colon, 40)), vectors.error().message)};
      if (field == "spacedirections") header.directions = *vectors;
      if (field == "measurementframe") header.measurement_frame = *vectors;
      if (field == "spaceorigin" && !vectors->empty()) header.origin = vectors->front();
    }
  }
  return header;
}

Result<NrrdHeader> read_nrrd_header(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text, line;
  while (text.size() < kMaxHeader && std::getline(in, line) && !line.empty() && line != "\r") text += line + "\n";
  return parse_nrrd_header(text);
}

bool NrrdHeader::is_patient() const {
  for (const char* word : {"ras", "las", "lps", "rightanteriorsuperior", "leftanteriorsuperior", "leftposteriorsuperior"})
    if (space == word || space == std::string(word) + "t" || space == std::string(word) + "time") return true;
  return false;
}

std::array<double, 2> NrrdHeader::ras_signs() const {
  if (!is_patient()) return {1, 1};
  const bool is_left = space.starts_with('l'), posterior = space.starts_with("lp") || space.starts_with("leftposterior");
  return {is_left ? -1.0 : 1.0, posterior ? -1.0 : 1.0};
}

std::optional<field::Mapping> NrrdHeader::mapping() const {
  if (directions.empty() && !is_patient()) return std::nullopt;
  const std::array<double, 2> sign = ras_signs();
  Mat3 linear(1.0);
  Vec3 first(0.0);
  for (int c = 0; c < 2; ++c) linear[c][c] = sign[static_cast<std::size_t>(c)];
  const auto copy_vector = [&](const std::vector<double>& from, Vec3& to) {
    to = Vec3(0.0);
    for (int c = 0; c < 3 && static_cast<std::size_t>(c) < from.size(); ++c)
      to[c] = from[static_cast<std::size_t>(c)] * (c < 2 ? sign[static_cast<std::size_t>(c)] : 1);
  };
  int axis = 0;
  for (std::size_t a = 0; a < directions.size() && axis < 3; ++a) {
    if (a < kinds.size() && !is_domain(kinds[a])) continue;
    if (!directions[a].empty()) copy_vector(directions[a], linear[axis]);
    ++axis;
  }
  if (!origin.empty() && std::isfinite(origin[0])) copy_vector(origin, first);
  return field::Mapping::from_linear(linear, first);
}

std::string NrrdHeader::range_kind() const {
  for (const std::string& kind : kinds)
    if (!is_domain(kind)) return kind;
  return {};
}

NrrdRange NrrdHeader::range() const {
  const std::string kind = in_lower_case(range_kind());
  if (kind.empty() || kind == "scalar" || kind == "stub") return NrrdRange::scalar;
  if (kind.find("matrix") != std::string::npos || kind == "quaternion") return NrrdRange::other;
  if (kind == "point") return NrrdRange::points;
  for (const char* word : {"vector", "gradient", "normal"})
    if (kind.find(word) != std::string::npos) return NrrdRange::directions;
  return NrrdRange::numbers;
}

std::size_t NrrdHeader::ambiguous_axis() const {
  std::size_t ambiguous = 0, domain = 0;
  for (std::size_t a = 0; a < directions.size(); ++a) {
    const std::string kind = a < kinds.size() ? kinds[a] : "";
    domain += is_domain(kind) ? 1 : 0;
    if (directions[a].empty() && is_unknown(kind)) ambiguous = a + 1;
  }
  return domain != space_dimension ? ambiguous : 0;
}

}  // namespace catena::vtk
