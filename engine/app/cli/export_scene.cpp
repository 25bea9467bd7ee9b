// SPDX-License-Identifier: MIT
#include "engine/app/cli/export_scene.h"

#include <fmt/core.h>

#include <cmath>

#include "engine/app/cli/command.h"
#include "engine/app/cli/field_sampler.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/base/console.h"
#include "engine/base/csv.h"
#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/geometry/mesh/isosurface.h"
#include "engine/io/formats.h"
#include "engine/io/mesh/write_mesh.h"
#include "engine/io/volume/units.h"
#include "engine/io/volume/write_field.h"
#include "engine/scene/prepare.h"
#include "engine/scene/streamlines.h"

namespace catena::app {

namespace {

using scene::Entity;

/// Returns the item with that index in a list of the scene.
template <class T>
Result<Entity> find_item(const scene::Scene& scene, int number, const std::string& list) {
  std::vector<Entity> items;
  scene.entities.each<T>([&](Entity e, const T&) { items.push_back(e); });
  if (number >= 0 && static_cast<std::size_t>(number) < items.size()) return items[static_cast<std::size_t>(number)];
  const std::string has = items.empty() ? "has no items" : fmt::format("has items 0 to {}", items.size() - 1);
  return Error{fmt::format("{}: there is no item {} in \"{}\"; the scene {}", scene.path, number, list, has)};
}

Outcome expect(const std::string& output, bool fits, const std::string& endings) {
  if (fits) return Done{};
  return Error{output + ": expected an output that ends in " + endings};
}

/// Returns a node that makes error messages refer to an option.
json::Node option_node(const std::string& option) {
  json::Node node;
  node.file = std::make_shared<const std::string>(option);
  return node;
}

void say(const std::string& output, const std::string& what) {
  fmt::print("{}: {}\n", sanitize_for_terminal(output), sanitize_for_terminal(what));
}

Outcome write_and_tell(const std::string& path, const mesh::MeshExport& surface) {
  CATENA_CHECK(mesh::write_mesh(path, surface));
  if (const std::string lost = mesh::describe_precision_loss(path, surface); !lost.empty()) print_scene_notes(path, {lost});
  return Done{};
}

Outcome export_isosurface(const SceneExport& options, scene::Scene& scene) {
  CATENA_CHECK(
      expect(options.output, io::find_writer(options.output, io::DataKind::mesh) != nullptr, io::writable_extensions(io::DataKind::mesh)));
  CATENA_TRY(const Entity item, find_item<scene::Isosurface>(scene, *options.isosurface, "isosurfaces"));
  const scene::Isosurface& surface = scene.entities.get<scene::Isosurface>(item);
  CATENA_TRY(const field::AnyField drawn, scene::resolve_rendered_field(scene, surface.field, surface.where));
  CATENA_CHECK(scene::check_level(*drawn.scalar, surface.level, surface.where));
  const auto& file = scene.entities.get<scene::FieldSource>(surface.field).file;
  const bool level_set = file && field::read_units(file->path, file->grid).is_level_set;
  const bool higher = options.outside == "higher" || (options.outside == "auto" && level_set);
  ProgressLine progress("export", 1);
  CATENA_TRY(mesh::Isosurface made,
             mesh::extract_isosurface(*drawn.scalar->grid(), surface.level, higher ? mesh::OutwardSide::higher : mesh::OutwardSide::lower,
                                      scene.path, [&](double done) { progress.update(done); }));
  mesh::MeshExport out{std::move(made.vertices), std::move(made.normals), std::move(made.triangles)};
  CATENA_CHECK(write_and_tell(options.output, out));
  say(options.output, fmt::format("{} triangles, {} points, level {}", out.triangles.size(), out.points.size(), to_text(surface.level)));
  return Done{};
}

Outcome export_mesh(const SceneExport& options, scene::Scene& scene) {
  CATENA_CHECK(
      expect(options.output, io::find_writer(options.output, io::DataKind::mesh) != nullptr, io::writable_extensions(io::DataKind::mesh)));
  CATENA_TRY(const mesh::MeshPtr mesh, scene::resolve_mesh(scene, options.mesh, option_node("--mesh")));
  mesh::MeshExport out{mesh->vertices(), {}, mesh->triangles()};
  for (std::size_t v = 0; v < out.points.size(); ++v) out.normals.push_back(mesh->vertex_normal(static_cast<std::uint32_t>(v)));
  CATENA_CHECK(write_and_tell(options.output, out));
  say(options.output, fmt::format("{} triangles, {} points", out.triangles.size(), out.points.size()));
  return Done{};
}

Outcome export_streamlines(const SceneExport& options, scene::Scene& scene) {
  const io::Format* format = io::find_writer(options.output, io::DataKind::curves);
  CATENA_CHECK(expect(options.output, format != nullptr, io::writable_extensions(io::DataKind::curves)));
  CATENA_TRY(const Entity item, find_item<scene::StreamlineSet>(scene, *options.streamlines, "streamlines"));
  const scene::StreamlineSet& set = scene.entities.get<scene::StreamlineSet>(item);
  CATENA_TRY(const field::AnyField field, scene::resolve_field(scene, set.field, set.where));
  CATENA_TRY(const std::vector<flow::CurvePtr> curves, scene::resolve_lines(scene, item));
  CATENA_TRY(OutputFile out, OutputFile::open(options.output));
  format->write_curves(out, curves, *field.vector);
  CATENA_CHECK(out.commit());
  say(options.output, fmt::format("{} line{}", curves.size(), curves.size() == 1 ? "" : "s"));
  return Done{};
}

/// Points of a square sampling grid in a plane within the field's domain at which the field has a value, and the triangles between them.
struct PlaneSamples {
  std::vector<Vec3> points;
  std::vector<mesh::Triangle> triangles;
};

Result<PlaneSamples> sample_plane(const std::string& output, const scene::Slice& slice, const field::AnyField& any, double spacing,
                                  std::size_t columns) {
  const field::Field& field = *any.get();
  const Vec3 n = direction(slice.normal);
  // the first grid axis is the projection of the world axis most parallel to the plane
  int minimum = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(n[a]) < std::fabs(n[minimum])) minimum = a;
  Vec3 axis(0.0);
  axis[minimum] = 1;
  const Vec3 u = direction(axis - n * n[minimum]), v = cross(n, u);
  double lo[2]{INFINITY, INFINITY}, hi[2]{-INFINITY, -INFINITY};
  for (int i = 0; i < 8; ++i) {
    const Vec3 d = field.corner(i) - slice.point;
    for (int k = 0; k < 2; ++k) {
      lo[k] = std::min(lo[k], dot(d, k == 0 ? u : v) / spacing);
      hi[k] = std::max(hi[k], dot(d, k == 0 ? u : v) / spacing);
    }
  }
  constexpr double kSlack = 1e-9;
  double count[2];
  for (int k = 0; k < 2; ++k) {
    lo[k] = std::ceil(lo[k] - kSlack);
    count[k] = std::max(0.0, std::floor(hi[k] + kSlack) - lo[k] + 1);
  }
  const double bytes = sizeof(Vec3) + 2 * sizeof(mesh::Triangle) + 4 + 8 * static_cast<double>(columns);
  CATENA_CHECK(
      check_memory_available(fmt::format("{}: {:.0f} x {:.0f} samples,", output, count[0], count[1]), count[0] * count[1] * bytes));
  PlaneSamples made;
  constexpr std::uint32_t kNone = 0xffffffff;
  if (count[0] * count[1] >= kNone)
    return Error{fmt::format("{}: {:.0f} x {:.0f} samples are too many; a larger --spacing was expected", output, count[0], count[1])};
  const auto nu = static_cast<std::size_t>(count[0]), nv = static_cast<std::size_t>(count[1]);
  std::vector<std::uint32_t> number(nu * nv, kNone);
  field::Cursor cursor;
  for (std::size_t j = 0; j < nv; ++j)
    for (std::size_t i = 0; i < nu; ++i) {
      const Vec3 p = slice.point + u * ((lo[0] + static_cast<double>(i)) * spacing) + v * ((lo[1] + static_cast<double>(j)) * spacing);
      const bool inside = any.scalar ? any.scalar->sample(p, cursor).inside : any.vector->sample(p, cursor).inside;
      // a formula has values everywhere: only those in its box are exported
      if (!inside || !field.index_box().contains(field.mapping().index_from_world(p), kSlack)) continue;
      number[j * nu + i] = static_cast<std::uint32_t>(made.points.size());
      made.points.push_back(p);
    }
  if (made.points.empty())
    return Error{output +
                 ": no sample of the slice lies within its field; a plane that intersects the field, or a smaller --spacing, was expected"};
  for (std::size_t j = 0; j + 1 < nv; ++j)
    for (std::size_t i = 0; i + 1 < nu; ++i) {
      const std::uint32_t a = number[j * nu + i], b = number[j * nu + i + 1], c = number[(j + 1) * nu + i + 1],
                          d = number[(j + 1) * nu + i];
      if (a == kNone || b == kNone || c == kNone || d == kNone) continue;
      made.triangles.push_back({a, b, c});
      made.triangles.push_back({a, c, d});
    }
  return made;
}

Outcome export_slice(const SceneExport& options, scene::Scene& scene) {
  const bool csv = has_extension(options.output, ".csv");
  CATENA_CHECK(expect(options.output, csv || has_extension(options.output, ".vtp"), ".csv or .vtp"));
  CATENA_TRY(const Entity item, find_item<scene::Slice>(scene, *options.slice, "slices"));
  const scene::Slice& slice = scene.entities.get<scene::Slice>(item);
  CATENA_TRY(const field::AnyField shown, scene::resolve_field(scene, slice.color_by.field, slice.where));
  // a formula is rendered from a grid, whose voxel size is the default spacing
  CATENA_TRY(const field::AnyField drawn, scene::resolve_rendered_field(scene, slice.color_by.field, slice.where));
  const double spacing = options.spacing > 0 ? options.spacing : drawn.get()->mapping().min_voxel_edge();
  CATENA_TRY(FieldSampler samples, FieldSampler::load(scene));
  CATENA_TRY(PlaneSamples plane, sample_plane(options.output, slice, shown, spacing, samples.column_count()));
  if (csv) {
    CATENA_TRY(OutputFile out, OutputFile::open(options.output));
    out.write("x,y,z" + samples.csv_header() + "\n");
    std::string row;
    for (const Vec3& p : plane.points) {
      row = fmt::format("{},{},{}", to_text(p.x), to_text(p.y), to_text(p.z));
      samples.append_csv_cells(row, p);
      out.write(row + "\n");
    }
    CATENA_CHECK(out.commit());
  } else {
    mesh::MeshExport out{plane.points, {}, plane.triangles, samples.sample_points(plane.points)};
    CATENA_CHECK(write_and_tell(options.output, out));
  }
  say(options.output, fmt::format("{} samples at a spacing of {}", plane.points.size(), to_text(spacing)));
  return Done{};
}

Outcome export_probe(const SceneExport& options, scene::Scene& scene) {
  CATENA_CHECK(expect(options.output, has_extension(options.output, ".csv") || options.output.starts_with("/dev/"), ".csv"));
  CATENA_TRY(const std::vector<ProbePathRow> path, read_probe_path(options.probe));
  CATENA_TRY(FieldSampler samples, FieldSampler::load(scene));
  CATENA_TRY(OutputFile out, OutputFile::open(options.output));
  out.write("t,x,y,z" + samples.csv_header() + "\n");
  std::string row;
  for (const ProbePathRow& at : path) {
    row = fmt::format("{},{},{},{}", to_text(at.t_s), to_text(at.position.x), to_text(at.position.y), to_text(at.position.z));
    samples.append_csv_cells(row, at.position);
    out.write(row + "\n");
  }
  CATENA_CHECK(out.commit());
  say(options.output, fmt::format("{} positions", path.size()));
  return Done{};
}

Outcome export_field(const SceneExport& options, scene::Scene& scene) {
  CATENA_CHECK(expect(options.output, io::find_writer(options.output, io::DataKind::volume) != nullptr,
                      io::writable_extensions(io::DataKind::volume)));
  const Entity entity = scene::find_field(scene, options.field);
  const json::Node where = option_node("--field");
  if (!entity) return scene::resolve_field(scene, options.field, where).error();  // the message lists the existing fields
  CATENA_TRY(const field::AnyField drawn, scene::resolve_rendered_field(scene, entity, where));
  const auto& file = scene.entities.get<scene::FieldSource>(entity).file;
  CATENA_CHECK(field::write_field(options.output, drawn, options.field, file ? field::read_units(file->path, file->grid) : field::Units{}));
  if (const std::string lost = field::lost_mask_note(options.output, drawn); !lost.empty()) print_scene_notes(options.output, {lost});
  say(options.output, options.field);
  return Done{};
}

}  // namespace

Outcome export_scene(const SceneExport& options) {
  CATENA_TRY(scene::Scene scene, open_scene(options.source, {}, {}, options.grid, options.step));
  CATENA_CHECK(go_to_step(scene, options.step, fmt::format("--step {}", options.step)));
  IoConflictChecker files(scene);
  files.add_input(options.source);
  files.add_input(options.probe);
  files.add_output("-o", options.output);
  CATENA_CHECK(files.check());
  // items that are bound to a widget move to its position
  const auto driven = scene::propagate_widgets(scene);
  if (!driven) return driven.error();
  const auto part = options.isosurface       ? export_isosurface
                    : options.slice          ? export_slice
                    : options.streamlines    ? export_streamlines
                    : !options.mesh.empty()  ? export_mesh
                    : !options.probe.empty() ? export_probe
                                             : export_field;
  CATENA_CHECK(part(options, scene));
  print_scene_notes(scene);
  return Done{};
}

}  // namespace catena::app
