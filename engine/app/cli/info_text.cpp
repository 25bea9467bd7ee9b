// SPDX-License-Identifier: MIT
#include "engine/app/cli/info_text.h"

#include <fmt/core.h>

#include "engine/app/cli/command.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/field_display_range.h"
#include "engine/io/formats.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

std::string format_position(const Vec3& v) {
  constexpr int kDigits = 8;
  return format_readable(v.x, kDigits) + " " + format_readable(v.y, kDigits) + " " + format_readable(v.z, kDigits);
}

void print_mesh(const mesh::TriangleMesh& mesh, const char* indent) {
  fmt::print("{}triangles    {}{}\n", indent, mesh.triangles().size(),
             mesh.dropped_triangles() == 0 ? "" : fmt::format(" ({} degenerate triangles dropped)", mesh.dropped_triangles()));
  fmt::print("{}vertices     {}\n", indent, mesh.vertices().size());
  fmt::print("{}world box    {} .. {}   (L = {})\n", indent, format_position(mesh.min_corner()), format_position(mesh.max_corner()),
             format_readable(mesh.domain_length()));
  fmt::print("{}open edges   {}\n", indent, mesh.open_edges());
  fmt::print("{}other edges  {} with more than two faces, {} with inconsistently oriented faces\n", indent, mesh.non_manifold_edges(),
             mesh.misoriented_edges());
  fmt::print("{}bytes        {} ({})\n", indent, mesh.bytes(), format_bytes(static_cast<double>(mesh.bytes())));
}

namespace {

std::string values_text(std::span<const float> values) {
  const DisplayRange range = display_range(values);
  return range.count > 0 ? format_range(range) : "none";
}

}  // namespace

void print_curves(const curves::CurveSet& set, const char* indent) {
  double longest = 0, all = 0;
  for (std::size_t k = 0; k < set.line_count(); ++k) {
    double length = 0;
    for (std::size_t i = set.line_offsets[k] + 1; i < set.line_offsets[k + 1]; ++i)
      length += norm(Vec3(set.points[i]) - Vec3(set.points[i - 1]));
    longest = std::max(longest, length);
    all += length;
  }
  const std::string unit = set.unit.empty() ? "" : " " + set.unit;
  fmt::print("{}lines        {}{}\n", indent, set.line_count(), set.note.empty() ? "" : " (" + set.note + ")");
  fmt::print("{}points       {}\n", indent, set.points.size());
  fmt::print("{}lengths      mean {}{}, maximum {}{}\n", indent, format_readable(all / static_cast<double>(set.line_count())), unit,
             format_readable(longest), unit);
  fmt::print("{}world box    {} .. {}\n", indent, format_position(set.min_corner), format_position(set.max_corner));
  for (const curves::PointValues& one : set.values) {
    fmt::print("{}values       {}, {}\n", indent, in_quotes(one.name), values_text(one.values));
  }
  fmt::print("{}bytes        {} ({})\n", indent, set.bytes(), format_bytes(static_cast<double>(set.bytes())));
}

void print_points(const curves::PointSet& set, const char* indent) {
  fmt::print("{}points       {}{}\n", indent, set.points.size(), set.note.empty() ? "" : " (" + set.note + ")");
  fmt::print("{}spacing      median {}\n", indent, format_readable(set.median_spacing));
  fmt::print("{}world box    {} .. {}\n", indent, format_position(set.min_corner), format_position(set.max_corner));
  for (const curves::PointValues& one : set.values) {
    fmt::print("{}values       {}, {}\n", indent, in_quotes(one.name), values_text(one.values));
  }
  fmt::print("{}bytes        {} ({})\n", indent, set.bytes(), format_bytes(static_cast<double>(set.bytes())));
}

namespace {

bool is_diagonal(const Mat3& m) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (r != c && m[c][r] != 0) return false;
  return true;
}

void print_mapping(const field::Mapping& mapping) {
  const Mat3& j = mapping.world_from_index_linear;
  if (is_diagonal(j)) {
    fmt::print("  voxel        {}\n", format_position({j[0][0], j[1][1], j[2][2]}));
  } else {
    fmt::print("  voxel axes   ({}) ({}) ({})\n", format_position(j[0]), format_position(j[1]), format_position(j[2]));
  }
  fmt::print("  origin       {}   (world = J index + origin)\n", format_position(mapping.origin));
}

/// Returns "6, time 0, 0.1, 0.2, 0.3, 0.4, 0.5 s"; for more than kMaximum steps only the first and the last time.
std::string steps_text(const scene::TimeSteps& steps) {
  constexpr std::size_t kMaximum = 10;
  const std::vector<double>& times = steps.times;
  std::string text = std::to_string(steps.count);
  if (!times.empty()) text += ", time " + format_readable(times.front());
  const bool all = static_cast<int>(times.size()) == steps.count && times.size() <= kMaximum;
  for (std::size_t i = 1; all && i < times.size(); ++i) text += ", " + format_readable(times[i]);
  if (!all && times.size() > 1) text += " .. " + format_readable(times.back());
  return text + (times.empty() || steps.time_unit.empty() ? "" : " " + steps.time_unit);
}

/// Prints the time steps of a file or a pattern that has several. Error: the step does not exist.
Outcome print_steps(const std::string& path, const scene::TimeSteps& steps, int step) {
  CATENA_CHECK(check_step(step, steps.count - 1, fmt::format("--step {}", step), path));
  if (scene::is_pattern(path)) {
    const std::vector<std::string> files = scene::expand_pattern(path);
    fmt::print("  files        {}: {} .. {}\n", files.size(), sanitize_for_terminal(files.front()), sanitize_for_terminal(files.back()));
  }
  if (steps.count > 1) fmt::print("  steps        {}\n", sanitize_for_terminal(steps_text(steps)));
  return Done{};
}

/// Prints the levels of a grid in a store of chunks, and what is known of its values.
void print_levels(const field::GridInfo& g) {
  const auto text = [](const field::Size3& n) { return fmt::format("{} {} {}", n.x, n.y, n.z); };
  fmt::print("  levels       {}\n", g.levels.size());
  for (std::size_t level = 0; level < g.levels.size(); ++level)
    fmt::print("    {:<10} {} voxels, chunks of {}\n", level, text(g.levels[level].size), text(g.levels[level].chunk));
  if (g.window.size() == 2) fmt::print("  window       {} .. {}\n", format_readable(g.window[0]), format_readable(g.window[1]));
  if (g.color >= 0) fmt::print("  colour       #{:06x}\n", g.color);
  if (g.range_level < 0)
    fmt::print("  range        not known without reading all values\n");
  else
    fmt::print("  range        {}{}\n", format_range(g.display_range),
               g.levels.size() > 1 ? fmt::format(" (level {})", g.range_level) : "");
}

Outcome describe_file(const std::string& path, const std::string& grid, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const std::vector<field::GridInfo> grids, read_grid_infos(at.path, grid, at.step));
  fmt::print("{}: {} grid{}\n", sanitize_for_terminal(path), grids.size(), grids.size() == 1 ? "" : "s");
  for (const field::GridInfo& g : grids) {
    fmt::print("{} ({}{})\n", g.name.empty() ? "(no name)" : sanitize_for_terminal(g.name), sanitize_for_terminal(g.type),
               g.is_usable ? "" : "; not usable as a field");
    if (!g.series_number.empty()) fmt::print("  number       {}\n", sanitize_for_terminal(g.series_number));
    if (g.image_count > 0) fmt::print("  images       {}\n", g.image_count);
    if (!g.is_usable && g.image_count > 0) continue;  // its type states why it is not usable
    fmt::print("  size         {} {} {} voxels from index {} {} {}\n", g.size.x, g.size.y, g.size.z, g.first_index.x, g.first_index.y,
               g.first_index.z);
    print_mapping(g.mapping);
    const field::Units units = field::read_units(at.path, g.name);
    if (!units.value.empty()) fmt::print("  unit         {}\n", sanitize_for_terminal(units.value));
    if (!units.length.empty()) fmt::print("  length unit  {}\n", sanitize_for_terminal(units.length));
    const Vec3 lowest(g.first_index.x, g.first_index.y, g.first_index.z);
    const Vec3 edges(static_cast<double>(g.size.x - 1), static_cast<double>(g.size.y - 1), static_cast<double>(g.size.z - 1));
    const Bounds box = field::world_bounds(g.mapping, {lowest, lowest + edges});
    fmt::print("  world box    {} .. {}\n", format_position(box.lo), format_position(box.hi));
    if (!g.levels.empty()) {
      print_levels(g);
      continue;
    }
    fmt::print("  active       {} {}\n", g.stats.active_voxels, field::to_string(g.element_kind));
    if (g.is_usable) {
      fmt::print("  {}        {}\n", g.is_vector ? "speed" : "range", format_range(g.display_range));
      if (g.is_vector)
        fmt::print("  components   {} .. {}\n", format_position(g.stats.component_min), format_position(g.stats.component_max));
      fmt::print("  not finite   {}\n", g.stats.nan_count);
    }
    fmt::print("  bytes        {} ({})\n", g.bytes, format_bytes(static_cast<double>(g.bytes)));
  }
  if (io::needs_layout(path)) return Done{};
  const scene::FileSummary summary = scene::summarize_file(path, grid, step);
  CATENA_CHECK(print_steps(path, summary.steps, step));
  for (const std::string& line : summary.lines) fmt::print("{}\n", sanitize_for_terminal(line));
  return Done{};
}

Outcome describe_mesh(const std::string& path, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const mesh::MeshPtr mesh, mesh::load_mesh(at.path, {}, at.step));
  fmt::print("{}: triangle mesh\n", sanitize_for_terminal(path));
  print_mesh(*mesh, "  ");
  return print_steps(path, scene::list_time_steps(path, {}), step);
}

Outcome describe_points(const std::string& path, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const curves::PointSetPtr set, curves::load_points(at.path, at.step));
  fmt::print("{}: table of points\n", sanitize_for_terminal(path));
  print_points(*set, "  ");
  return print_steps(path, scene::list_time_steps(path, {}), step);
}

Outcome describe_curves(const std::string& path, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const curves::CurveSetPtr set, curves::load_curves(at.path, at.step));
  fmt::print("{}: curves\n", sanitize_for_terminal(path));
  print_curves(*set, "  ");
  return print_steps(path, scene::list_time_steps(path, {}), step);
}

}  // namespace

Outcome print_data_info(const std::string& path, const std::string& grid, int step) {
  switch (scene::detect_file_kind(path)) {
    case scene::FileKind::mesh:
      return describe_mesh(path, step);
    case scene::FileKind::curves:
      return describe_curves(path, step);
    case scene::FileKind::points:
      return describe_points(path, step);
    case scene::FileKind::field:
      return describe_file(path, grid, step);
  }
  return Done{};
}

}  // namespace catena::app
