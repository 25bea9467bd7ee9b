// SPDX-License-Identifier: MIT
#include "engine/io/zarr/zarr_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "engine/base/json_text.h"

namespace catena::field {
namespace {

/// Returns "<u2" for uint16, and so on.
std::string numpy_name(const NumberType& type) {
  const char kind = type.name.starts_with("float") ? 'f' : type.name.starts_with("u") ? 'u' : 'i';
  return fmt::format("{}{}{}", type.bytes == 1 ? '|' : '<', kind, type.bytes);
}

std::string fill_text(const NumberType& type, double fill) {
  if (type.name.starts_with("float")) return std::isnan(fill) ? "\"NaN\"" : to_text(fill);
  return std::to_string(static_cast<std::int64_t>(fill));
}

/// Returns the name of OME-Zarr for a length unit; an unknown unit is kept.
std::string ome_unit_name(const std::string& unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kNames{{{"m", "meter"},
                                                                                  {"cm", "centimeter"},
                                                                                  {"mm", "millimeter"},
                                                                                  {"um", "micrometer"},
                                                                                  {"\xC2\xB5m", "micrometer"},
                                                                                  {"\xCE\xBCm", "micrometer"},
                                                                                  {"nm", "nanometer"},
                                                                                  {"\xC3\x85", "angstrom"},
                                                                                  {"\xE2\x84\xAB", "angstrom"},
                                                                                  {"pm", "picometer"},
                                                                                  {"km", "kilometer"},
                                                                                  {"in", "inch"}}};
  const auto* found = std::ranges::find(kNames, unit, &std::pair<std::string_view, std::string_view>::first);
  return found == kNames.end() ? unit : std::string(found->second);
}

/// Returns [z, y, x].
std::string zyx_list(double x, double y, double z) { return fmt::format("[{}, {}, {}]", json_number(z), json_number(y), json_number(x)); }

/// Returns the member "omero": one channel with its window; empty: the range is not known.
std::string omero_text(const VoxelSource& source, const BrickRange& range) {
  if (!(range.min < range.max)) return {};
  const std::array<double, 2> window = source.window.value_or(std::array{range.min, range.max});
  return fmt::format(
      ",\n \"omero\": {{\"version\": \"0.4\", \"channels\": [{{\"label\": {}, \"active\": true, \"color\": \"{:06X}\",\n"
      "  \"window\": {{\"start\": {}, \"end\": {}, \"min\": {}, \"max\": {}}}}}]}}",
      json_string(source.name), source.color < 0 ? 0xFFFFFF : source.color, json_number(window[0]), json_number(window[1]),
      json_number(range.min), json_number(range.max));
}

}  // namespace

std::vector<BrickLevel> halved_levels(const Index3& size, const Mapping& mapping) {
  std::vector<BrickLevel> levels{{size, mapping}};
  std::array<int, 3> n{size.x, size.y, size.z};
  Vec3 step(1.0);
  while (*std::ranges::max_element(n) > kBrickEdge) {
    Mat3 linear = mapping.world_from_index_linear;
    for (int a = 0; a < 3; ++a) {
      if (n[a] > 1) step[a] *= 2;
      n[a] = (n[a] + 1) / 2;
      linear[a] *= step[a];
    }
    levels.push_back({{n[0], n[1], n[2]}, Mapping::from_linear(linear, mapping.world_from_index((step - Vec3(1.0)) / 2.0))});
  }
  return levels;
}

double stored_fill_value(const VoxelSource& source) {
  const double fill = source.fill_value;
  constexpr double kExact = 1LL << 53;
  if (std::isinf(fill) || fill == 0 || std::fabs(fill) > kExact) return 0;
  return std::isnan(fill) && !source.type.name.starts_with("float") ? 0 : fill;
}

std::string zarray_text(const VoxelSource& source, const BrickLevel& level) {
  return fmt::format(
      "{{\"zarr_format\": 2, \"shape\": [{}, {}, {}], \"chunks\": [{}, {}, {}], \"dtype\": \"{}\", \"order\": \"C\", \"fill_value\": {},\n"
      " \"compressor\": {{\"id\": \"blosc\", \"cname\": \"lz4\", \"clevel\": 5, \"shuffle\": 1, \"blocksize\": 0}}, \"filters\": null,\n"
      " \"dimension_separator\": \"/\"}}\n",
      level.size.z, level.size.y, level.size.x, kBrickEdge, kBrickEdge, kBrickEdge, numpy_name(source.type),
      fill_text(source.type, stored_fill_value(source)));
}

std::string zattrs_text(const VoxelSource& source, const std::vector<BrickLevel>& levels, const BrickRange& range) {
  const bool is_label_map = source.units.is_label_map;
  const std::string unit = source.units.length.empty() ? "" : ", \"unit\": " + json_string(ome_unit_name(source.units.length));
  std::string axes, datasets;
  for (const char name : {'z', 'y', 'x'})
    axes += fmt::format("{}{{\"name\": \"{}\", \"type\": \"space\"{}}}", axes.empty() ? "" : ", ", name, unit);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const Mapping& mapping = levels[level].mapping;
    const Mat3& linear = mapping.world_from_index_linear;
    datasets += fmt::format(
        "{}\n  {{\"path\": \"{}\", \"coordinateTransformations\": [{{\"type\": \"scale\", \"scale\": {}}},\n"
        "   {{\"type\": \"translation\", \"translation\": {}}}]}}",
        level == 0 ? "" : ",", level, zyx_list(linear[0].x, linear[1].y, linear[2].z),
        zyx_list(mapping.origin.x, mapping.origin.y, mapping.origin.z));
  }
  return fmt::format(
      "{{\"multiscales\": [{{\"version\": \"0.4\", \"name\": {}, \"type\": \"{}\",\n \"axes\": [{}],\n \"datasets\": [{}]}}]{}}}\n",
      json_string(source.name), is_label_map ? "nearest" : "mean", axes, datasets,
      is_label_map ? ",\n \"image-label\": {\"version\": \"0.4\"}" : omero_text(source, range));
}

}  // namespace catena::field
