// SPDX-License-Identifier: MIT
#include "engine/app/cli/info_json.h"

#include <fmt/core.h>

#include <cmath>

#include "engine/app/cli/command.h"
#include "engine/app/cli/json_writer.h"
#include "engine/app/cli/plugins.h"
#include "engine/app/haptics/log_replay.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/curves/load_points.h"
#include "engine/io/formats.h"
#include "engine/io/volume/units.h"
#include "engine/scene/derived_fields.h"
#include "engine/scene/drawable.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/units.h"
#include "engine/scene/widgets.h"
#include "haptics/build/build_program.h"
#include "haptics/device/device_settings.h"
#include "haptics/servo/log/reader.h"

namespace catena::app {

namespace {

namespace log = haptics::log;

std::string json_of_grid(const std::string& path, const field::GridInfo& g) {
  const Mat3& j = g.mapping.world_from_index_linear;
  const Vec3 lowest(g.first_index.x, g.first_index.y, g.first_index.z);
  const Vec3 size(static_cast<double>(g.size.x), static_cast<double>(g.size.y), static_cast<double>(g.size.z));
  const field::Units units = field::read_units(path, g.name);
  JsonObject out;
  out.add("name", g.name).add("type", g.type).add("usable", g.is_usable).add("vector", g.is_vector);
  if (!g.series_number.empty()) out.add("number", g.series_number);
  if (g.image_count > 0) out.add("images", std::uint64_t{static_cast<std::uint32_t>(g.image_count)});
  out.add("size", size).add("lowest", lowest).add_raw("axes", json_array({to_json_value(j[0]), to_json_value(j[1]), to_json_value(j[2])}));
  out.add("origin", g.mapping.origin)
      .add_if_not_empty("unit", units.value)
      .add_if_not_empty("length_unit", units.length)
      .add("patient", units.is_patient_space);
  out.add("world_box", field::world_bounds(g.mapping, {lowest, lowest + size - Vec3(1.0)}));
  const auto size_of = [](const field::Size3& n) {
    return to_json_value(Vec3(static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)));
  };
  std::vector<std::string> levels;
  for (const field::LevelInfo& level : g.levels)
    levels.push_back(JsonObject().add_raw("size", size_of(level.size)).add_raw("chunk", size_of(level.chunk)).text());
  if (levels.empty())
    out.add("active_" + std::string(field::to_string(g.element_kind)), g.stats.active_voxels);
  else
    out.add_raw("levels", json_array(levels));
  if (g.window.size() == 2) out.add_raw("window", json_array({to_json_value(g.window[0]), to_json_value(g.window[1])}));
  if (g.color >= 0) out.add("color", fmt::format("#{:06x}", g.color));
  if (g.range_level > 0) out.add("range_level", std::uint64_t{static_cast<std::uint32_t>(g.range_level)});
  if (g.is_usable && g.range_level >= 0) {
    out.add_raw("range", json_array({to_json_value(g.stats.min), to_json_value(g.stats.max)}));
    out.add_raw("display_range", json_array({to_json_value(g.display_range.lo), to_json_value(g.display_range.hi)}));
    if (g.is_vector)
      out.add_raw("component_range", json_array({to_json_value(g.stats.component_min), to_json_value(g.stats.component_max)}));
    out.add("not_finite", g.stats.nan_count);
  }
  return out.add("bytes", std::uint64_t{g.bytes}).text();
}

/// Adds "steps"; "times" and "time_unit" if all times are known; "files" for a pattern.
void add_steps(JsonObject& out, const std::string& path, const scene::TimeSteps& steps) {
  std::vector<std::string> times, files;
  if (scene::is_pattern(path))
    for (const std::string& one : scene::expand_pattern(path)) files.push_back(to_json_value(one));
  for (const double time : steps.times) times.push_back(to_json_value(time));
  out.add("steps", std::uint64_t{static_cast<std::uint32_t>(steps.count)});
  if (static_cast<int>(times.size()) == steps.count) out.add_raw("times", json_array(times)).add_if_not_empty("time_unit", steps.time_unit);
  if (!files.empty()) out.add_raw("files", json_array(files));
}

Result<std::string> json_of_file(const std::string& path, const std::string& grid, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const std::vector<field::GridInfo> grids, read_grid_infos(at.path, grid, at.step));
  std::vector<std::string> described, notes;
  for (const field::GridInfo& g : grids) described.push_back(json_of_grid(at.path, g));
  const scene::FileSummary summary = io::needs_layout(path) ? scene::FileSummary{} : scene::summarize_file(path, grid, step);
  if (summary.steps.count > 0) CATENA_CHECK(check_step(step, summary.steps.count - 1, fmt::format("--step {}", step), path));
  for (const std::string& line : summary.lines) notes.push_back(to_json_value(line));
  JsonObject out;
  out.add("kind", "data").add("file", path).add_raw("grids", json_array(described)).add_raw("notes", json_array(notes));
  add_steps(out, path, summary.steps);
  return out.text();
}

void add_mesh(JsonObject& out, const mesh::TriangleMesh& mesh) {
  const auto count = [&](const char* key, std::size_t n) { out.add(key, std::uint64_t{n}); };
  count("triangles", mesh.triangles().size());
  count("dropped", mesh.dropped_triangles());
  count("vertices", mesh.vertices().size());
  out.add_raw("world_box", json_array({to_json_value(mesh.min_corner()), to_json_value(mesh.max_corner())}))
      .add("length", mesh.domain_length());
  count("open_edges", mesh.open_edges());
  count("non_manifold_edges", mesh.non_manifold_edges());
  count("misoriented_edges", mesh.misoriented_edges());
  count("bytes", mesh.bytes());
}

Result<std::string> json_of_mesh(const std::string& path, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  CATENA_TRY(const mesh::MeshPtr mesh, mesh::load_mesh(at.path, {}, at.step));
  JsonObject out;
  out.add("kind", "mesh").add("file", path);
  add_mesh(out, *mesh);
  add_steps(out, path, scene::list_time_steps(path, {}));
  return out.text();
}

template <class T>
std::vector<scene::Entity> all_of(const scene::Scene& scene) {
  std::vector<scene::Entity> items;
  scene.entities.each<T>([&](scene::Entity e, const T&) { items.push_back(e); });
  return items;
}

Result<std::string> json_of_scene(const std::string& path) {
  CATENA_TRY(scene::Scene scene, open_scene(path));
  const auto name_of = [&](scene::Entity e) { return scene.entities.get<scene::Name>(e).value; };
  std::vector<std::string> fields, meshes, links, widgets;
  for (const scene::Entity e : all_of<scene::FieldSource>(scene)) {
    CATENA_TRY(const field::AnyField any, scene::resolve_field(scene, e, scene.entities.get<scene::FieldSource>(e).where));
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(e);
    JsonObject field;
    field.add("name", name_of(e)).add("source", source.file ? source.file->path : scene::source_text(source));
    if (source.file) field.add_if_not_empty("grid", source.file->grid);
    field.add("vector", any.vector != nullptr).add("length", any.get()->domain_length());
    if (any.scalar) field.add_raw("range", json_array({to_json_value(any.scalar->min_value()), to_json_value(any.scalar->max_value())}));
    field.add_if_not_empty("unit", scene::unit_of(scene, e)).add("bytes", std::uint64_t{any.get()->bytes()});
    fields.push_back(field.text());
  }
  for (const scene::Entity e : all_of<scene::MeshSource>(scene)) {
    CATENA_TRY(const mesh::MeshPtr mesh, scene::resolve_mesh(scene, e));
    JsonObject out;
    out.add("name", name_of(e)).add("source", scene.entities.get<scene::MeshSource>(e).path);
    add_mesh(out, *mesh);
    meshes.push_back(out.text());
  }
  // the same checks as `info` without --json: the chain can be built, the device's keys are valid
  CATENA_TRY(const std::shared_ptr<const haptics::HapticProgram> program, haptics::build_program(scene));
  print_scene_notes(scene);
  if (scene.device) CATENA_CHECK(haptics::read_device_settings(*scene.device, scene.path));
  scene.entities.each<scene::Link>(
      [&](scene::Entity, const scene::Link& link) { links.push_back(JsonObject().add("name", link.name).add("type", link.type).text()); });
  for (const scene::Entity e : all_of<scene::Widget>(scene)) {
    CATENA_TRY(const widget::Spec spec, scene::resolve_widget(scene, e));
    widgets.push_back(
        JsonObject().add("name", name_of(e)).add("type", std::string(scene::to_string(spec.kind))).add("at", spec.pose.points[0]).text());
  }
  JsonObject coupling, drawn, out;
  coupling.add("stiffness_n_per_m", program->coupling.stiffness_n_per_m).add("damping_ns_per_m", program->coupling.damping_ns_per_m);
  const bool conservative = program->coupling.force == CouplingForce::conservative;
  coupling.add("max_force_n", program->coupling.max_force_n).add("force", conservative ? "conservative" : "paper");
  for (const scene::Drawable& kind : scene::drawables())
    drawn.add(std::string(kind.name), std::uint64_t{kind.items(scene.entities).size()});
  out.add("kind", "scene")
      .add("file", path)
      .add_raw("fields", json_array(fields))
      .add_if_not_empty("length_unit", scene::length_unit(scene));
  out.add_raw("meshes", json_array(meshes))
      .add_raw("links", json_array(links))
      .add_raw("widgets", json_array(widgets))
      .add_raw("coupling", coupling.text());
  out.add_raw("metres_per_unit", scene.workspace.is_explicit ? to_json_value(scene.workspace.meters_per_unit) : "null");
  return out.add_raw("drawn", drawn.text()).text();
}

Result<std::string> json_of_log(const std::string& path) {
  CATENA_TRY(log::LogReader reader, log::LogReader::open(path));
  const log::LogHeader& header = reader.header();
  std::vector<std::string> fields, plugins, gaps;
  for (const std::string& field : header.fields) fields.push_back(to_json_value(field));
  for (const log::LogPlugin& plugin : header.plugins) plugins.push_back(to_json_value(plugin_label(plugin)));
  std::uint64_t ticks = 0;
  double first_s = 0, last_s = 0;
  for (log::LogEvent event = reader.next(); event != log::LogEvent::done; event = reader.next()) {
    if (event == log::LogEvent::gap) gaps.push_back(to_json_value(reader.gap().description()));
    if (event != log::LogEvent::tick) continue;
    // ticks without a device have no valid time
    const double t_s = reader.tick().input.t_s;
    if (ticks++ == 0) first_s = t_s;
    if (std::isfinite(t_s)) last_s = t_s;
  }
  JsonObject out;
  out.add("kind", "recording").add("file", path).add("scene", header.scene_path).add("about", header.about);
  out.add_raw("fields", json_array(fields)).add_raw("plugins", json_array(plugins)).add("version", header.catena_version);
  out.add("started_unix_s", static_cast<std::int64_t>(header.started_unix_ns / 1'000'000'000));
  out.add("device", header.device).add("rate_hz", header.rate_hz).add("ticks", ticks).add("seconds", last_s - first_s);
  return out.add_raw("gaps", json_array(gaps)).add("ending", std::string(reader.end_summary())).text();
}

/// Returns the members that curve sets and point sets have in common.
template <class Set>
JsonObject json_of_set(const std::string& kind, const std::string& path, const Set& set) {
  std::vector<std::string> values;
  for (const curves::PointValues& one : set.values) values.push_back(to_json_value(one.name));
  JsonObject out;
  out.add("kind", kind).add("file", path).add("points", std::uint64_t{set.points.size()});
  add_steps(out, path, scene::list_time_steps(path, {}));
  return out.add_raw("world_box", json_array({to_json_value(set.min_corner), to_json_value(set.max_corner)}))
      .add_raw("values", json_array(values));
}

Result<std::string> json_of_data(const std::string& path, const std::string& grid, int step) {
  const field::LoadRequest at = scene::request_at(path, step);
  switch (scene::detect_file_kind(path)) {
    case scene::FileKind::mesh:
      return json_of_mesh(path, step);
    case scene::FileKind::curves: {
      CATENA_TRY(const curves::CurveSetPtr set, curves::load_curves(at.path, at.step));
      return json_of_set("curves", path, *set).add("lines", std::uint64_t{set->line_count()}).text();
    }
    case scene::FileKind::points: {
      CATENA_TRY(const curves::PointSetPtr set, curves::load_points(at.path, at.step));
      return json_of_set("points", path, *set).add("spacing", set->median_spacing).text();
    }
    case scene::FileKind::field:
      break;
  }
  return json_of_file(path, grid, step);
}

}  // namespace

Outcome print_json_info(const std::string& path, const std::string& grid, int step) {
  CATENA_TRY(const std::string text, is_log_file(path)     ? json_of_log(path)
                                     : is_scene_file(path) ? json_of_scene(path)
                                                           : json_of_data(path, grid, step));
  fmt::print("{}\n", text);
  return Done{};
}

}  // namespace catena::app
