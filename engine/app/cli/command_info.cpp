// SPDX-License-Identifier: MIT
/// catena info FILE|SCENE: grids, transform, ranges, active voxels, bytes, NaN count; a mesh's triangles, box and open edges; the contents
/// of a scene or a recording.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/cli/command.h"
#include "engine/app/cli/command_reference.h"
#include "engine/app/cli/info_json.h"
#include "engine/app/cli/info_text.h"
#include "engine/app/cli/options.h"
#include "engine/app/cli/scene_schema.h"
#include "engine/app/haptics/log_replay.h"
#include "engine/app/tuning/predict/cost.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/field_display_range.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/derived_fields.h"
#include "engine/scene/drawable.h"
#include "engine/scene/ruler.h"
#include "engine/scene/scene.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/units.h"
#include "engine/scene/widgets.h"
#include "engine/schema/documents.h"
#include "haptics/build/build_program.h"
#include "haptics/constraints/presets/mode_presets.h"
#include "haptics/constraints/registry.h"
#include "haptics/device/device_settings.h"

namespace catena::app {

namespace {

/// Prints the pose and the sizes of each widget, and the value that a ruler measures.
Outcome describe_widgets(scene::Scene& scene) {
  std::vector<scene::Entity> widgets;
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget&) { widgets.push_back(e); });
  for (const scene::Entity e : widgets) {
    CATENA_TRY(const widget::Spec spec, scene::resolve_widget(scene, e));
    fmt::print("widget {}: {} at {}", sanitize_for_terminal(scene.entities.get<scene::Name>(e).value), scene::to_string(spec.kind),
               format_position(spec.pose.points[0]));
    switch (spec.kind) {
      case widget::Kind::cutting_plane:
        fmt::print(", normal {}, sphere {}, snap {}, release {}", format_position(scene::plane_normal(spec.pose)),
                   format_readable(spec.radius), format_readable(spec.snap), format_readable(spec.release));
        break;
      case widget::Kind::isolevel:
        fmt::print(", level {}", format_readable(scene.entities.get<scene::Widget>(e).report.value));
        break;
      case widget::Kind::rake:
      case widget::Kind::box:
        fmt::print(" .. {}", format_position(spec.pose.points[1]));
        break;
      case widget::Kind::ruler: {
        CATENA_TRY(const scene::RulerMeasure measure, scene::resolve_ruler(scene, e));
        constexpr const char* ways[] = {"straight", "along a streamline", "along an isosurface", "along a mesh"};
        fmt::print(" .. {}, {} {}{}", format_position(spec.pose.points[1]), format_readable(measure.length),
                   ways[static_cast<int>(measure.path_kind)], measure.note.empty() ? "" : " (" + sanitize_for_terminal(measure.note) + ")");
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
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& f) { fields.emplace_back(e, f.where); });
  for (const auto& [entity, where] : fields) {
    CATENA_TRY(const field::AnyField any, scene::resolve_field(scene, entity, where));
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(entity);
    fmt::print("field {}: {} {}, L = {}", sanitize_for_terminal(scene.entities.get<scene::Name>(entity).value),
               any.scalar ? "scalar" : "vector", sanitize_for_terminal(scene::source_text(source)),
               format_readable(any.get()->domain_length()));
    if (any.scalar) fmt::print(", values {}", format_range(field::display_range(*any.scalar)));
    if (const std::string unit = scene::unit_of(scene, entity); !unit.empty()) fmt::print(", in {}", sanitize_for_terminal(unit));
    fmt::print(", {}\n", format_bytes(static_cast<double>(any.get()->bytes())));
  }
  if (const std::string unit = scene::length_unit(scene); !unit.empty()) fmt::print("lengths in {}\n", sanitize_for_terminal(unit));
  std::vector<scene::Entity> meshes;
  scene.entities.each<scene::MeshSource>([&](scene::Entity e, const scene::MeshSource&) { meshes.push_back(e); });
  for (const scene::Entity e : meshes) {
    CATENA_TRY(const mesh::MeshPtr mesh, scene::resolve_mesh(scene, e));
    fmt::print("mesh {}: {}\n", sanitize_for_terminal(scene.entities.get<scene::Name>(e).value),
               sanitize_for_terminal(scene.entities.get<scene::MeshSource>(e).path));
    print_mesh(*mesh, "  ");
  }
  std::vector<scene::Entity> all_curves;
  scene.entities.each<scene::CurvesSource>([&](scene::Entity e, const scene::CurvesSource&) { all_curves.push_back(e); });
  for (const scene::Entity e : all_curves) {
    CATENA_TRY(const curves::CurveSetPtr set, scene::resolve_curves(scene, e));
    fmt::print("curves {}: {}\n", sanitize_for_terminal(scene.entities.get<scene::Name>(e).value), sanitize_for_terminal(set->name));
    print_curves(*set, "  ");
  }
  std::vector<scene::Entity> all_points;
  scene.entities.each<scene::PointsSource>([&](scene::Entity e, const scene::PointsSource&) { all_points.push_back(e); });
  for (const scene::Entity e : all_points) {
    CATENA_TRY(const curves::PointSetPtr set, scene::resolve_points(scene, e));
    fmt::print("points {}: {}\n", sanitize_for_terminal(scene.entities.get<scene::Name>(e).value), sanitize_for_terminal(set->name));
    print_points(*set, "  ");
  }
  CATENA_TRY(const std::shared_ptr<const haptics::HapticProgram> program, haptics::build_program(scene));
  print_scene_notes(scene);
  if (scene.device) CATENA_CHECK(haptics::read_device_settings(*scene.device, scene.path));
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    const haptics::ConstraintType* type = haptics::find_constraint_type(link.type);
    const haptics::ModePreset* mode = haptics::find_mode_preset(link.type);
    const std::string from = type != nullptr && !type->plugin.empty() ? "plug-in " + sanitize_for_terminal(type->plugin)
                             : type != nullptr                        ? type->paper
                             : mode != nullptr                        ? mode->paper
                                                                      : "";
    fmt::print("link {}: {} ({})\n", sanitize_for_terminal(link.name), sanitize_for_terminal(link.type), from);
  });
  CATENA_CHECK(describe_widgets(scene));
  fmt::print("coupling: {} N/m, {} N s/m, at most {} N{}\n", format_readable(program->coupling.stiffness_n_per_m),
             format_readable(program->coupling.damping_ns_per_m), format_readable(program->coupling.max_force_n),
             program->coupling.force == CouplingForce::conservative ? ", conservative" : "");
  if (scene.workspace.is_explicit)
    fmt::print("workspace: 1 world unit is {} m of the device\n", format_readable(scene.workspace.meters_per_unit));
  else
    fmt::print(
        "workspace: not stated; replay maps 1 world unit to 1 m of the device, view and feel fit the data into the device's workspace\n");
  std::string drawn;
  for (const scene::Drawable& kind : scene::drawables())
    drawn += fmt::format("{}{} {}", drawn.empty() ? "" : ", ", kind.items(scene.entities).size(), kind.plural);
  fmt::print("drawn: {}\n", drawn);
  if (const int steps = scene::step_count(scene); steps > 1) {
    const std::string now = scene::current_step_time(scene) ? ", current time " + scene::format_time(scene) : "";
    fmt::print("time: {} steps{}\n", steps, sanitize_for_terminal(now));
  }
  return Done{};
}

Outcome print_keys(const std::string& part) {
  CATENA_TRY(const std::string text, schema::format_keys(scene_file_components(), part, "info: --keys", "a scene"));
  fmt::print("{}", text);
  return Done{};
}

}  // namespace

void add_info(CLI::App& program, CommandAction& chosen) {
  auto path = std::make_shared<std::string>(), grid = std::make_shared<std::string>();
  auto schema = std::make_shared<bool>(false), maps = std::make_shared<bool>(false), formats = std::make_shared<bool>(false),
       json = std::make_shared<bool>(false), cost = std::make_shared<bool>(false), measure = std::make_shared<bool>(false);
  auto part = std::make_shared<std::string>();
  auto step = std::make_shared<int>(0);
  CLI::App* command = program.add_subcommand("info", "describes a data file, a mesh, curves, points, a scene or a recording");
  add_source(*command, "FILE", *path,
             "data file, folder of DICOM images, triangle mesh, curves, table of points, scene (.json) or recording (.catlog)")
      ->type_name("FILE");
  command->add_option("--grid", *grid, "name of a grid of a data file, or number of a DICOM series (default: all)")->type_name("GRID");
  command->add_option("--step", *step, "time step of a data file, counted from 0 (default: 0)")
      ->type_name("INDEX")
      ->check(CLI::Range(0, 1'000'000));
  command->add_flag("--json", *json, "prints the description as one JSON object");
  CLI::Option* costs = command->add_flag(
      "--cost", *cost,
      "prints predicted costs instead: bytes and times of loading, of GPU copies, of creating objects, of a tick and of a frame");
  command->add_flag("--measure", *measure, "also measures these costs and prints the results")->needs(costs);
  command->add_flag("--formats", *formats, "lists the file formats instead");
  command->add_flag("--schema", *schema, "prints the JSON Schema of scenes for editors instead");
  command->add_option("--keys", *part, "part of a scene (volumes, chain, camera, ...) whose keys are listed instead")->type_name("PART");
  command->add_flag("--colormaps", *maps, "lists the colour maps instead");
  command->callback([&chosen, path, grid, step, schema, maps, part, formats, json, cost, measure] {
    chosen = [path, grid, step, schema, maps, part, formats, json, cost, measure]() -> Outcome {
      if (*formats) {
        fmt::print("{}A folder is read as DICOM images or as an OpenFOAM case.\n", format_table());
        return Done{};
      }
      if (*maps) {
        for (const std::string_view name : scene::color_map_names()) fmt::print("{}\n{}_r\n", name, name);
        return Done{};
      }
      if (*schema) {
        fmt::print("{}", scene_json_schema());
        return Done{};
      }
      if (!part->empty()) return print_keys(*part);
      if (path->empty()) return Error{"info: expected a data file or a scene (see catena info --help)"};
      if (!grid->empty() && (is_log_file(*path) || is_scene_file(*path) || scene::detect_file_kind(*path) != scene::FileKind::field))
        return Error{*path + ": --grid applies only to a data file"};
      if (*step > 0 && (is_log_file(*path) || is_scene_file(*path))) return Error{*path + ": --step applies only to a data file"};
      if (*cost && is_log_file(*path)) return Error{*path + ": --cost: is a recording; a scene or a data file was expected"};
      if (*cost) return print_costs(*path, *json, *measure);
      if (*json) return print_json_info(*path, *grid, *step);
      if (is_log_file(*path)) return print_log_info(*path);
      if (is_scene_file(*path)) return describe_scene(*path);
      return print_data_info(*path, *grid, *step);
    };
  });
}

}  // namespace catena::app
