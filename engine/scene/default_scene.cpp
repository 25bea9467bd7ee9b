// SPDX-License-Identifier: MIT
#include "engine/scene/default_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/field/field_display_range.h"
#include "engine/io/formats.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/default_points.h"
#include "engine/scene/default_visualization.h"
#include "engine/scene/labels.h"
#include "engine/scene/readers.h"
#include "engine/scene/time_steps.h"

namespace catena::scene {
namespace {

/// A data file to be shown; its grids are described on first use, and the description is cached.
struct LookedInto {
  std::string path;   ///< of a pattern: its file at the step
  int step = 0;       ///< step within that file
  bool found = true;  ///< false: no file matches the pattern
  FileKind kind = FileKind::field;
  std::optional<Result<std::vector<field::GridInfo>>> described{};

  const Result<std::vector<field::GridInfo>>& grids() {
    if (!described) described = field::describe_grids(path, step);
    return *described;
  }
};

LookedInto look_into(const std::string& name, int step = 0) {
  const field::LoadRequest request = request_at(name, step);
  LookedInto file{request.path, request.step, !is_pattern(request.path)};
  const std::string& path = file.path;
  const bool field = io::find_reader(path, io::DataKind::volume) != nullptr, mesh = io::find_reader(path, io::DataKind::mesh) != nullptr,
             curves = io::find_reader(path, io::DataKind::curves) != nullptr,
             points = io::find_reader(path, io::DataKind::points) != nullptr;
  if (!mesh && !curves && !points) return file;
  if (field && (!file.grids() || std::ranges::any_of(*file.grids(), &field::GridInfo::is_usable))) return file;
  file.kind = mesh ? FileKind::mesh : curves ? FileKind::curves : FileKind::points;
  if (mesh + curves + points == 1) return file;
  const auto shapes = field::read_primitive_kinds(path);
  if (!shapes || (mesh && shapes->triangles)) return file;
  file.kind = curves && shapes->lines ? FileKind::curves : points ? FileKind::points : FileKind::mesh;
  return file;
}

/// Loads the requested grid; without a request the only grid, the first scalar grid, or the first vector grid, in this order.
Result<field::AnyField> load_best(LookedInto& file, field::LoadRequest& request) {
  auto loaded = field::load(request);
  if (loaded || !request.grid.empty()) return loaded;
  const auto& grids = file.grids();
  if (!grids) return loaded.error();
  const field::GridInfo* best = nullptr;
  for (const field::GridInfo& grid : *grids)
    if (grid.is_usable && grid.stats.active_voxels > 0 && (best == nullptr || (best->is_vector && !grid.is_vector))) best = &grid;
  if (best == nullptr) return loaded.error();
  request.grid = best->name;
  return field::load(request);
}

/// A valid field name of a scene file that is as close to the grid's name as possible.
std::string field_name(std::string_view grid) {
  std::string name;
  for (const char c : grid) {
    if (c >= 'A' && c <= 'Z')
      name += static_cast<char>(c - 'A' + 'a');
    else
      name += (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ? c : '_';
  }
  return is_identifier(name) ? name : is_identifier("field_" + name) && !name.empty() ? "field_" + name : "field";
}

/// Scene members for the other grids of the file. They are loaded on demand only.
std::string other_fields(LookedInto& looked, const std::string& shown, const std::string& file, const std::string& taken) {
  if (shown.empty() || !looked.grids()) return {};
  std::vector<std::string> names{taken};
  std::string text;
  for (const field::GridInfo& grid : *looked.grids()) {
    const std::string name = json::serialize_string(field_name(grid.name));
    if (!grid.is_usable || grid.stats.active_voxels == 0 || grid.name.empty() || grid.name == shown) continue;
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    names.push_back(name);
    text += ",\n             " + name + ": {\"file\": " + file + ", \"grid\": " + json::serialize_string(grid.name) + "}";
  }
  return text;
}

struct LaterStep {
  field::AnyField field;
  int step = 0;
};

/// The last step, if the field is uniform at the step of `bare`, as a simulation often is when it starts: the colors are chosen from it.
std::optional<LaterStep> later_step(const std::string& path, const DefaultScene& bare) {
  const auto is_uniform = [](const field::AnyField& field) {
    const DisplayRange range = field::display_range(field);
    return !(range.lo < range.hi);
  };
  if (!is_uniform(bare.field)) return std::nullopt;
  const int last = list_time_steps(path, bare.field).count - 1;
  field::LoadRequest request = bare.request;
  request.path = path;
  if (last < 1) return std::nullopt;
  const auto field = field::load(request_at(request, last));
  if (!field || is_uniform(*field) || (field->scalar == nullptr) != (bare.field.scalar == nullptr)) return std::nullopt;
  return LaterStep{*field, last};
}

/// Adds the fibers of a file that also holds a body, inside the body's translucent shell.
void show_fibres(LookedInto& file, DefaultScene& bare, DefaultVisualization& look) {
  const auto& grids = file.grids();
  if (look.shell_members.empty() || bare.request.grid.empty() || !grids) return;
  for (const field::GridInfo& grid : *grids) {
    if (!grid.is_usable || !grid.is_vector || grid.stats.active_voxels == 0 || grid.name.empty()) continue;
    field::LoadRequest request = bare.request;
    request.grid = grid.name;
    const auto loaded = field::load(request);
    if (!loaded || !loaded->vector) continue;
    const DefaultVisualization fibres =
        choose_default_visualization(json::serialize_string(field_name(grid.name)), *loaded->vector->grid(), {});
    if (!fibres.is_fibers) continue;
    look.scene_members = look.shell_members + ",\n" + fibres.scene_members;
    look.note += "; " + in_quotes(grid.name) + " " + fibres.note;
    bare.fibers_grid = grid.name;
    bare.fibers = *loaded;
    return;
  }
}

std::string curves_note(const curves::CurveSet& set) {
  return fmt::format("{} curve{} in the colours of their directions, red for x, green for y, blue for z{}{}", set.line_count(),
                     set.line_count() == 1 ? "" : "s", set.note.empty() ? "" : "; ", set.note);
}

void forget_lines(json::Node& node) {
  node.line = 0;
  for (json::Node& item : node.items) forget_lines(item);
  for (auto& [key, member] : node.members) forget_lines(member);
}

template <class T>
void forget_lines(Scene& scene) {
  scene.entities.each<T>([](Entity, T& part) { forget_lines(part.where); });
}

}  // namespace

Result<DefaultScene> make_default_scene(const std::string& path, const std::string& grid, const NamedColors& colors, int step) {
  DefaultScene bare;
  bare.scene_path = path + ".json";
  const std::string file = json::serialize_string(std::filesystem::path(path).filename().string());
  LookedInto looked = look_into(path, step);
  bare.request.path = looked.path;
  bare.request.step = looked.step;
  if (!looked.found) return Error{one_line(path + ": no file is called like this")};
  if (looked.kind == FileKind::mesh) {
    if (!colors.is_default()) return Error{one_line(path + ": a mesh has no values to colour; a colour map goes with a data file")};
    CATENA_TRY(bare.mesh, mesh::load_mesh(looked.path, {}, looked.step));
    bare.text = "{\n  \"meshes\": [{\"name\": \"mesh\", \"file\": " + file + "}],\n" + default_mesh_background() + "\n}\n";
    return bare;
  }
  if (looked.kind == FileKind::curves) {
    if (!colors.is_default())
      return Error{one_line(path + ": curves are shown in the colours of their directions; a colour map goes with a data file")};
    CATENA_TRY(bare.curves, curves::load_curves(looked.path, looked.step));
    bare.note = curves_note(*bare.curves);
    bare.text = "{\n  \"curves\": [{\"name\": \"curves\", \"file\": " + file + "}],\n" + default_mesh_background() + "\n}\n";
    return bare;
  }
  if (looked.kind == FileKind::points) {
    CATENA_TRY(bare.points, curves::load_points(looked.path, looked.step));
    CATENA_TRY(const std::string parts, default_points_members(*bare.points, file, colors, bare.note));
    bare.text = "{\n" + parts + ",\n" + default_mesh_background() + "\n}\n";
    return bare;
  }
  if (io::needs_layout(path))
    return Error{one_line(path + ": a .raw file does not say its shape; a scene file that states it was expected")};
  bare.request.grid = grid;
  CATENA_TRY(bare.field, load_best(looked, bare.request));
  const std::string name = json::serialize_string(field_name(bare.field.get()->name()));
  const auto later = later_step(path, bare);
  const field::AnyField& seen = later ? later->field : bare.field;
  DefaultVisualization look = seen.scalar ? choose_default_visualization(name, *seen.scalar->grid(),
                                                                         field::read_units(bare.request.path, bare.request.grid), colors)
                                          : choose_default_visualization(name, *seen.vector->grid(), colors);
  if (later) look.note += fmt::format(" (at step {}; at step {} all values are equal)", later->step, step);
  if (grid.empty() && colors.is_default()) show_fibres(looked, bare, look);
  bare.note = name + " " + look.note;
  bare.text = "{\n  \"fields\": {" + name + ": {\"file\": " + file;
  if (!bare.request.grid.empty()) bare.text += ", \"grid\": " + json::serialize_string(bare.request.grid);
  if (look.is_label_map) {
    bare.request.interpolation = field::Interpolation::nearest;
    bare.field.scalar = bare.field.scalar->grid()->with_interpolation(bare.request.interpolation);
    bare.text += ", \"interpolation\": \"nearest\"";
    if (const std::string table = find_label_table(path); !table.empty()) {
      const std::string table_name = std::filesystem::path(table).filename().string();
      bare.text += ", \"labels\": {\"file\": " + json::serialize_string(table_name) + "}";
      bare.note += "; names from " + sanitize_for_terminal(table_name);
    }
  }
  if (look.ignore_mask) {
    bare.text += ", \"valid\": null";
    bare.request.mask_grid.reset();
    CATENA_TRY(bare.field, field::load(bare.request));
  }
  bare.text += "}" + look.extra_fields;
  if (grid.empty()) {
    const std::string others = other_fields(looked, bare.request.grid, file, name);
    bare.text += others;
    if (!others.empty()) bare.note += "; the file holds other fields, too: --grid NAME shows one (catena info FILE)";
  }
  if (const std::string note = outlier_note(field::display_range(bare.field)); !note.empty()) bare.field.notes.push_back(note);
  bare.text += std::string("},\n") +
               (bare.field.times.size() > 1 || is_pattern(path) ? fmt::format("  \"time\": {{\"step\": {}}},\n", step) : "") +
               look.scene_members + "\n}\n";
  return bare;
}

FileSummary summarize_file(const std::string& path, const std::string& grid, int step) {
  FileSummary look;
  const auto bare = make_default_scene(path, grid, {}, step);
  if (!bare) return look;
  if (!bare->note.empty()) look.lines.push_back(bare->note);
  look.lines.insert(look.lines.end(), bare->field.notes.begin(), bare->field.notes.end());
  look.steps = list_time_steps(path, bare->field);
  if (is_pattern(path) && !std::ranges::is_sorted(look.steps.times))
    look.lines.push_back("the times that the files state do not rise in the order of the numbers in their names, in which they are shown");
  return look;
}

FileKind detect_file_kind(const std::string& path) { return look_into(path).kind; }

void adopt_loaded_data(const DefaultScene& bare, Scene& scene) {
  scene.entities.each<FieldSource>([&](Entity, FieldSource& source) {
    const auto adopt = [&](const std::string& grid, const field::AnyField& field) {
      if (field.get() != nullptr && source.file && is_same_file(source.file->path, bare.request.path) && source.file->grid == grid &&
          source.file->step == bare.request.step)
        source.loaded = source.rendered = field;
    };
    adopt(bare.request.grid, bare.field);
    adopt(bare.fibers_grid, bare.fibers);
    load_label_map(source);
  });
  const auto adopt_shape = [&](auto& source, const auto& loaded) {
    if (loaded == nullptr || !is_same_file(source.path, bare.request.path)) return;
    if (source.steps.series.empty() && source.steps.step != bare.request.step) return;
    source.loaded = loaded;
    request_step_times(source.steps, source.path);
  };
  scene.entities.each<MeshSource>([&](Entity, MeshSource& source) {
    if (source.placement == mesh::MeshTransform{}) adopt_shape(source, bare.mesh);
  });
  scene.entities.each<PointsSource>([&](Entity, PointsSource& source) { adopt_shape(source, bare.points); });
  scene.entities.each<CurvesSource>([&](Entity, CurvesSource& source) { adopt_shape(source, bare.curves); });
  for (const std::string& note : bare.field.notes) scene.notes.push_back(bare.request.path + ": " + note);
}

namespace {

/// Removes all source locations: the scene's text is generated, so that its line numbers mean nothing to the user.
void forget_all_lines(Scene& scene) {
  forget_lines<FieldSource>(scene);
  forget_lines<MeshSource>(scene);
  forget_lines<SurfaceMesh>(scene);
  forget_lines<Volume>(scene);
  forget_lines<Isosurface>(scene);
  forget_lines<StreamlineSet>(scene);
  forget_lines<CurvesSource>(scene);
  forget_lines<PointsSource>(scene);
}

/// Returns an Error if the largest magnitude is not within 1e-30 to 1e30, the limits of the numbers in a scene file.
Outcome check_size_of_values(const field::AnyField& field, const std::string& path) {
  const field::ScalarGrid* grid = field.scalar ? field.scalar->grid() : nullptr;
  if (grid == nullptr) return Done{};
  const DisplayRange& range = field::display_range(*grid);
  const double most = std::max(std::fabs(range.lo), std::fabs(range.hi));
  if (most == 0 || (most >= kMinSize && most <= kMaxSize)) return Done{};
  return Error{fmt::format("{}: its values go from {} to {}; sizes from 1e-30 to 1e30 were expected: scale the data", path,
                           format_readable(range.lo), format_readable(range.hi))};
}

}  // namespace

Result<Scene> scene_for_field(const field::AnyField& grid, const NamedColors& colors) {
  if (grid.get() == nullptr || !grid.get()->is_grid())
    return Error{"a formula does not say what of it is worth seeing; a grid was expected (sample_on_grid), or a scene"};
  CATENA_CHECK(check_size_of_values(grid, "field"));
  FieldOverride with{"field", {}, {}, grid};
  const std::string name = "\"field\"";
  const DefaultVisualization look = grid.scalar ? choose_default_visualization(name, *grid.scalar->grid(), {}, colors)
                                                : choose_default_visualization(name, *grid.vector->grid(), colors);
  if (look.is_label_map) with.in_memory_field.scalar = grid.scalar->grid()->with_interpolation(field::Interpolation::nearest);
  // `extra_fields` starts with a comma
  const std::string more = look.extra_fields.empty() ? look.extra_fields : look.extra_fields.substr(1);
  CATENA_TRY(Scene scene, parse_scene("{\"fields\": {" + more + "},\n" + look.scene_members + "}", "field", {with}));
  scene.notes.push_back("field " + look.note);
  if (const std::string note = outlier_note(field::display_range(grid)); !note.empty()) scene.notes.push_back("field: " + note);
  forget_all_lines(scene);
  CATENA_CHECK(resolve_rendered_field(scene, find_field(scene, "field"), {}));
  return scene;
}

Result<Scene> scene_for_file(const std::string& path, const std::string& grid, const NamedColors& colors, int step) {
  CATENA_TRY(const DefaultScene bare, make_default_scene(path, grid, colors, step));
  CATENA_CHECK(check_size_of_values(bare.field, path));
  CATENA_TRY(Scene scene, parse_scene(bare.text, path));
  if (!bare.note.empty()) scene.notes.push_back(path + ": " + bare.note);
  adopt_loaded_data(bare, scene);
  forget_all_lines(scene);
  if (bare.field.get() != nullptr) CATENA_CHECK(resolve_rendered_field(scene, find_field(scene, field_name(bare.field.get()->name())), {}));
  return scene;
}

}  // namespace catena::scene
