// SPDX-License-Identifier: MIT
/// Tractogram files as bytes, written field by field by the formats' descriptions.
#pragma once
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "engine/io/curves/load_curves.h"

namespace catena::test {

template <class T>
void append_number(std::string& out, T number, bool big_endian) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &number, sizeof(T));
  if (big_endian) std::reverse(bytes, bytes + sizeof(T));
  out.append(bytes, sizeof(T));
}

using Polylines = std::vector<std::vector<Vec3>>;

inline std::string tck_bytes(const Polylines& lines, const std::string& type) {
  const bool big = type.ends_with("BE"), doubles = type.starts_with("Float64");
  std::string head = "mrtrix tracks\ncount: " + std::to_string(lines.size()) + "\ndatatype: " + type + "\nfile: . ";
  head += std::to_string(head.size() + 8) + "\nEND\n";
  head.resize(std::stoul(head.substr(head.find(". ") + 2)), '\0');
  const auto triple = [&](const Vec3& p) {
    for (int i = 0; i < 3; ++i) doubles ? append_number(head, p[i], big) : append_number(head, static_cast<float>(p[i]), big);
  };
  for (const auto& line : lines) {
    for (const Vec3& p : line) triple(p);
    triple(Vec3(std::numeric_limits<double>::quiet_NaN()));
  }
  triple(Vec3(std::numeric_limits<double>::infinity()));
  return head;
}

/// Rounds the coordinates to floats, as in a file.
inline curves::CurveSetPtr make_curve_set(const Polylines& lines) {
  auto set = curves::parse_tck(tck_bytes(lines, "Float32LE"), "made.tck");
  return set ? std::make_shared<const curves::CurveSet>(std::move(*set)) : nullptr;
}

struct TrkFile {
  Polylines lines;
  Vec3 voxel{1.0};
  std::array<int, 3> dim{10, 10, 10};
  std::string order = "LPS";
  std::array<std::array<float, 4>, 4> vox_to_ras{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  std::vector<std::string> scalars{};  ///< scalar k of point i of line n has the value 100 n + i + k / 2
  int properties = 0, version = 2, count = 0;
  bool big_endian = false;

  std::string bytes() const {
    std::string out;
    const auto text = [&](const std::string& s, std::size_t size) { out += s + std::string(size - s.size(), '\0'); };
    const auto number = [&](auto value) { append_number(out, value, big_endian); };
    text("TRACK", 6);
    for (const int n : dim) number(static_cast<std::int16_t>(n));
    for (int i = 0; i < 3; ++i) number(static_cast<float>(voxel[i]));
    for (int i = 0; i < 3; ++i) number(0.0f);
    number(static_cast<std::int16_t>(scalars.size()));
    for (std::size_t i = 0; i < 10; ++i) text(i < scalars.size() ? scalars[i] : "", 20);
    number(static_cast<std::int16_t>(properties));
    text("", 200);
    for (const auto& row : vox_to_ras)
      for (const float entry : row) number(version == 1 ? 0.0f : entry);
    text("", 444);
    text(order, 4);
    text("", 4);
    for (int i = 0; i < 6; ++i) number(0.0f);
    text("", 2 + 6);
    number(std::int32_t{count});
    number(std::int32_t{version});
    number(std::int32_t{1000});
    for (std::size_t n = 0; n < lines.size(); ++n) {
      number(static_cast<std::int32_t>(lines[n].size()));
      for (std::size_t i = 0; i < lines[n].size(); ++i) {
        for (int a = 0; a < 3; ++a) number(static_cast<float>(lines[n][i][a]));
        for (std::size_t k = 0; k < scalars.size(); ++k)
          number(100.0f * static_cast<float>(n) + static_cast<float>(i) + 0.5f * static_cast<float>(k));
      }
      for (int k = 0; k < properties; ++k) number(7.0f);
    }
    return out;
  }
};

}  // namespace catena::test
