#include <fmt/format.h>

#include "engine/base/machine_failure.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/kept.h"
#include "engine/field/units.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/labels.h"
#include "engine/scene/lines.h"
#include "engine/scene/read_named.h"
#include "engine/scene/steps.h"
#include "engine/scene/traced_cores.h"
#include "engine/scene/transfer.h"

namespace catena::scene {
namespace {

constexpr double kFarthestDrawn = 1e30;  ///< world coordinates: as those that a scene may write
constexpr std::size_t kManyCurves = 64;  ///< from here on those that nothing holds are looked for

/// A field without a single value helps nobody.
Outcome check_grid(const field::AnyField& any) {
  const field::GridStats* stats = nullptr;
  if (any.scalar && any.scalar->grid()) stats = &any.scalar->grid()->stats();
  if (any.vector && any.vector->grid()) stats = &any.vector->grid()->stats();
  if (stats == nullptr) return Done{};
  if (stats->active_voxels == 0) return Error{"grid " + in_quotes(any.get()->name()) + " is empty; active voxels were expected"};
  if (stats->nan_count >= stats->active_voxels)
    return Error{"grid " + in_quotes(any.get()->name()) + " holds no finite value; numbers were expected"};
  return Done{};
}

Result<field::AnyField> load_source(const FieldSource& source) {
  if (!source.file) return field::make_analytic(source.analytic, source.parameters);
  auto loaded = source.stepped || !source.series.empty() ? field::load_kept(*source.file) : field::load(*source.file);
  if (!loaded && source.grid_is_a_wish && !source.file->grid.empty()) {
    field::LoadRequest any_grid = *source.file;
    any_grid.grid.clear();
    loaded = field::load(any_grid);
  }
  if (!loaded) return loaded.error();
  CATENA_CHECK(check_grid(*loaded));
  return *loaded;
}

/// What lies in a source's file; the error stands at the source's place in the scene file, where it has one.
template <class Source, class Load>
auto load_once(Scene& scene, Entity entity, const std::string& kind, const Load& load) -> Result<decltype(Source::loaded)> {
  Source& source = scene.world.get<Source>(entity);
  if (source.loaded) return source.loaded;
  auto loaded = load(source);
  if (!loaded && source.where.line == 0) return loaded.error();
  if (!loaded)
    return caused_by(
        json::error_at(source.where, kind + " " + in_quotes(scene.world.get<Name>(entity).value) + ": " + loaded.error().message),
        loaded.error());
  source.loaded = *loaded;
  find_times(source.steps, source.path);
  return source.loaded;
}

/// Between labels there is nothing to mix: a note where what is marked as labels is read by cells, unless a surface of labels is made of
/// it.
void note_mixed_labels(Scene& scene, const std::string& name, const FieldSource& source) {
  const field::ScalarGrid* grid = source.loaded.scalar ? source.loaded.scalar->grid() : nullptr;
  if (!source.file || grid == nullptr || grid->interpolation() == field::Interpolation::nearest) return;
  const std::string& path = source.file->path;
  const bool table = !source.labels_table.empty();
  if (!table && (path.ends_with(".vdb") || !field::units_of(path, source.file->grid).labels)) return;  // a .vdb has no such mark
  bool made = false;
  scene.world.each<FieldSource>([&](Entity, const FieldSource& other) { made = made || (other.label && other.label->of == name); });
  if (made) return;
  scene.notes.push_back(fmt::format(
      "field {}: {}, and {} cells make numbers between them that stand for nothing; \"interpolation\": \"nearest\" was expected",
      in_quotes(name), table ? "it has \"labels\"" : path + " says that it holds labels (NIFTI_INTENT_LABEL)",
      grid->interpolation() == field::Interpolation::cubic ? "cubic" : "linear"));
}

/// Pictures and forces are of numbers that a scene can state.
void note_tiny_values(Scene& scene, const std::string& name, const FieldSource& source) {
  const field::ScalarGrid* grid = source.loaded.scalar ? source.loaded.scalar->grid() : nullptr;
  if (grid == nullptr) return;
  const double most = std::max(std::fabs(grid->stats().min), std::fabs(grid->stats().max));
  if (most == 0 || most >= kLeastSize) return;
  scene.notes.push_back(fmt::format(
      "field {}: its values are at most {} in size, too little for pictures and forces; from {} on were expected: scale the data",
      in_quotes(name), readable(most), readable(kLeastSize)));
}

/// Colours without a stated range leave outliers and fill values out.
void note_outliers(Scene& scene, const std::string& name, const FieldSource& source) {
  if (source.stepped) return;
  const std::string note = beyond_note(field::display_range(source.loaded));
  if (!note.empty()) scene.notes.push_back("field " + in_quotes(name) + ": " + note);
}

}  // namespace

Result<field::AnyField> use_field(Scene& scene, Entity field, const json::Node& where) {
  FieldSource& source = scene.world.get<FieldSource>(field);
  if (source.loaded.get() != nullptr) return source.loaded;
  if (source.label) {
    CATENA_TRY(field::AnyField surface, use_label_surface(scene, field));
    scene.world.get<FieldSource>(field).loaded = surface;
    return surface;
  }
  auto loaded = load_source(source);
  if (!loaded) {
    const json::Node& place = source.where.line != 0 ? source.where : where;
    return caused_by(json::error_at(place, "field " + in_quotes(scene.world.get<Name>(field).value) + ": " + loaded.error().message),
                     loaded.error());
  }
  source.loaded = *loaded;
  for (const std::string& note : source.stepped ? std::vector<std::string>() : loaded->notes)
    scene.notes.push_back((source.file ? source.file->path + ": " : std::string()) + note);
  find_labels(source);
  note_mixed_labels(scene, scene.world.get<Name>(field).value, source);
  note_tiny_values(scene, scene.world.get<Name>(field).value, source);
  note_outliers(scene, scene.world.get<Name>(field).value, source);
  return source.loaded;
}

Result<field::AnyField> use_field(Scene& scene, const std::string& name, const json::Node& where) {
  CATENA_TRY(const Entity field, named<FieldSource>(scene, name, where, "field", "fields"));
  return use_field(scene, field, where);
}

/// Of the farthest corner, along an axis.
static double reach_of(const field::Field& grid) {
  const Bounds box = field::world_bounds(grid.mapping(), grid.index_box());
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) most = std::max({most, std::fabs(box.lo[axis]), std::fabs(box.hi[axis])});
  return most;
}

Result<field::AnyField> use_drawn_field(Scene& scene, Entity field, const json::Node& where) {
  CATENA_TRY(const field::AnyField loaded, use_field(scene, field, where));
  FieldSource& source = scene.world.get<FieldSource>(field);
  if (source.drawn.get() == nullptr) {
    if (loaded.get()->is_grid()) {
      if (const double reach = reach_of(*loaded.get()); reach > kFarthestDrawn)
        return json::error_at(source.where.line != 0 ? source.where : where,
                              fmt::format("field {}: reaches {:.3g} from the origin, which no picture shows; at most {:g} was expected",
                                          in_quotes(scene.world.get<Name>(field).value), reach, kFarthestDrawn));
      source.drawn = loaded;
    } else {
      const auto drawn = field::try_sample_on_grid(loaded, source.resolution, source.box[0], source.box[1]);
      if (!drawn) return caused_by(json::error_at(source.where, drawn.error().message), drawn.error());
      source.drawn = *drawn;
    }
  }
  Outcome mapped = Done{};
  if (source.drawn.scalar)
    scene.world.each<Volume>([&](Entity, Volume& volume) {
      if (volume.field != field || is_complete(volume.transfer)) return;
      const field::ScalarGrid& grid = *source.drawn.scalar->grid();
      if (shows_labels(scene, field, volume.transfer.colors, volume.transfer.named)) {
        volume.transfer.colors = label_colors(*source.labels);
        volume.transfer.named.mapping = {};
        if (volume.transfer.extinctions.empty() && volume.transfer.opacities.empty()) volume.transfer.opacities = {{0.4, 0}, {0.6, 0.9}};
        return;
      }
      if (!scene.made.has<ValueSample>(field)) scene.made.emplace<ValueSample>(field);
      ValueSample& sample = scene.made.get<ValueSample>(field);
      if (sample.grid != source.drawn.get()) sample = {source.drawn.get(), sorted_values(grid)};
      complete_transfer(volume.transfer, grid, *sample.sorted);
      if (Outcome found = check_mapping(volume.where, volume.transfer.named.mapping, volume.transfer.colors.front().value); !found)
        mapped = std::move(found);
    });
  CATENA_CHECK(mapped);
  return source.drawn;
}

Result<mesh::MeshPtr> use_mesh(Scene& scene, Entity mesh) {
  return load_once<MeshSource>(scene, mesh, "mesh",
                               [](const MeshSource& source) { return mesh::load_mesh(source.path, source.placement, source.steps.step); });
}

Result<mesh::MeshPtr> use_mesh(Scene& scene, const std::string& name, const json::Node& where) {
  CATENA_TRY(const Entity mesh, named<MeshSource>(scene, name, where, "mesh", "\"meshes\""));
  return use_mesh(scene, mesh);
}

Result<curves::CurveSetPtr> use_curves(Scene& scene, Entity curves) {
  if (scene.world.get<DrawnCurves>(curves).traced) return use_traced(scene, curves);
  return load_once<DrawnCurves>(scene, curves, "curves",
                                [](const DrawnCurves& source) { return curves::load_curves(source.path, source.steps.step); });
}

Result<curves::CurveSetPtr> use_curves(Scene& scene, const std::string& name, const json::Node& where) {
  CATENA_TRY(const Entity curves, named<DrawnCurves>(scene, name, where, "curves", "\"curves\""));
  return use_curves(scene, curves);
}

Result<curves::PointSetPtr> use_points(Scene& scene, Entity points) {
  return load_once<DrawnPoints>(scene, points, "points",
                                [](const DrawnPoints& source) { return curves::load_points(source.path, source.steps.step); });
}

Result<curves::PointSetPtr> use_points(Scene& scene, const std::string& name, const json::Node& where) {
  CATENA_TRY(const Entity points, named<DrawnPoints>(scene, name, where, "points", "\"points\""));
  return use_points(scene, points);
}

Result<flow::CurvePtr> use_curve(Scene& scene, const flow::Flow& flow, const Vec3& seed, const json::Node& where, double length) {
  CATENA_ASSERT(flow.field != nullptr);
  if (!is_finite(seed)) return json::error_at(where, "the seed is not finite; three finite numbers [x, y, z] were expected");
  const Scene::CurveKey key{flow.field->version(), flow.line, flow.min_speed, length, {seed.x, seed.y, seed.z}};
  if (const auto it = scene.curves.find(key); it != scene.curves.end()) return it->second;
  flow::TraceOptions options;
  options.length = length;
  auto curve = flow::trace(flow, seed, options);
  if (!curve) return caused_by(json::error_at(where, curve.error().message), curve.error());
  if (scene.curves.size() >= kManyCurves) drop_unused_curves(scene);
  scene.curves.emplace(key, *curve);
  return *curve;
}

Outcome check_surface(const Scene& scene, Entity field, const json::Node& where) {
  const field::AnyField& any = loaded_field(scene, field);
  const std::string why = any.scalar ? field::why_no_surface(*any.scalar, scene.world.get<Name>(field).value) : std::string();
  return why.empty() ? Outcome(Done{}) : json::error_at(where, why);
}

Outcome check_level(const field::ScalarField& field, double level, const json::Node& where) {
  const double lo = field.min_value(), hi = field.max_value();
  if (level >= lo && level <= hi) return Done{};
  return json::error_at(where, "level " + to_text(level) + " lies outside the field's values " + readable(lo) + ".." + readable(hi) +
                                   "; a level that the field attains was expected");
}

}  // namespace catena::scene
