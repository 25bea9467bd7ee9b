#include "engine/scene/prepare.h"

#include "engine/scene/hidden.h"
#include "engine/scene/lines.h"
#include "engine/scene/systems.h"

namespace catena::scene {

namespace {

/// The entities with a visible T; a copy, as components are added meanwhile.
template <class T>
std::vector<Entity> visible(const World& world) {
  std::vector<Entity> all;
  world.each<T>([&](Entity e, const T&) {
    if (!is_hidden(world, e)) all.push_back(e);
  });
  return all;
}

/// What rays meet: a field, and the field that colours it.
template <class T>
Outcome load_drawn(Scene& scene) {
  for (const Entity e : visible<T>(scene.world)) {
    const T& item = scene.world.get<T>(e);
    CATENA_CHECK(use_drawn_field(scene, item.field, item.where));
    if (item.color_by) CATENA_CHECK(use_drawn_field(scene, item.color_by->field, item.color_by->where));
  }
  return Done{};
}

Outcome load_meshes(Scene& scene) {
  for (const Entity e : visible<SurfaceMesh>(scene.world)) {
    const SurfaceMesh& surface = scene.world.get<SurfaceMesh>(e);
    CATENA_CHECK(use_mesh(scene, surface.mesh));
    if (surface.color_by) CATENA_CHECK(use_field(scene, surface.color_by->field, surface.where));
  }
  return Done{};
}

Outcome trace_lines(Scene& scene) {
  for (const Entity e : visible<StreamlineSet>(scene.world)) {
    if (lines_version(scene, e) == 0) CATENA_CHECK(use_lines(scene, e));
    const StreamlineSet& set = scene.world.get<StreamlineSet>(e);
    if (set.color_by && set.color_by->what == ColorBy::What::field) CATENA_CHECK(use_field(scene, set.color_by->field, set.where));
  }
  for (const Entity e : visible<Indicator>(scene.world)) {
    const Indicator& indicator = scene.world.get<Indicator>(e);
    CATENA_CHECK(use_field(scene, indicator.field, indicator.where));
  }
  return Done{};
}

}  // namespace

Outcome prepare(Scene& scene) {
  CATENA_CHECK(drive_widgets(scene));
  CATENA_CHECK(load_drawn<Volume>(scene));
  CATENA_CHECK(load_drawn<Isosurface>(scene));
  CATENA_CHECK(load_meshes(scene));
  for (const Entity e : visible<Slice>(scene.world)) {
    const Slice& slice = scene.world.get<Slice>(e);
    CATENA_CHECK(use_drawn_field(scene, slice.shown.field, slice.where));
  }
  CATENA_CHECK(trace_lines(scene));
  if (scene.bounding_box && scene.bounding_box->field)
    CATENA_CHECK(use_drawn_field(scene, scene.bounding_box->field, scene.bounding_box->where));
  if (scene.axes && scene.axes->field) CATENA_CHECK(use_drawn_field(scene, scene.axes->field, scene.axes->where));
  return Done{};
}

Bounds prepared_bounds(const Scene& scene) {
  Bounds bounds;
  scene.world.each<FieldSource>([&](Entity, const FieldSource& source) {
    for (const field::AnyField* field : {&source.loaded, &source.drawn})
      if (field->get() != nullptr) bounds.add(field->get()->world_bounds());
  });
  scene.world.each<MeshSource>([&](Entity, const MeshSource& source) {
    if (!source.loaded) return;
    bounds.add(source.loaded->lowest());
    bounds.add(source.loaded->highest());
  });
  for (const Entity e : visible<StreamlineSet>(scene.world)) bounds.add(lines_bounds(scene, e));
  return bounds;
}

}  // namespace catena::scene
