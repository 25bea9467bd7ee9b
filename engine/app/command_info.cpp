/// catena info FILE|SCENE: grids, transform, ranges, active voxels, bytes, NaN count; a mesh's triangles, box and open edges; what
/// a scene or a recording holds.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/command.h"
#include "engine/app/cost/cost.h"
#include "engine/app/info_json.h"
#include "engine/app/replay_log.h"
#include "engine/app/scene_schema.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/formats.h"
#include "engine/field/load.h"
#include "engine/field/units.h"
#include "engine/mesh/load.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/ruler.h"
#include "engine/scene/scene.h"
#include "engine/scene/steps.h"
#include "engine/scene/units.h"
#include "engine/scene/widgets.h"
#include "engine/schema/documents.h"
#include "haptics/constraints/presets/modes.h"
#include "haptics/constraints/registry.h"
#include "haptics/device/settings.h"
#include "haptics/extract/extract.h"

namespace catena::app {

namespace {

std::string text(const Vec3& v) { return to_text(v.x) + " " + to_text(v.y) + " " + to_text(v.z); }

bool is_diagonal(const Mat3& m) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (r != c && m[c][r] != 0) return false;
  return true;
}

void print_mapping(const field::Mapping& mapping) {
  const Mat3& j = mapping.world_from_index_linear;
  if (is_diagonal(j)) {
    fmt::print("  voxel        {}\n", text({j[0][0], j[1][1], j[2][2]}));
  } else {
    fmt::print("  voxel axes   ({}) ({}) ({})\n", text(j[0]), text(j[1]), text(j[2]));
  }
  fmt::print("  origin       {}   (world = J index + origin)\n", text(mapping.origin));
}

Outcome describe_file(const std::string& path) {
  CATENA_TRY(const std::vector<field::GridInfo> grids, field::describe(path));
  fmt::print("{}: {} grid{}\n", printable(path), grids.size(), grids.size() == 1 ? "" : "s");
  for (const field::GridInfo& g : grids) {
    fmt::print("{} ({}{})\n", g.name.empty() ? "(no name)" : printable(g.name), printable(g.type),
               g.usable ? "" : "; not a field that Catena can show or feel");
    fmt::print("  size         {} {} {} voxels from index {} {} {}\n", g.size.x, g.size.y, g.size.z, g.lowest.x, g.lowest.y, g.lowest.z);
    print_mapping(g.mapping);
    const field::Units units = field::units_of(path, g.name);
    if (!units.value.empty()) fmt::print("  unit         {}\n", printable(units.value));
    if (!units.length.empty()) fmt::print("  lengths in   {}\n", printable(units.length));
    const Vec3 lowest(g.lowest.x, g.lowest.y, g.lowest.z);
    const Vec3 edges(static_cast<double>(g.size.x - 1), static_cast<double>(g.size.y - 1), static_cast<double>(g.size.z - 1));
    const Bounds box = field::world_bounds(g.mapping, {lowest, lowest + edges});
    fmt::print("  world box    {} .. {}\n", text(box.lo), text(box.hi));
    fmt::print("  active       {} {}\n", g.stats.active_voxels, field::counted_word(g.counted));
    if (g.usable) {
      fmt::print("  {}        {} .. {}\n", g.is_vector ? "speed" : "range", to_text(g.stats.min), to_text(g.stats.max));
      if (g.is_vector) fmt::print("  components   {} .. {}\n", text(g.stats.component_min), text(g.stats.component_max));
      fmt::print("  not finite   {}\n", g.stats.nan_count);
    }
    fmt::print("  bytes        {} ({})\n", g.bytes, human_bytes(static_cast<double>(g.bytes)));
  }
  if (field::needs_layout(path)) return Done{};
  for (const std::string& line : scene::look_of_file(path)) fmt::print("{}\n", printable(line));
  return Done{};
}

void print_mesh(const mesh::TriangleMesh& mesh, const char* indent) {
  fmt::print("{}triangles    {}{}\n", indent, mesh.triangles().size(),
             mesh.dropped() == 0 ? "" : fmt::format(" ({} without an area dropped)", mesh.dropped()));
  fmt::print("{}vertices     {}\n", indent, mesh.vertices().size());
  fmt::print("{}world box    {} .. {}   (L = {})\n", indent, text(mesh.lowest()), text(mesh.highest()), to_text(mesh.length()));
  fmt::print("{}open edges   {}\n", indent, mesh.open_edges());
  fmt::print("{}other edges  {} with more than two faces, {} whose faces disagree on the outside\n", indent, mesh.non_manifold_edges(),
             mesh.misoriented_edges());
  fmt::print("{}bytes        {} ({})\n", indent, mesh.bytes(), human_bytes(static_cast<double>(mesh.bytes())));
}

Outcome describe_mesh(const std::string& path) {
  CATENA_TRY(const mesh::MeshPtr mesh, mesh::load_mesh(path));
  fmt::print("{}: triangle mesh\n", printable(path));
  print_mesh(*mesh, "  ");
  return Done{};
}

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
  fmt::print("{}lengths      {:.6g}{} in the mean, the longest {:.6g}{}\n", indent, all / static_cast<double>(set.lines()), unit, longest,
             unit);
  fmt::print("{}world box    {} .. {}\n", indent, text(set.lowest), text(set.highest));
  for (const curves::PointValues& one : set.values) {
    const auto [lo, hi] = std::ranges::minmax(one.values);
    fmt::print("{}values       {}, {:.6g}..{:.6g}\n", indent, in_quotes(one.name), lo, hi);
  }
  fmt::print("{}bytes        {} ({})\n", indent, set.bytes(), human_bytes(static_cast<double>(set.bytes())));
}

void print_points(const curves::PointSet& set, const char* indent) {
  fmt::print("{}points       {}{}\n", indent, set.points.size(), set.note.empty() ? "" : " (" + set.note + ")");
  fmt::print("{}spacing      {:.6g} in the median\n", indent, set.spacing);
  fmt::print("{}world box    {} .. {}\n", indent, text(set.lowest), text(set.highest));
  for (const curves::PointValues& one : set.values) {
    float lo = std::numeric_limits<float>::infinity(), hi = -lo;
    for (const float v : one.values)
      if (std::isfinite(v)) lo = std::min(lo, v), hi = std::max(hi, v);
    fmt::print("{}values       {}, {}\n", indent, in_quotes(one.name), lo <= hi ? fmt::format("{:.6g}..{:.6g}", lo, hi) : "none");
  }
  fmt::print("{}bytes        {} ({})\n", indent, set.bytes(), human_bytes(static_cast<double>(set.bytes())));
}

Outcome describe_points(const std::string& path) {
  CATENA_TRY(const curves::PointSetPtr set, curves::load_points(path));
  fmt::print("{}: table of points\n", printable(path));
  print_points(*set, "  ");
  return Done{};
}

Outcome describe_curves(const std::string& path) {
  CATENA_TRY(const curves::CurveSetPtr set, curves::load_curves(path));
  fmt::print("{}: curves\n", printable(path));
  print_curves(*set, "  ");
  return Done{};
}

/// Pose and sizes; what a ruler reads.
Outcome describe_widgets(scene::Scene& scene) {
  std::vector<scene::Entity> widgets;
  scene.world.each<scene::Widget>([&](scene::Entity e, const scene::Widget&) { widgets.push_back(e); });
  for (const scene::Entity e : widgets) {
    CATENA_TRY(const widget::Spec spec, scene::use_widget(scene, e));
    fmt::print("widget {}: {} at {}", printable(scene.world.get<scene::Name>(e).value), scene::kind_word(spec.kind),
               text(spec.pose.points[0]));
    switch (spec.kind) {
      case widget::Kind::cutting_plane:
        fmt::print(", normal {}, sphere {}, snap {}, release {}", text(scene::normal_of(spec.pose)), to_text(spec.radius),
                   to_text(spec.snap), to_text(spec.release));
        break;
      case widget::Kind::isolevel:
        fmt::print(", level {}", to_text(scene.world.get<scene::Widget>(e).state.value));
        break;
      case widget::Kind::rake:
      case widget::Kind::box:
        fmt::print(" .. {}", text(spec.pose.points[1]));
        break;
      case widget::Kind::ruler: {
        CATENA_TRY(const scene::RulerMeasure measure, scene::use_ruler(scene, e));
        constexpr const char* ways[] = {"straight", "along a streamline", "along an isosurface", "along a mesh"};
        fmt::print(" .. {}, {} {}{}", text(spec.pose.points[1]), to_text(measure.length), ways[static_cast<int>(measure.how)],
                   measure.note.empty() ? "" : " (" + printable(measure.note) + ")");
        break;
      }
      case widget::Kind::seed:
        break;
    }
    fmt::print(", button {}\n", spec.button);
  }
  return Done{};
}

Outcome describe_scene(const std::string& path) {
  CATENA_TRY(scene::Scene scene, open_scene(path));
  std::vector<std::pair<scene::Entity, json::Node>> fields;
  scene.world.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& f) { fields.emplace_back(e, f.where); });
  for (const auto& [entity, where] : fields) {
    CATENA_TRY(const field::AnyField any, scene::use_field(scene, entity, where));
    const scene::FieldSource& source = scene.world.get<scene::FieldSource>(entity);
    fmt::print("field {}: {} {}, L = {}", printable(scene.world.get<scene::Name>(entity).value), any.scalar ? "scalar" : "vector",
               printable(source.file ? source.file->path + (source.file->grid.empty() ? "" : ":" + source.file->grid) : source.analytic),
               to_text(any.get()->length()));
    if (any.scalar) fmt::print(", values {}..{}", to_text(any.scalar->min_value()), to_text(any.scalar->max_value()));
    if (const std::string unit = scene::unit_of(scene, entity); !unit.empty()) fmt::print(", in {}", printable(unit));
    fmt::print(", {}\n", human_bytes(static_cast<double>(any.get()->bytes())));
  }
  if (const std::string unit = scene::unit_length(scene); !unit.empty()) fmt::print("lengths in {}\n", printable(unit));
  std::vector<scene::Entity> meshes;
  scene.world.each<scene::MeshSource>([&](scene::Entity e, const scene::MeshSource&) { meshes.push_back(e); });
  for (const scene::Entity e : meshes) {
    CATENA_TRY(const mesh::MeshPtr mesh, scene::use_mesh(scene, e));
    fmt::print("mesh {}: {}\n", printable(scene.world.get<scene::Name>(e).value), printable(scene.world.get<scene::MeshSource>(e).path));
    print_mesh(*mesh, "  ");
  }
  std::vector<scene::Entity> all_curves;
  scene.world.each<scene::DrawnCurves>([&](scene::Entity e, const scene::DrawnCurves&) { all_curves.push_back(e); });
  for (const scene::Entity e : all_curves) {
    CATENA_TRY(const curves::CurveSetPtr set, scene::use_curves(scene, e));
    fmt::print("curves {}: {}\n", printable(scene.world.get<scene::Name>(e).value), printable(set->name));
    print_curves(*set, "  ");
  }
  std::vector<scene::Entity> all_points;
  scene.world.each<scene::DrawnPoints>([&](scene::Entity e, const scene::DrawnPoints&) { all_points.push_back(e); });
  for (const scene::Entity e : all_points) {
    CATENA_TRY(const curves::PointSetPtr set, scene::use_points(scene, e));
    fmt::print("points {}: {}\n", printable(scene.world.get<scene::Name>(e).value), printable(set->name));
    print_points(*set, "  ");
  }
  CATENA_TRY(const std::shared_ptr<const haptics::Program> program, haptics::extract_program(scene));
  if (scene.device) CATENA_CHECK(haptics::read_device_settings(*scene.device, scene.path));
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    const haptics::ConstraintType* type = haptics::find_constraint(link.type);
    const haptics::ReadyMode* mode = haptics::find_ready_mode(link.type);
    fmt::print("link {}: {} ({})\n", printable(link.name), printable(link.type), type ? type->paper : mode ? mode->paper : "");
  });
  CATENA_CHECK(describe_widgets(scene));
  fmt::print("coupling: {} N/m, {} N s/m, at most {} N\n", to_text(program->coupling.stiffness_n_per_m),
             to_text(program->coupling.damping_ns_per_m), to_text(program->coupling.max_force_n));
  if (scene.workspace.given)
    fmt::print("workspace: 1 world unit is {} m of the hand\n", to_text(scene.workspace.metres_per_unit));
  else
    fmt::print(
        "workspace: not stated; replay takes 1 world unit for 1 m of the hand, view and feel fit the data into the device's reach\n");
  fmt::print(
      "drawn: {} volumes, {} isosurfaces, {} slices, {} meshes, {} streamline sets, {} sets of glyphs, {} sets of curves, {} sets of "
      "points\n",
      scene.world.count<scene::Volume>(), scene.world.count<scene::Isosurface>(), scene.world.count<scene::Slice>(),
      scene.world.count<scene::SurfaceMesh>(), scene.world.count<scene::StreamlineSet>(), scene.world.count<scene::GlyphSet>(),
      scene.world.count<scene::DrawnCurves>(), scene.world.count<scene::DrawnPoints>());
  if (const int steps = scene::step_count(scene); steps > 1) fmt::print("time: {} steps\n", steps);
  return Done{};
}

Outcome print_keys(const std::string& part) {
  CATENA_TRY(const std::string text, schema::keys_text(scene_description(), part, "info: --keys", "a scene"));
  fmt::print("{}", text);
  return Done{};
}

}  // namespace

void add_info(CLI::App& program, Work& chosen) {
  auto path = std::make_shared<std::string>();
  auto schema = std::make_shared<bool>(false), maps = std::make_shared<bool>(false), formats = std::make_shared<bool>(false),
       json = std::make_shared<bool>(false), cost = std::make_shared<bool>(false), measure = std::make_shared<bool>(false);
  auto part = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("info", "describe a data file or a scene");
  command->add_option(
      "FILE", *path,
      "a data file, a folder of DICOM images, a triangle mesh, curves, a table of points, a scene (.json) or a recording (.catlog)");
  command->add_flag("--json", *json, "the same facts as one JSON object");
  CLI::Option* costs = command->add_flag(
      "--cost", *cost,
      "what of it will be loaded, mirrored, created, evaluated a tick and drawn a frame: bytes and expected times instead");
  command->add_flag("--measure", *measure, "with --cost: beside it what was then measured")->needs(costs);
  command->add_flag("--formats", *formats, "list the endings of the files that are read instead");
  command->add_flag("--schema", *schema, "print the JSON Schema of scenes instead, for an editor");
  command->add_option("--keys", *part, "list the keys of a part of a scene instead: volumes, chain, camera, ...");
  command->add_flag("--colormaps", *maps, "list the colour maps instead");
  command->callback([&chosen, path, schema, maps, part, formats, json, cost, measure] {
    chosen = [path, schema, maps, part, formats, json, cost, measure]() -> Outcome {
      if (*formats) {
        fmt::print("fields: {}\nmeshes: {}\nfolders: DICOM images\n", joined(field::field_endings()), joined(mesh::mesh_endings()));
        return Done{};
      }
      if (*maps) {
        for (const std::string_view name : scene::color_map_names()) fmt::print("{}\n{}_r\n", name, name);
        return Done{};
      }
      if (*schema) {
        fmt::print("{}", scene_schema());
        return Done{};
      }
      if (!part->empty()) return print_keys(*part);
      if (path->empty()) return Error{"info: expected a data file or a scene (see catena info --help)"};
      if (*cost && is_log_file(*path)) return Error{*path + ": --cost: a recording draws nothing; a scene or a data file was expected"};
      if (*cost) return print_costs(*path, *json, *measure);
      if (*json) return print_json_info(*path);
      if (is_log_file(*path)) return describe_log(*path);
      if (is_scene_file(*path)) return describe_scene(*path);
      switch (scene::kind_of_file(*path)) {
        case scene::FileKind::mesh:
          return describe_mesh(*path);
        case scene::FileKind::curves:
          return describe_curves(*path);
        case scene::FileKind::points:
          return describe_points(*path);
        case scene::FileKind::field:
          return describe_file(*path);
      }
      return Done{};
    };
  });
}

}  // namespace catena::app
