#include "engine/app/info_text.h"

#include <fmt/core.h>

#include "engine/app/command.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/display_range.h"
#include "engine/field/formats.h"
#include "engine/field/load.h"
#include "engine/field/units.h"
#include "engine/mesh/load.h"
#include "engine/scene/steps.h"

namespace catena::app {

std::string place_text(const Vec3& v) {
  constexpr int kDigits = 8;
  return readable(v.x, kDigits) + " " + readable(v.y, kDigits) + " " + readable(v.z, kDigits);
}

void print_mesh(const mesh::TriangleMesh& mesh, const char* indent) {
  fmt::print("{}triangles    {}{}\n", indent, mesh.triangles().size(),
             mesh.dropped() == 0 ? "" : fmt::format(" ({} without an area dropped)", mesh.dropped()));
  fmt::print("{}vertices     {}\n", indent, mesh.vertices().size());
  fmt::print("{}world box    {} .. {}   (L = {})\n", indent, place_text(mesh.lowest()), place_text(mesh.highest()),
             readable(mesh.length()));
  fmt::print("{}open edges   {}\n", indent, mesh.open_edges());
  fmt::print("{}other edges  {} with more than two faces, {} whose faces disagree on the outside\n", indent, mesh.non_manifold_edges(),
             mesh.misoriented_edges());
  fmt::print("{}bytes        {} ({})\n", indent, mesh.bytes(), human_bytes(static_cast<double>(mesh.bytes())));
}

namespace {

std::string values_text(std::span<const float> values) {
  const DisplayRange range = display_range(values);
  return range.count > 0 ? range_text(range) : "none";
}

}  // namespace

void print_curves(const curves::CurveSet& set, const char* indent) {
  double longest = 0, all = 0;
  for (std::size_t k = 0; k < set.lines(); ++k) {
    double length = 0;
    for (std::size_t i = set.first[k] + 1; i < set.first[k + 1]; ++i) length += norm(Vec3(set.points[i]) - Vec3(set.points[i - 1]));
    longest = std::max(longest, length);
    all += length;
  }
  const std::string unit = set.unit.empty() ? "" : " " + set.unit;
  fmt::print("{}lines        {}{}\n", indent, set.lines(), set.note.empty() ? "" : " (" + set.note + ")");
  fmt::print("{}points       {}\n", indent, set.points.size());
  fmt::print("{}lengths      {}{} in the mean, the longest {}{}\n", indent, readable(all / static_cast<double>(set.lines())), unit,
             readable(longest), unit);
  fmt::print("{}world box    {} .. {}\n", indent, place_text(set.lowest), place_text(set.highest));
  for (const curves::PointValues& one : set.values) {
    fmt::print("{}values       {}, {}\n", indent, in_quotes(one.name), values_text(one.values));
  }
  fmt::print("{}bytes        {} ({})\n", indent, set.bytes(), human_bytes(static_cast<double>(set.bytes())));
}

void print_points(const curves::PointSet& set, const char* indent) {
  fmt::print("{}points       {}{}\n", indent, set.points.size(), set.note.empty() ? "" : " (" + set.note + ")");
  fmt::print("{}spacing      {} in the median\n", indent, readable(set.spacing));
  fmt::print("{}world box    {} .. {}\n", indent, place_text(set.lowest), place_text(set.highest));
  for (const curves::PointValues& one : set.values) {
    fmt::print("{}values       {}, {}\n", indent, in_quotes(one.name), values_text(one.values));
  }
  fmt::print("{}bytes        {} ({})\n", indent, set.bytes(), human_bytes(static_cast<double>(set.bytes())));
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
    fmt::print("  voxel        {}\n", place_text({j[0][0], j[1][1], j[2][2]}));
  } else {
    fmt::print("  voxel axes   ({}) ({}) ({})\n", place_text(j[0]), place_text(j[1]), place_text(j[2]));
  }
  fmt::print("  origin       {}   (world = J index + origin)\n", place_text(mapping.origin));
}

/// "6, time 0, 0.1, 0.2, 0.3, 0.4, 0.5 s"; of many the first and the last time.
std::string steps_text(const scene::StepList& steps) {
  constexpr std::size_t kMost = 10;
  const std::vector<double>& times = steps.times;
  std::string text = std::to_string(steps.count);
  if (!times.empty()) text += ", time " + readable(times.front());
  const bool all = static_cast<int>(times.size()) == steps.count && times.size() <= kMost;
  for (std::size_t i = 1; all && i < times.size(); ++i) text += ", " + readable(times[i]);
  if (!all && times.size() > 1) text += " .. " + readable(times.back());
  return text + (times.empty() || steps.time_unit.empty() ? "" : " " + steps.time_unit);
}

/// Of a file, or a pattern, that has several. Error: there is no such step.
Outcome print_steps(const std::string& path, const scene::StepList& steps, int step) {
  CATENA_CHECK(check_step(step, steps.count - 1, fmt::format("--step {}", step), path));
  if (scene::is_pattern(path)) {
    const std::vector<std::string> files = scene::files_of_pattern(path);
    fmt::print("  files        {}: {} .. {}\n", files.size(), printable(files.front()), printable(files.back()));
  }
  if (steps.count > 1) fmt::print("  steps        {}\n", printable(steps_text(steps)));
  return Done{};
}

Outcome describe_file(const std::string& path, const std::string& grid, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const std::vector<field::GridInfo> grids, grids_of(at.path, grid, at.step));
  fmt::print("{}: {} grid{}\n", printable(path), grids.size(), grids.size() == 1 ? "" : "s");
  for (const field::GridInfo& g : grids) {
    fmt::print("{} ({}{})\n", g.name.empty() ? "(no name)" : printable(g.name), printable(g.type),
               g.usable ? "" : "; not a field that Catena can show or feel");
    if (!g.number.empty()) fmt::print("  number       {}\n", printable(g.number));
    if (g.images > 0) fmt::print("  images       {}\n", g.images);
    if (!g.usable && g.images > 0) continue;  // what is wrong with it stands for its type
    fmt::print("  size         {} {} {} voxels from index {} {} {}\n", g.size.x, g.size.y, g.size.z, g.lowest.x, g.lowest.y, g.lowest.z);
    print_mapping(g.mapping);
    const field::Units units = field::units_of(at.path, g.name);
    if (!units.value.empty()) fmt::print("  unit         {}\n", printable(units.value));
    if (!units.length.empty()) fmt::print("  lengths in   {}\n", printable(units.length));
    const Vec3 lowest(g.lowest.x, g.lowest.y, g.lowest.z);
    const Vec3 edges(static_cast<double>(g.size.x - 1), static_cast<double>(g.size.y - 1), static_cast<double>(g.size.z - 1));
    const Bounds box = field::world_bounds(g.mapping, {lowest, lowest + edges});
    fmt::print("  world box    {} .. {}\n", place_text(box.lo), place_text(box.hi));
    fmt::print("  active       {} {}\n", g.stats.active_voxels, field::counted_word(g.counted));
    if (g.usable) {
      fmt::print("  {}        {}\n", g.is_vector ? "speed" : "range", range_text(g.shown));
      if (g.is_vector) fmt::print("  components   {} .. {}\n", place_text(g.stats.component_min), place_text(g.stats.component_max));
      fmt::print("  not finite   {}\n", g.stats.nan_count);
    }
    fmt::print("  bytes        {} ({})\n", g.bytes, human_bytes(static_cast<double>(g.bytes)));
  }
  if (field::needs_layout(path)) return Done{};
  const scene::FileLook look = scene::look_of_file(path, grid, step);
  CATENA_CHECK(print_steps(path, look.steps, step));
  for (const std::string& line : look.lines) fmt::print("{}\n", printable(line));
  return Done{};
}

Outcome describe_mesh(const std::string& path, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const mesh::MeshPtr mesh, mesh::load_mesh(at.path, {}, at.step));
  fmt::print("{}: triangle mesh\n", printable(path));
  print_mesh(*mesh, "  ");
  return print_steps(path, scene::steps_of_file(path, {}), step);
}

Outcome describe_points(const std::string& path, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const curves::PointSetPtr set, curves::load_points(at.path, at.step));
  fmt::print("{}: table of points\n", printable(path));
  print_points(*set, "  ");
  return print_steps(path, scene::steps_of_file(path, {}), step);
}

Outcome describe_curves(const std::string& path, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const curves::CurveSetPtr set, curves::load_curves(at.path, at.step));
  fmt::print("{}: curves\n", printable(path));
  print_curves(*set, "  ");
  return print_steps(path, scene::steps_of_file(path, {}), step);
}

}  // namespace

Outcome describe_data(const std::string& path, const std::string& grid, int step) {
  switch (scene::kind_of_file(path)) {
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
