// SPDX-License-Identifier: MIT
#include "engine/scene/drawable.h"

#include "engine/scene/readers.h"

namespace catena::scene {

// rows of all kinds, each defined in the file of its reader
Drawable volumes(), isosurfaces(), meshes(), slices(), streamlines(), glyphs(), curves(), points();

namespace {

std::vector<Drawable>& registry() {
  static std::vector<Drawable> kinds{volumes(), isosurfaces(), meshes(), slices(), streamlines(), glyphs(), curves(), points()};
  return kinds;
}

}  // namespace

void register_drawable(const Drawable& kind) { registry().push_back(kind); }
const std::vector<Drawable>& drawables() { return registry(); }

const Drawable* find_drawable(const EntityStore& entities, Entity e) {
  const auto found = std::ranges::find_if(registry(), [&](const Drawable& kind) { return kind.owns(entities, e); });
  return found == registry().end() ? nullptr : &*found;
}

Result<double> field_length(Scene& scene, Entity field, const json::Node& where) {
  if (!field) return 0.0;
  CATENA_TRY(const field::AnyField any, resolve_field(scene, field, where));
  return any.get()->domain_length();
}

Result<double> length_of_domain(Scene& scene, Entity, const Slice& slice) { return field_length(scene, slice.color_by.field, slice.where); }

Result<double> length_of_domain(Scene& scene, Entity, const SurfaceMesh& surface) {
  CATENA_TRY(const mesh::MeshPtr loaded, resolve_mesh(scene, surface.mesh));
  return loaded->domain_length();
}

Result<double> length_of_domain(Scene& scene, Entity e, const CurvesSource&) {
  CATENA_TRY(const auto loaded, resolve_curves(scene, e));
  return max_abs(loaded->max_corner - loaded->min_corner);
}

Result<double> length_of_domain(Scene& scene, Entity e, const PointsSource&) {
  CATENA_TRY(const auto loaded, resolve_points(scene, e));
  return max_abs(loaded->max_corner - loaded->min_corner);
}

}  // namespace catena::scene
