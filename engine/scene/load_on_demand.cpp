// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "engine/base/numbers.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/io/field_cache.h"
#include "engine/io/volume/units.h"
#include "engine/scene/auto_transfer.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/derived_fields.h"
#include "engine/scene/labels.h"
#include "engine/scene/reader_bindings.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/vortex_core_curves.h"

namespace catena::scene {
namespace {

constexpr double kMaxDrawn = 1e30;       ///< world coordinates: the limit that a scene file also has
constexpr std::size_t kManyCurves = 64;  ///< number of cached curves from which on unused ones are dropped

/// Returns an Error if the grid has no valid value at all.
Outcome check_grid(const field::AnyField& any) {
  const field::GridStats* stats = nullptr;
  if (any.scalar && any.scalar->grid()) stats = &any.scalar->grid()->stats();
  if (any.vector && any.vector->grid()) stats = &any.vector->grid()->stats();
  if (stats == nullptr) return Done{};
  if (stats->active_voxels == 0) return Error{"grid " + in_quotes(any.get()->name()) + " is empty; active voxels were expected"};
  if (stats->nan_count >= stats->active_voxels)
    return Error{"grid " + in_quotes(any.get()->name()) + " contains no finite value; finite numbers were expected"};
  return Done{};
}

Result<field::AnyField> load_source(const FieldSource& source) {
  if (!source.file) return field::make_analytic(source.analytic, source.parameters);
  auto loaded = source.has_changed_step || !source.series.empty() ? field::load_cached(*source.file) : field::load(*source.file);
  if (!loaded && source.grid_is_optional && !source.file->grid.empty()) {
    field::LoadRequest any_grid = *source.file;
    any_grid.grid.clear();
    loaded = field::load(any_grid);
  }
  if (!loaded) return loaded.error();
  CATENA_CHECK(check_grid(*loaded));
  return *loaded;
}

/// Loads the source's file on first use; an Error names the source's location in the scene file, if it has one.
template <class Source, class Load>
auto load_once(Scene& scene, Entity entity, const std::string& kind, const Load& load) -> Result<decltype(Source::loaded)> {
  Source& source = scene.entities.get<Source>(entity);
  if (source.loaded) return source.loaded;
  auto loaded = load(source);
  if (!loaded && source.where.line == 0) return loaded.error();
  if (!loaded)
    return with_cause(
        json::error_at(source.where, kind + " " + in_quotes(scene.entities.get<Name>(entity).value) + ": " + loaded.error().message),
        loaded.error());
  source.loaded = *loaded;
  request_step_times(source.steps, source.path);
  return source.loaded;
}

/// Adds a note if labels are interpolated linearly or cubically, because values between labels mean nothing; no note if a label surface is
/// extracted from the field.
void note_mixed_labels(Scene& scene, const std::string& name, const FieldSource& source) {
  const field::ScalarGrid* grid = source.loaded.scalar ? source.loaded.scalar->grid() : nullptr;
  if (!source.file || grid == nullptr || grid->interpolation() == field::Interpolation::nearest) return;
  const std::string& path = source.file->path;
  const bool table = !source.labels_table.empty();
  if (!table && (path.ends_with(".vdb") || !field::read_units(path, source.file->grid).is_label_map))
    return;  // a .vdb cannot declare labels
  bool made = false;
  scene.entities.each<FieldSource>(
      [&](Entity, const FieldSource& other) { made = made || (other.label && other.label->label_map == name); });
  if (made) return;
  scene.notes.push_back(fmt::format(
      "field {}: {}, but the {} interpolation computes meaningless values between labels; \"interpolation\": \"nearest\" was expected",
      in_quotes(name), table ? "the field has \"labels\"" : path + " is declared as a label map (NIFTI_INTENT_LABEL)",
      grid->interpolation() == field::Interpolation::cubic ? "cubic" : "linear"));
}

/// Adds a note if all magnitudes are below kMinSize, the smallest number in a scene file: too small for images and forces.
void note_tiny_values(Scene& scene, const std::string& name, const FieldSource& source) {
  const field::ScalarGrid* grid = source.loaded.scalar ? source.loaded.scalar->grid() : nullptr;
  if (grid == nullptr) return;
  const double max_magnitude = std::max(std::fabs(grid->stats().min), std::fabs(grid->stats().max));
  if (max_magnitude == 0 || max_magnitude >= kMinSize) return;
  scene.notes.push_back(
      fmt::format("field {}: the largest magnitude is {}, too small for images and forces; at least {} was expected: scale the data",
                  in_quotes(name), format_readable(max_magnitude), format_readable(kMinSize)));
}

/// Adds a note that automatic color ranges omit outliers and fill values.
void note_outliers(Scene& scene, const std::string& name, const FieldSource& source) {
  if (source.has_changed_step) return;
  const std::string note = outlier_note(field::display_range(source.loaded));
  if (!note.empty()) scene.notes.push_back("field " + in_quotes(name) + ": " + note);
}

}  // namespace

Result<field::AnyField> resolve_field(Scene& scene, Entity field, const json::Node& where) {
  FieldSource& source = scene.entities.get<FieldSource>(field);
  if (source.loaded.get() != nullptr) return source.loaded;
  if (source.label) {
    CATENA_TRY(field::AnyField surface, resolve_label_surface(scene, field));
    scene.entities.get<FieldSource>(field).loaded = surface;
    return surface;
  }
  if (source.derived) {
    CATENA_TRY(const field::AnyField derived, resolve_derived(scene, field));
    FieldSource& made = scene.entities.get<FieldSource>(field);
    made.loaded = derived;
    const std::string name = scene.entities.get<Name>(field).value;
    for (const std::string& note : derived.notes) scene.notes.push_back("field " + in_quotes(name) + ": " + note);
    note_outliers(scene, name, made);
    return derived;
  }
  auto loaded = load_source(source);
  if (!loaded) {
    const json::Node& location = source.where.line != 0 ? source.where : where;
    return with_cause(json::error_at(location, "field " + in_quotes(scene.entities.get<Name>(field).value) + ": " + loaded.error().message),
                      loaded.error());
  }
  source.loaded = *loaded;
  for (const std::string& note : source.has_changed_step ? std::vector<std::string>() : loaded->notes)
    scene.notes.push_back((source.file ? source.file->path + ": " : std::string()) + note);
  load_label_map(source);
  note_mixed_labels(scene, scene.entities.get<Name>(field).value, source);
  note_tiny_values(scene, scene.entities.get<Name>(field).value, source);
  note_outliers(scene, scene.entities.get<Name>(field).value, source);
  return source.loaded;
}

Result<field::AnyField> resolve_field(Scene& scene, const std::string& name, const json::Node& where) {
  CATENA_TRY(const Entity field, require_named<FieldSource>(scene, name, where, "field", "fields"));
  return resolve_field(scene, field, where);
}

/// Returns the maximum absolute coordinate of the grid's corners along any axis.
static double max_coordinate(const field::Field& grid) {
  const Bounds box = field::world_bounds(grid.mapping(), grid.index_box());
  double maximum = 0;
  for (int axis = 0; axis < 3; ++axis) maximum = std::max({maximum, std::fabs(box.lo[axis]), std::fabs(box.hi[axis])});
  return maximum;
}

Result<field::AnyField> resolve_rendered_field(Scene& scene, Entity field, const json::Node& where) {
  CATENA_TRY(const field::AnyField loaded, resolve_field(scene, field, where));
  FieldSource& source = scene.entities.get<FieldSource>(field);
  if (source.rendered.get() == nullptr) {
    if (loaded.get()->is_grid()) {
      if (const double coordinate = max_coordinate(*loaded.get()); coordinate > kMaxDrawn)
        return json::error_at(source.where.line != 0 ? source.where : where,
                              fmt::format("field {}: extends to {:.3g} from the origin, too far to be rendered; at most {:g} was expected",
                                          in_quotes(scene.entities.get<Name>(field).value), coordinate, kMaxDrawn));
      source.rendered = loaded;
    } else {
      const auto sampled = field::try_sample_on_grid(loaded, source.resolution, source.box[0], source.box[1]);
      if (!sampled) return with_cause(json::error_at(source.where, sampled.error().message), sampled.error());
      source.rendered = *sampled;
    }
  }
  Outcome mapped = Done{};
  if (source.rendered.scalar)
    scene.entities.each<Volume>([&](Entity, Volume& volume) {
      if (volume.field != field || is_complete(volume.transfer)) return;
      const field::ScalarGrid& grid = *source.rendered.scalar->grid();
      if (shows_labels(scene, field, volume.transfer.colors, volume.transfer.named)) {
        volume.transfer.colors = make_label_colors(*source.labels);
        volume.transfer.named.mapping = {};
        if (volume.transfer.extinctions.empty() && volume.transfer.opacities.empty()) volume.transfer.opacities = {{0.4, 0}, {0.6, 0.9}};
        return;
      }
      // a projection shows the color of its value
      if (volume.projection != Volume::Projection::composite && volume.transfer.extinctions.empty() && volume.transfer.opacities.empty())
        volume.transfer.opacities = {{0, TransferFunction::OpacityPoint::kMaxAlpha}};
      if (!scene.cache.has<SortedValues>(field)) scene.cache.emplace<SortedValues>(field);
      SortedValues& sample = scene.cache.get<SortedValues>(field);
      if (sample.grid != source.rendered.get()) sample = {source.rendered.get(), sorted_values(grid)};
      complete_transfer(volume.transfer, grid, *sample.sorted);
      if (Outcome found = check_mapping(volume.where, volume.transfer.named.mapping, volume.transfer.colors.front().value); !found)
        mapped = std::move(found);
    });
  CATENA_CHECK(mapped);
  return source.rendered;
}

Result<mesh::MeshPtr> resolve_mesh(Scene& scene, Entity mesh) {
  return load_once<MeshSource>(scene, mesh, "mesh",
                               [](const MeshSource& source) { return mesh::load_mesh(source.path, source.placement, source.steps.step); });
}

Result<mesh::MeshPtr> resolve_mesh(Scene& scene, const std::string& name, const json::Node& where) {
  CATENA_TRY(const Entity mesh, require_named<MeshSource>(scene, name, where, "mesh", "\"meshes\""));
  return resolve_mesh(scene, mesh);
}

Result<curves::CurveSetPtr> resolve_curves(Scene& scene, Entity curves) {
  if (scene.entities.get<CurvesSource>(curves).vortex_cores) return resolve_vortex_core_curves(scene, curves);
  return load_once<CurvesSource>(scene, curves, "curves",
                                 [](const CurvesSource& source) { return curves::load_curves(source.path, source.steps.step); });
}

Result<curves::CurveSetPtr> resolve_curves(Scene& scene, const std::string& name, const json::Node& where) {
  CATENA_TRY(const Entity curves, require_named<CurvesSource>(scene, name, where, "curves", "\"curves\""));
  return resolve_curves(scene, curves);
}

Result<curves::PointSetPtr> resolve_points(Scene& scene, Entity points) {
  return load_once<PointsSource>(scene, points, "points",
                                 [](const PointsSource& source) { return curves::load_points(source.path, source.steps.step); });
}

Result<curves::PointSetPtr> resolve_points(Scene& scene, const std::string& name, const json::Node& where) {
  CATENA_TRY(const Entity points, require_named<PointsSource>(scene, name, where, "points", "\"points\""));
  return resolve_points(scene, points);
}

Result<flow::CurvePtr> resolve_streamline(Scene& scene, const flow::Flow& flow, const Vec3& seed, const json::Node& where, double length) {
  CATENA_ASSERT(flow.field != nullptr);
  if (!is_finite(seed)) return json::error_at(where, "the seed is not finite; three finite numbers [x, y, z] were expected");
  const Scene::CurveKey key{flow.field->version(), flow.is_line_field, flow.min_speed, length, {seed.x, seed.y, seed.z}};
  if (const auto it = scene.traced_curves.find(key); it != scene.traced_curves.end()) return it->second;
  flow::TraceOptions options;
  options.length = length;
  auto curve = flow::trace(flow, seed, options);
  if (!curve) return with_cause(json::error_at(where, curve.error().message), curve.error());
  if (scene.traced_curves.size() >= kManyCurves) drop_unused_curves(scene);
  scene.traced_curves.emplace(key, *curve);
  return *curve;
}

Outcome check_surface(const Scene& scene, Entity field, const json::Node& where) {
  const field::AnyField& any = loaded_field(scene, field);
  const std::string hint = any.scalar ? field::no_surface_hint(*any.scalar, scene.entities.get<Name>(field).value) : std::string();
  return hint.empty() ? Outcome(Done{}) : json::error_at(where, hint);
}

Outcome check_level(const field::ScalarField& field, double level, const json::Node& where) {
  const double lo = field.min_value(), hi = field.max_value();
  if (level >= lo && level <= hi) return Done{};
  return json::error_at(where, "level " + to_text(level) + " is outside the field's range " + format_readable(lo) + ".." +
                                   format_readable(hi) + "; a level within this range was expected");
}

}  // namespace catena::scene
