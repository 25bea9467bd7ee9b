// SPDX-License-Identifier: MIT
// Layouts of one level: VTKHDF, NXdata, and files without a known layout.
#include "engine/io/chunks/hdf5_layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "engine/io/chunks/ome_metadata.h"

namespace catena::chunks {
namespace {

constexpr std::size_t kMaxGrids = 4096;

field::Index3 size_along(const H5Data& data, const int (&axis)[3]) {
  const auto along = [&](int a) { return axis[a] < 0 ? 1 : static_cast<int>(data.size[static_cast<std::size_t>(axis[a])]); };
  return {along(0), along(1), along(2)};
}

void add_level(H5Grid& grid, const H5Data& data, const std::string& path, const field::Mapping& mapping) {
  grid.description.levels.push_back({size_along(data, grid.axis), {1, 1, 1}, mapping});
  grid.paths.push_back({path});
}

/// Returns spacing and first position of the coordinates of an axis; {1, 0} where they are not evenly spaced numbers.
struct Spacing {
  double step = 1, first = 0;
  bool is_even = true;
};
Spacing spacing_of(const std::vector<double>& positions, std::int64_t count) {
  if (count < 2 || static_cast<std::int64_t>(positions.size()) != count) return {1, 0, positions.empty()};
  const double step = (positions.back() - positions.front()) / static_cast<double>(count - 1);
  if (!(std::fabs(step) > 0) || !std::isfinite(step)) return {1, 0, false};
  constexpr double kTolerance = 1e-3;
  Spacing spacing{step, positions.front(), true};
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!(std::fabs(positions[i] - spacing.first - static_cast<double>(i) * step) <= kTolerance * std::fabs(step))) spacing.is_even = false;
  return spacing;
}

/// Adds the grid of a group of class NXdata.
Outcome add_nexus(H5File& file, const std::string& group, H5Layout& out) {
  std::string signal = file.text(group, "signal");
  if (signal.empty()) {
    // before 2014 an attribute of the data set itself
    for (const std::string& name : file.members(group))
      if (!file.numbers(group + "/" + name, "signal").empty() || file.text(group + "/" + name, "signal") == "1") signal = name;
  }
  if (signal.empty()) return Error{fmt::format("has a group {} of class NXdata without the attribute \"signal\"", in_quotes(group))};
  const std::string path = group + "/" + signal;
  const auto found = file.data(path);
  if (!found) return Error{fmt::format("has a signal {} that {}", in_quotes(path), found.error().message)};
  const std::vector<std::int64_t> size = (*found)->size;
  const std::size_t rank = size.size();
  if (rank < 2 || rank > 4) return Error{fmt::format("has a signal {} with {} axes, expected 2 to 4", in_quotes(path), rank)};
  H5Grid grid;
  grid.description.name = signal;
  grid.description.value_unit = file.text(path, "units");
  for (int a = 0; a < 3; ++a) grid.axis[a] = static_cast<int>(rank) - 1 - a;
  if (rank > 3) grid.step_axis = 0;
  const std::vector<std::string> axes = file.texts(group, "axes");
  Mat3 linear(1.0);
  Vec3 origin(0.0);
  std::string unit;
  for (std::size_t d = 0; d < axes.size() && axes.size() == rank; ++d) {
    const std::string name = group + "/" + axes[d];
    if (axes[d] == "." || !file.exists(name)) continue;
    const Spacing spacing = spacing_of(file.values(name), size[d]);
    if (!spacing.is_even)
      out.notes.push_back(fmt::format("the positions along {} are not evenly spaced: even ones are used", in_quotes(name)));
    if (static_cast<int>(d) == grid.step_axis) {
      out.times = file.values(name);
      out.time_unit = file.text(name, "units");
      continue;
    }
    const int a = static_cast<int>(rank - 1 - d);
    const LengthUnit own = find_length_unit(file.text(name, "units"));
    if (unit.empty()) unit = own.name;
    linear[a][a] = spacing.step;
    origin[a] = spacing.first;
  }
  if (grid.step_axis >= 0) {
    grid.description.steps = static_cast<std::int32_t>(size[0]);
    if (static_cast<std::int64_t>(out.times.size()) != size[0]) {
      out.times.clear();
      for (std::int64_t t = 0; t < size[0]; ++t) out.times.push_back(static_cast<double>(t));
    }
  }
  grid.description.length_unit = unit;
  CATENA_TRY(const H5Data* data, file.data(path));
  add_level(grid, *data, path, field::Mapping::from_linear(linear, origin));
  out.grids.push_back(std::move(grid));
  return Done{};
}

/// Follows the attribute `default` from the root; empty: it leads to no group of class NXdata.
std::string default_group(const H5File& file) {
  std::string group = "/";
  constexpr int kMaxDepth = 8;
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    if (file.text(group, "NX_class") == "NXdata") return group;
    const std::string next = file.text(group, "default");
    if (next.empty()) return {};
    group = next.starts_with('/') ? next : (group == "/" ? "/" : group + "/") + next;
    if (!file.exists(group)) return {};
  }
  return {};
}

/// Finds groups of class NXdata, a few levels deep.
void find_nexus_groups(const H5File& file, const std::string& group, int depth, std::vector<std::string>& found) {
  constexpr int kMaxDepth = 4;
  if (file.text(group, "NX_class") == "NXdata") {
    found.push_back(group);
    return;
  }
  if (depth > 0 && file.text(group, "NX_class").empty()) return;
  if (depth >= kMaxDepth || found.size() >= kMaxGrids) return;
  for (const std::string& name : file.members(group)) find_nexus_groups(file, (group == "/" ? "/" : group + "/") + name, depth + 1, found);
}

}  // namespace

Result<H5Layout> find_vtkhdf_grids(H5File& file) {
  H5Layout out;
  if (!file.exists("/VTKHDF")) return out;
  const std::string type = file.text("/VTKHDF", "Type");
  if (type != "ImageData")
    return Error{fmt::format("is a VTKHDF file of type {}, expected ImageData; ParaView saves it as .vtu", in_quotes(type))};
  const std::vector<double> origin = file.numbers("/VTKHDF", "Origin"), spacing = file.numbers("/VTKHDF", "Spacing"),
                            direction = file.numbers("/VTKHDF", "Direction"), extent = file.numbers("/VTKHDF", "WholeExtent");
  Mat3 linear(1.0);
  Vec3 start(0.0);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      linear[column][row] = (spacing.size() == 3 ? spacing[static_cast<std::size_t>(column)] : 1) *
                            (direction.size() == 9 ? direction[static_cast<std::size_t>(3 * row + column)]
                             : row == column       ? 1
                                                   : 0);
  for (int a = 0; a < 3; ++a) start[a] = origin.size() == 3 ? origin[static_cast<std::size_t>(a)] : 0;
  if (extent.size() == 6) start += linear * Vec3(extent[0], extent[2], extent[4]);
  for (const std::string& name : file.members("/VTKHDF/PointData")) {
    const std::string path = "/VTKHDF/PointData/" + name;
    const auto found = file.data(path);
    const std::size_t rank = found ? (*found)->size.size() : 0;
    if (rank < 3 || rank > 4) {
      out.notes.push_back(fmt::format("the array {} is left out: it {}", in_quotes(name),
                                      found ? fmt::format("has {} axes, expected 3 or 4", rank) : found.error().message));
      continue;
    }
    constexpr std::int64_t kMaxComponents = 16;
    const std::int64_t components = rank == 4 ? std::min((*found)->size[3], kMaxComponents) : 1;
    for (std::int64_t c = 0; c < components; ++c) {
      H5Grid grid;
      grid.description.name = rank == 4 ? fmt::format("{} {}", name, c) : name;
      if (rank == 4) grid.channel_axis = 3;
      grid.channel = c;
      add_level(grid, **found, path, field::Mapping::from_linear(linear, start));
      out.grids.push_back(std::move(grid));
    }
  }
  if (out.grids.empty()) return Error{"is a VTKHDF image without point data of numbers"};
  return out;
}

Result<H5Layout> find_nexus_grids(H5File& file) {
  H5Layout out;
  std::vector<std::string> groups;
  if (const std::string group = default_group(file); !group.empty())
    groups.push_back(group);
  else
    find_nexus_groups(file, "/", 0, groups);
  std::vector<std::string> problems;
  for (const std::string& group : groups)
    if (const Outcome added = add_nexus(file, group, out); !added) problems.push_back(added.error().message);
  if (out.grids.empty() && !problems.empty()) return Error{problems.front()};
  for (const std::string& problem : problems) out.notes.push_back("the file " + problem);
  return out;
}

Result<H5Layout> find_plain_grids(H5File& file) {
  H5Layout out;
  std::size_t left_out = 0;
  std::string first_problem;
  for (const std::string& name : file.data_sets()) {
    const auto found = file.data(name);
    if (!found || (*found)->size.size() != 3 || out.grids.size() >= kMaxGrids) {
      ++left_out;
      const std::string problem = found ? fmt::format("has {} axes, expected 3", (*found)->size.size()) : found.error().message;
      if (first_problem.empty()) first_problem = fmt::format("the data set {} {}", in_quotes(name), problem);
      continue;
    }
    H5Grid grid;
    grid.description.name = name;
    const std::vector<double> sizes = file.numbers(name, "element_size_um");  // ilastik, Fiji's HDF5 plug-in
    Mat3 linear(1.0);
    for (int a = 0; a < 3 && sizes.size() == 3; ++a)
      if (sizes[static_cast<std::size_t>(2 - a)] > 0) linear[a][a] = sizes[static_cast<std::size_t>(2 - a)];
    if (sizes.size() == 3) grid.description.length_unit = "µm";
    add_level(grid, **found, name, field::Mapping::from_linear(linear, Vec3(0.0)));
    out.grids.push_back(std::move(grid));
  }
  if (out.grids.empty()) return Error{"has no data set of numbers with three axes" + (first_problem.empty() ? "" : ": " + first_problem)};
  if (left_out > 0) out.notes.push_back(fmt::format("{} data sets are left out; {}", left_out, first_problem));
  return out;
}

Result<H5Layout> find_hdf5_grids(H5File& file, const std::string& xml) {
  CATENA_TRY(H5Layout layout, find_bigdataviewer_grids(file, xml));
  if (layout.grids.empty()) {
    CATENA_TRY(layout, find_imaris_grids(file));
  }
  if (layout.grids.empty()) {
    CATENA_TRY(layout, find_vtkhdf_grids(file));
  }
  if (layout.grids.empty()) {
    CATENA_TRY(layout, find_nexus_grids(file));
  }
  if (!layout.grids.empty()) return layout;
  return find_plain_grids(file);
}

}  // namespace catena::chunks
