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
#include "engine/field/bricks/paged_grid.h"
#include "engine/field/field_display_range.h"
#include "engine/io/formats.h"
#include "engine/io/stores/load_store.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/default_channels.h"
#include "engine/scene/default_points.h"
#include "engine/scene/default_visualization.h"
#include "engine/scene/labels.h"
#include "engine/scene/merge.h"
#include "engine/scene/readers.h"
#include "engine/scene/time_steps.h"

namespace catena::scene {
namespace {

/// A data file to be shown; its grids are described on first use, and the description is cached.
struct DataFile {
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

DataFile inspect_file(const std::string& name, int step = 0) {
  const field::LoadRequest request = request_at(name, step);
  DataFile file{request.path, request.step, !is_pattern(request.path)};
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
Result<field::AnyField> load_best(DataFile& file, field::LoadRequest& request) {
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

/// Returns a valid field name of a scene file that is as close to the grid's name as possible.
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

/// Returns scene members for the other grids of the file. They are loaded on demand only.
std::string other_fields(DataFile& data_file, const std::string& shown, const std::string& file, const std::string& main_name) {
  if (shown.empty() || !data_file.grids()) return {};
  std::vector<std::string> names{main_name};
  std::string text;
  for (const field::GridInfo& grid : *data_file.grids()) {
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

/// The last step, if the field is uniform at the step of `result`, as a simulation often is when it starts: the colors are chosen from it.
std::optional<LaterStep> later_step(const std::string& path, const DefaultScene& default_scene) {
  const auto is_uniform = [](const field::AnyField& field) {
    const DisplayRange range = field::display_range(field);
    return !(range.lo < range.hi);
  };
  if (!is_uniform(default_scene.field)) return std::nullopt;
  const int last = list_time_steps(path, default_scene.field).count - 1;
  field::LoadRequest request = default_scene.request;
  request.path = path;
  if (last < 1) return std::nullopt;
  const auto field = field::load(request_at(request, last));
  if (!field || is_uniform(*field) || (field->scalar == nullptr) != (default_scene.field.scalar == nullptr)) return std::nullopt;
  return LaterStep{*field, last};
}

/// Adds the fibers of a file that also holds a body, inside the body's translucent shell.
void show_fibres(DataFile& file, DefaultScene& default_scene, DefaultVisualization& visualization) {
  const auto& grids = file.grids();
  if (visualization.shell_members.empty() || default_scene.request.grid.empty() || !grids) return;
  for (const field::GridInfo& grid : *grids) {
    if (!grid.is_usable || !grid.is_vector || grid.stats.active_voxels == 0 || grid.name.empty()) continue;
    field::LoadRequest request = default_scene.request;
    request.grid = grid.name;
    const auto loaded = field::load(request);
    if (!loaded || !loaded->vector) continue;
    const DefaultVisualization fibres =
        choose_default_visualization(json::serialize_string(field_name(grid.name)), *loaded->vector->grid(), {});
    if (!fibres.is_fibers) continue;
    visualization.scene_members = visualization.shell_members + ",\n" + fibres.scene_members;
    visualization.note += "; " + in_quotes(grid.name) + " " + fibres.note;
    default_scene.more_grids.emplace_back(grid.name, *loaded);
    return;
  }
}

/// Shows the channels of a microscope's image, or only the requested grid if it is one with a color in the file. Returns whether there are
/// several, or this one.
bool show_channels(DataFile& file, DefaultScene& default_scene, DefaultVisualization& visualization, bool only_requested) {
  if (default_scene.request.grid.empty() || !default_scene.field.scalar || !file.grids()) return false;
  std::vector<const field::GridInfo*> found = find_channels(*file.grids());
  if (only_requested)
    std::erase_if(found, [&](const field::GridInfo* grid) { return grid->name != default_scene.request.grid || grid->color < 0; });
  std::erase_if(found, [&](const field::GridInfo* grid) { return field::read_units(file.path, grid->name).is_label_map; });
  std::vector<Channel> channels;
  for (const field::GridInfo* grid : found) {
    if (channels.size() == kMaxChannels) break;
    const bool is_first = grid->name == default_scene.request.grid;
    field::LoadRequest request = default_scene.request;
    request.grid = grid->name;
    const auto loaded = is_first ? Result<field::AnyField>(default_scene.field) : field::load(request);
    if (!loaded || !loaded->scalar) continue;
    channels.push_back({grid, json::serialize_string(field_name(grid->name)), *loaded});
    if (!is_first) default_scene.more_grids.emplace_back(grid->name, *loaded);
  }
  const auto has_name = [&](const Channel& channel) { return std::ranges::count(channels, channel.field_name, &Channel::field_name) == 1; };
  if (channels.size() < (only_requested ? 1 : 2) || !std::ranges::all_of(channels, has_name)) return false;
  visualization = {};
  visualization.scene_members = channel_volumes(channels);
  visualization.note = channels_note(channels, found.size());
  return true;
}

/// Shows the labels of a map by groups of equal opacity.
Outcome group_by_opacity(const std::string& path, const std::string& name, const field::ScalarGrid& grid, const FileColors& colors,
                         DefaultVisualization& visualization) {
  LabelTable table;
  if (const std::string file = find_label_table(path); !file.empty()) {
    CATENA_TRY(table, read_label_table(file));
  }
  const auto counts = field::count_labels(grid);
  CATENA_ASSERT(counts);
  auto groups = group_labels(*counts, table, colors.label_opacities);
  if (!groups) return Error{one_line(path + ": " + groups.error().message)};
  show_label_groups(name, *groups, visualization);
  return Done{};
}

std::string curves_note(const curves::CurveSet& set) {
  return fmt::format("{} curve{}, coloured by direction: red for x, green for y, blue for z{}{}", set.line_count(),
                     set.line_count() == 1 ? "" : "s", set.note.empty() ? "" : "; ", set.note);
}

void remove_locations(json::Node& node) {
  node.line = 0;
  for (json::Node& item : node.items) remove_locations(item);
  for (auto& [key, member] : node.members) remove_locations(member);
}

template <class T>
void remove_locations(Scene& scene) {
  scene.entities.each<T>([](Entity, T& part) { remove_locations(part.where); });
}

/// Loads one data file and writes its default scene.
Result<DefaultScene> scene_of_one_file(const std::string& path, const std::string& grid, const FileColors& colors, int step) {
  DefaultScene result;
  result.scene_path = path + ".json";
  const std::string file = json::serialize_string(std::filesystem::path(path).filename().string());
  DataFile data_file = inspect_file(path, step);
  result.request.path = data_file.path;
  result.request.step = data_file.step;
  if (!data_file.found) return Error{one_line(path + ": there is no such file")};
  if (data_file.kind != FileKind::field && colors.makes_volume())
    return Error{one_line(path + ": opacities are those of a volume, which the file does not have; a scalar field was expected")};
  if (data_file.kind == FileKind::mesh) {
    if (!colors.is_default()) return Error{one_line(path + ": a mesh has no values; a data file was expected with a colour map")};
    CATENA_TRY(result.mesh, mesh::load_mesh(data_file.path, {}, data_file.step));
    result.text = "{\n  \"meshes\": [{\"name\": \"mesh\", \"file\": " + file + "}]\n}\n";
    return result;
  }
  if (data_file.kind == FileKind::curves) {
    if (!colors.is_default())
      return Error{one_line(path + ": curves are coloured by direction; a data file was expected with a colour map")};
    CATENA_TRY(result.curves, curves::load_curves(data_file.path, data_file.step));
    result.note = curves_note(*result.curves);
    result.text = "{\n  \"curves\": [{\"name\": \"curves\", \"file\": " + file + "}]\n}\n";
    return result;
  }
  if (data_file.kind == FileKind::points) {
    CATENA_TRY(result.points, curves::load_points(data_file.path, data_file.step));
    CATENA_TRY(const std::string parts, default_points_members(*result.points, file, colors.named, result.note));
    result.text = "{\n" + parts + "\n}\n";
    return result;
  }
  if (io::needs_layout(path))
    return Error{one_line(path + ": a .raw file does not state its shape; a scene file with the shape was expected")};
  result.request.grid = grid;
  CATENA_TRY(result.field, load_best(data_file, result.request));
  if (colors.makes_volume() && !result.field.scalar)
    return Error{one_line(path + ": opacities are those of a volume, but the field is a vector field; a scalar field was expected")};
  const std::string name = json::serialize_string(field_name(result.field.get()->name()));
  const auto later = later_step(path, result);
  const field::AnyField& shown_field = later ? later->field : result.field;
  DefaultVisualization visualization =
      shown_field.scalar ? choose_default_visualization(name, *shown_field.scalar->grid(),
                                                        field::read_units(result.request.path, result.request.grid), colors)
                         : choose_default_visualization(name, *shown_field.vector->grid(), colors.named);
  if (later) visualization.note += fmt::format(" (at step {}; at step {} all values are equal)", later->step, step);
  bool has_channels = false;
  if (grid.empty() && colors.is_default()) show_fibres(data_file, result, visualization);
  if (colors.is_default() && !visualization.is_label_map) has_channels = show_channels(data_file, result, visualization, !grid.empty());
  result.note = (has_channels ? "" : name + " ") + visualization.note;
  result.text = "{\n  \"fields\": {" + name + ": {\"file\": " + file;
  if (!result.request.grid.empty()) result.text += ", \"grid\": " + json::serialize_string(result.request.grid);
  if (!visualization.is_label_map && !colors.label_opacities.empty())
    return Error{one_line(path + ": opacities of labels are those of a label map; a map of whole numbers was expected")};
  if (visualization.is_label_map) {
    result.request.interpolation = field::Interpolation::nearest;
    result.field = field::with_interpolation(std::move(result.field), result.request.interpolation);
    result.text += ", \"interpolation\": \"nearest\"";
    if (const std::string table = find_label_table(path); !table.empty()) {
      const std::string table_name = std::filesystem::path(table).filename().string();
      result.text += ", \"labels\": {\"file\": " + json::serialize_string(table_name) + "}";
      result.note += "; names from " + sanitize_for_terminal(table_name);
    }
    if (!colors.label_opacities.empty()) CATENA_CHECK(group_by_opacity(path, name, *result.field.scalar->grid(), colors, visualization));
  }
  if (visualization.ignore_mask) {
    result.text += ", \"valid\": null";
    result.request.mask_grid.reset();
    CATENA_TRY(result.field, field::load(result.request));
  }
  result.text += "}" + visualization.extra_fields;
  const std::string others = other_fields(data_file, result.request.grid, file, name);
  result.text += others;
  if (has_channels)
    result.note += "; --grid NAME shows one alone";
  else if (grid.empty() && !others.empty())
    result.note += "; the file has more fields: --grid NAME shows another one (catena info FILE lists them)";
  if (const std::string note = outlier_note(field::display_range(result.field)); !note.empty()) result.field.notes.push_back(note);
  result.text += std::string("},\n") +
                 (result.field.times.size() > 1 || is_pattern(path) ? fmt::format("  \"time\": {{\"step\": {}}},\n", step) : "") +
                 visualization.scene_members + "\n}\n";
  return result;
}

/// States the stretch that was requested or, for a field whose axes differ so much that they can hardly have one unit, a chosen one.
Outcome add_stretch(const FileColors& colors, DefaultScene& result) {
  const bool is_chosen = !colors.stretch && result.field.get() != nullptr;
  const Vec3 stretch = is_chosen ? choose_stretch(*result.field.get()) : colors.stretch.value_or(Vec3(1.0));
  if (stretch == Vec3(1.0)) return Done{};
  CATENA_TRY(result.text, json::set_value(result.text, result.scene_path, "/stretch", to_json(stretch)));
  CATENA_TRY(result.text, json::set_value(result.text, result.scene_path, "/axes", "true"));
  if (is_chosen)
    result.note +=
        fmt::format("; the axes have very different scales: the image is stretched by {:g}, {:g}, {:g} along x, y, z (--stretch)",
                    stretch.x, stretch.y, stretch.z);
  return Done{};
}

/// Lights surfaces and lines. Volumes, slices, and what is read against a scalar bar are read by colors that light would change.
Outcome add_light(DefaultScene& result) {
  for (const char* key : {"\"volumes\"", "\"slices\"", "\"scalar_bars\""})
    if (result.text.find(key) != std::string::npos) return Done{};
  CATENA_TRY(result.text, json::set_value(result.text, result.scene_path, "/look", "\"lit\""));
  return Done{};
}

/// Loads one data file and writes its default scene, with its stretch.
Result<DefaultScene> stretched_scene_of_one_file(const std::string& path, const std::string& grid, const FileColors& colors, int step) {
  CATENA_TRY(DefaultScene result, scene_of_one_file(path, grid, colors, step));
  CATENA_CHECK(add_stretch(colors, result));
  CATENA_CHECK(add_light(result));
  return result;
}

}  // namespace

Vec3 choose_stretch(const field::Field& field) {
  // a voxel kOutlying times as long as another one along an axis that is also kNeedle times as long, or as short, as the box
  constexpr double kOutlying = 20, kNeedle = 8, kExtent = 0.5;
  const Bounds box = field.world_bounds();
  const Vec3 size = box.hi - box.lo;
  Vec3 edge(0.0);  // of the voxels' bounds
  for (int column = 0; column < 3; ++column)
    for (int axis = 0; axis < 3; ++axis) edge[axis] += std::fabs(field.mapping().world_from_index_linear[column][axis]);
  Vec3 stretch(1.0);
  if (!field.is_grid() || !(std::max({edge.x, edge.y, edge.z}) > kOutlying * std::min({edge.x, edge.y, edge.z}))) return stretch;
  std::array<double, 3> sizes{size.x, size.y, size.z};
  std::ranges::sort(sizes);
  if (!(sizes[0] > 0)) return stretch;
  for (int axis = 0; axis < 3; ++axis) {
    const double ratio = size[axis] / sizes[1];
    if (ratio < kNeedle && ratio > 1 / kNeedle) continue;
    const double factor = kExtent / ratio, decade = std::pow(10, std::floor(std::log10(factor)));
    stretch[axis] = decade * (factor >= 5 * decade ? 5 : factor >= 2 * decade ? 2 : 1);
  }
  return stretch;
}

Result<DefaultScene> make_default_scene(const std::string& path, const std::string& grid, const FileColors& colors, int step) {
  if (colors.overlay.empty()) return stretched_scene_of_one_file(path, grid, colors, step);
  FileColors below, above = colors;
  below.overlay = colors.overlay;
  above.overlay.clear();
  above.is_overlay = true;
  below.stretch = colors.stretch;
  CATENA_TRY(DefaultScene result, stretched_scene_of_one_file(path, grid, below, step));
  CATENA_TRY(const DefaultScene overlay, scene_of_one_file(colors.overlay, {}, above, 0));
  CATENA_TRY(const MergedScene merged, merge_scene(result.text, result.scene_path, overlay.text, overlay.scene_path));
  for (const Document::Edit& edit : merged.edits)
    if (edit.value) {
      CATENA_TRY(result.text, json::set_value(result.text, result.scene_path, edit.pointer, *edit.value));
    }
  result.note += "; " + sanitize_for_terminal(std::filesystem::path(colors.overlay).filename().string()) + ": " + overlay.note;
  return result;
}

FileSummary summarize_file(const std::string& path, const std::string& grid, int step) {
  FileSummary summary;
  const field::LoadRequest request = request_at(path, step);
  const std::string& file = request.path;
  if (const io::Format* format = io::find_reader(file, io::DataKind::volume);
      format != nullptr && (format->volume.reads_parts || (format->volume.is_array && field::is_read_in_bricks(request)))) {
    if (format->volume.notes != nullptr) summary.lines = format->volume.notes(file);
    summary.steps = list_time_steps(path, {});
    return summary;
  }
  const auto default_scene = make_default_scene(path, grid, {}, step);
  if (!default_scene) return summary;
  if (!default_scene->note.empty()) summary.lines.push_back(default_scene->note);
  summary.lines.insert(summary.lines.end(), default_scene->field.notes.begin(), default_scene->field.notes.end());
  summary.steps = list_time_steps(path, default_scene->field);
  if (is_pattern(path) && !std::ranges::is_sorted(summary.steps.times))
    summary.lines.push_back("the times in the files do not increase with the numbers in the file names; the steps follow the file names");
  return summary;
}

FileKind detect_file_kind(const std::string& path) { return inspect_file(path).kind; }

void adopt_loaded_data(const DefaultScene& default_scene, Scene& scene) {
  scene.entities.each<FieldSource>([&](Entity, FieldSource& source) {
    const auto adopt = [&](const std::string& grid, const field::AnyField& field) {
      if (field.get() != nullptr && source.file && is_same_file(source.file->path, default_scene.request.path) &&
          source.file->grid == grid && source.file->step == default_scene.request.step)
        source.loaded = source.rendered = field;
    };
    adopt(default_scene.request.grid, default_scene.field);
    for (const auto& [grid, field] : default_scene.more_grids) adopt(grid, field);
    load_label_map(source);
  });
  const auto adopt_shape = [&](auto& source, const auto& loaded) {
    if (loaded == nullptr || !is_same_file(source.path, default_scene.request.path)) return;
    if (source.steps.series.empty() && source.steps.step != default_scene.request.step) return;
    source.loaded = loaded;
    request_step_times(source.steps, source.path);
  };
  scene.entities.each<MeshSource>([&](Entity, MeshSource& source) {
    if (source.placement == mesh::MeshTransform{}) adopt_shape(source, default_scene.mesh);
  });
  scene.entities.each<PointsSource>([&](Entity, PointsSource& source) { adopt_shape(source, default_scene.points); });
  scene.entities.each<CurvesSource>([&](Entity, CurvesSource& source) { adopt_shape(source, default_scene.curves); });
  for (const std::string& note : default_scene.field.notes) scene.notes.push_back(default_scene.request.path + ": " + note);
}

namespace {

/// Removes all source locations: the scene's text is generated, so that its line numbers mean nothing to the user.
void remove_all_locations(Scene& scene) {
  remove_locations<FieldSource>(scene);
  remove_locations<MeshSource>(scene);
  remove_locations<SurfaceMesh>(scene);
  remove_locations<Volume>(scene);
  remove_locations<Isosurface>(scene);
  remove_locations<StreamlineSet>(scene);
  remove_locations<CurvesSource>(scene);
  remove_locations<PointsSource>(scene);
}

/// Returns an Error if the largest magnitude is not within 1e-30 to 1e30, the limits of the numbers in a scene file.
Outcome check_size_of_values(const field::AnyField& field, const std::string& path) {
  const field::ScalarGrid* grid = field.scalar ? field.scalar->grid() : nullptr;
  if (grid == nullptr) return Done{};
  const DisplayRange& range = field::display_range(*grid);
  const double max_magnitude = std::max(std::fabs(range.lo), std::fabs(range.hi));
  if (max_magnitude == 0 || (max_magnitude >= kMinSize && max_magnitude <= kMaxSize)) return Done{};
  return Error{fmt::format("{}: the values range from {} to {}; magnitudes from 1e-30 to 1e30 were expected: scale the data", path,
                           format_readable(range.lo), format_readable(range.hi))};
}

}  // namespace

Result<Scene> scene_for_field(const field::AnyField& grid, const FileColors& colors) {
  if (grid.get() == nullptr || !grid.get()->is_grid())
    return Error{"a formula has no default visualization; a grid (sample_on_grid) or a scene was expected"};
  CATENA_CHECK(check_size_of_values(grid, "field"));
  FieldOverride with{"field", {}, {}, grid};
  const std::string name = "\"field\"";
  const DefaultVisualization visualization = grid.scalar ? choose_default_visualization(name, *grid.scalar->grid(), {}, colors)
                                                         : choose_default_visualization(name, *grid.vector->grid(), colors.named);
  if (visualization.is_label_map) with.in_memory_field = field::with_interpolation(grid, field::Interpolation::nearest);
  // `extra_fields` starts with a comma
  const std::string extra_fields = visualization.extra_fields.empty() ? visualization.extra_fields : visualization.extra_fields.substr(1);
  CATENA_TRY(Scene scene, parse_scene("{\"fields\": {" + extra_fields + "},\n" + visualization.scene_members + "}", "field", {with}));
  scene.notes.push_back("field " + visualization.note);
  if (const std::string note = outlier_note(field::display_range(grid)); !note.empty()) scene.notes.push_back("field: " + note);
  remove_all_locations(scene);
  CATENA_CHECK(resolve_rendered_field(scene, find_field(scene, "field"), {}));
  return scene;
}

Result<Scene> scene_for_file(const std::string& path, const std::string& grid, const FileColors& colors, int step) {
  CATENA_TRY(const DefaultScene default_scene, make_default_scene(path, grid, colors, step));
  CATENA_CHECK(check_size_of_values(default_scene.field, path));
  CATENA_TRY(Scene scene, parse_scene(default_scene.text, path));
  if (!default_scene.note.empty()) scene.notes.push_back(path + ": " + default_scene.note);
  adopt_loaded_data(default_scene, scene);
  remove_all_locations(scene);
  if (default_scene.field.get() != nullptr)
    CATENA_CHECK(resolve_rendered_field(scene, find_field(scene, field_name(default_scene.field.get()->name())), {}));
  return scene;
}

}  // namespace catena::scene
