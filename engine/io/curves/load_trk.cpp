// SPDX-License-Identifier: MIT
// Loads TrackVis files (trackvis.org/docs/?subsect=fileformat); what the header leaves undefined is read as NiBabel does.
#include <fmt/format.h>

#include <cmath>

#include "engine/base/text.h"
#include "engine/geometry/curves/byte_order.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/formats.h"
#include "engine/io/parse_file.h"

namespace catena::curves {
namespace {

constexpr std::size_t kHeader = 1000;
constexpr std::size_t kDim = 6, kVoxelSize = 12, kScalars = 36, kScalarNames = 38, kProperties = 238, kVoxToRas = 440, kVoxelOrder = 948,
                      kCount = 988, kVersion = 992, kHeaderSize = 996;
constexpr std::size_t kNameBytes = 20;
constexpr int kMaxScalars = 10;  // number of scalar names in the header

/// Affine map: world = linear p + shift.
struct Affine {
  Mat3 linear{1.0};
  Vec3 shift{0.0};
};

/// An axis of patient space: 0..2 for right, anterior, superior, and its sign.
struct Axis {
  int axis = -1;
  double sign = 1;
};

/// Returns for each column of the matrix the axis nearest to it; each axis once, the largest entries first.
std::array<Axis, 3> axes_of(const Mat3& m) {
  std::array<Axis, 3> out;
  Mat3 remaining;
  for (int c = 0; c < 3; ++c) remaining[c] = direction(m[c]);
  for (int step = 0; step < 3; ++step) {
    int column = -1, row = -1;
    double maximum = 0;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        if (std::fabs(remaining[c][r]) > maximum) maximum = std::fabs(remaining[c][r]), column = c, row = r;
    if (column < 0) return out;
    out[static_cast<std::size_t>(column)] = {row, remaining[column][row] < 0 ? -1.0 : 1.0};
    for (int k = 0; k < 3; ++k) remaining[column][k] = remaining[k][row] = 0;
  }
  return out;
}

bool read_order(std::string_view letters, std::array<Axis, 3>& out) {
  bool used[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t at = std::string_view("RASLPI").find(letters[i]);
    if (at == std::string_view::npos || used[at % 3]) return false;
    used[at % 3] = true;
    out[i] = {static_cast<int>(at % 3), at < 3 ? 1.0 : -1.0};
  }
  return true;
}

std::string text_at(std::string_view bytes, std::size_t at, std::size_t max_length) {
  const std::string_view field = bytes.substr(at, max_length);
  return std::string(field.substr(0, field.find('\0')));
}

struct TrkHeader {
  bool big_endian = false, patient = false;
  Affine world;
  int scalars = 0, properties = 0, count = 0;
  std::vector<std::string> names;
};

class TrkHeaderReader {
 public:
  TrkHeaderReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Result<TrkHeader> read() {
    if (bytes_.size() < kHeader || !bytes_.starts_with("TRACK"))
      return failed("is not a TrackVis file; a header of 1000 bytes that begins with \"TRACK\" was expected");
    header_.big_endian = decode_number<std::int32_t>(bytes_.data() + kHeaderSize, false) != std::int32_t{kHeader};
    if (at<std::int32_t>(kHeaderSize) != std::int32_t{kHeader})
      return failed("the header size is " + std::to_string(decode_number<std::int32_t>(bytes_.data() + kHeaderSize, false)) +
                    "; 1000 was expected, in either byte order");
    const int version = at<std::int32_t>(kVersion);
    if (version < 1 || version > 3) return failed(fmt::format("has version {}; 1, 2 or 3 was expected", version));
    header_.scalars = at<std::int16_t>(kScalars);
    header_.properties = at<std::int16_t>(kProperties);
    header_.count = at<std::int32_t>(kCount);
    if (header_.scalars < 0 || header_.scalars > kMaxScalars || header_.properties < 0 || header_.properties > kMaxScalars)
      return failed(fmt::format("the header has {} scalars and {} properties; 0 to {} of each were expected", header_.scalars,
                                header_.properties, kMaxScalars));
    if (header_.count < 0) return failed(fmt::format("the number of lines is {}; 0 or more was expected", header_.count));
    for (int k = 0; k < header_.scalars; ++k) {
      const std::string name = sanitize_for_terminal(text_at(bytes_, kScalarNames + static_cast<std::size_t>(k) * kNameBytes, kNameBytes));
      header_.names.push_back(name.empty() ? fmt::format("scalar_{}", k) : name);
    }
    CATENA_CHECK(read_world(version));
    return std::move(header_);
  }

 private:
  template <class T>
  T at(std::size_t offset) const {
    return decode_number<T>(bytes_.data() + offset, header_.big_endian);
  }
  Error failed(const std::string& what) const { return Error{one_line(name_ + ": " + what)}; }

  Outcome read_world(int version) {
    Vec3 voxel, cells;
    for (int i = 0; i < 3; ++i) {
      voxel[i] = at<float>(kVoxelSize + 4 * static_cast<std::size_t>(i));
      cells[i] = at<std::int16_t>(kDim + 2 * static_cast<std::size_t>(i));
    }
    if (!is_finite(voxel) || !(std::min({voxel.x, voxel.y, voxel.z}) > 0))
      return failed(fmt::format("the voxel size is ({}, {}, {}); three numbers > 0 were expected", voxel.x, voxel.y, voxel.z));

    // vox_to_ras; version 1 of the format omits it
    Affine ras;
    const auto entry = [&](int row, int column) {
      return static_cast<double>(at<float>(kVoxToRas + 4 * static_cast<std::size_t>(4 * row + column)));
    };
    header_.patient = version >= 2 && entry(3, 3) != 0;
    if (header_.patient)
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) ras.linear[column][row] = entry(row, column);
        ras.shift[row] = entry(row, 3);
      }
    const std::array<Axis, 3> to = axes_of(ras.linear);
    for (int c = 0; c < 3; ++c)
      if (!is_finite(ras.linear[c]) || !is_finite(ras.shift) || to[static_cast<std::size_t>(c)].axis < 0)
        return failed("vox_to_ras in the header cannot be inverted; a matrix of rank 3 was expected");

    std::string letters = text_at(bytes_, kVoxelOrder, 4);
    for (char& c : letters) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
    if (letters.empty()) letters = "LPS";
    std::array<Axis, 3> from;
    if (letters.size() < 3 || !read_order(letters, from))
      return failed("the voxel order is " + in_quotes(letters) + "; three letters such as \"LPS\" were expected");

    // from voxels in the file's order to voxels of the matrix: each axis goes to the axis with the same meaning, counted from the other
    // end if the directions are opposite
    Mat3 reorder(0.0);
    Vec3 back(0.0);
    for (int c = 0; c < 3; ++c)
      for (int f = 0; f < 3; ++f) {
        const Axis &mine = to[static_cast<std::size_t>(c)], &his = from[static_cast<std::size_t>(f)];
        if (mine.axis != his.axis) continue;
        const double sign = mine.sign * his.sign;
        reorder[f][c] = sign;
        back[c] = sign < 0 ? cells[f] - 1 : 0;
      }
    Mat3 scale(0.0);
    for (int i = 0; i < 3; ++i) scale[i][i] = 1 / voxel[i];
    header_.world.linear = ras.linear * reorder * scale;
    header_.world.shift = ras.linear * (reorder * Vec3(-0.5) + back) + ras.shift;
    return Done{};
  }

  std::string_view bytes_;
  const std::string& name_;
  TrkHeader header_;
};

}  // namespace

Result<CurveSet> parse_trk(std::string_view bytes, const std::string& name) {
  CATENA_TRY(const TrkHeader header, TrkHeaderReader(bytes, name).read());
  const bool big = header.big_endian;
  const auto scalars = static_cast<std::size_t>(header.scalars), a_point = 4 * (3 + scalars),
             after = 4 * static_cast<std::size_t>(header.properties);
  CATENA_TRY(CurveSetBuilder builder, CurveSetBuilder::create(name, (bytes.size() - kHeader) / a_point, header.names));
  std::array<float, kMaxScalars> values{};
  std::size_t at = kHeader;
  for (int line = 0; header.count == 0 ? at < bytes.size() : line < header.count; ++line) {
    const auto failed = [&](const std::string& what) {
      return Error{one_line(fmt::format("{}: line {}, byte {}: {}", name, line, at, what))};
    };
    if (bytes.size() - at < 4) return failed("the file ends before this line; a number of points was expected");
    const int points = decode_number<std::int32_t>(bytes.data() + at, big);
    if (points < 0 || static_cast<std::size_t>(points) > (bytes.size() - at - 4) / a_point ||
        static_cast<std::size_t>(points) * a_point + after > bytes.size() - at - 4)
      return failed(fmt::format("the line has {} points; at most as many as the remaining {} bytes hold were expected", points,
                                bytes.size() - at - 4));
    at += 4;
    for (int k = 0; k < points; ++k, at += a_point) {
      Vec3 p;
      for (int i = 0; i < 3; ++i) p[i] = decode_number<float>(bytes.data() + at + 4 * static_cast<std::size_t>(i), big);
      for (std::size_t i = 0; i < scalars; ++i) values[i] = decode_number<float>(bytes.data() + at + 4 * (3 + i), big);
      if (!builder.add(header.world.linear * p + header.world.shift, values.data()))
        return failed(fmt::format("the point ({}, {}, {}) is not finite or too far away; numbers up to 1e15 were expected", p.x, p.y, p.z));
    }
    at += after;
    builder.end_line();
  }
  CATENA_TRY(CurveSet set, builder.finish());
  set.unit = "mm";
  set.is_patient_space = header.patient;
  if (header.properties > 0)
    set.note += fmt::format("{}the {} propert{} of each line skipped", set.note.empty() ? "" : ", ", header.properties,
                            header.properties == 1 ? "y" : "ies");
  return set;
}

}  // namespace catena::curves

namespace catena::io {

Format trk_format() {
  return {.name = "TrackVis tractogram", .extensions = {".trk"}, .read_curves = parse_file<curves::parse_trk, DataKind::curves, 8>};
}

}  // namespace catena::io
