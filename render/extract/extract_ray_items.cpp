// SPDX-License-Identifier: MIT
/// Extracts volumes and isosurfaces, the items that rays intersect.
#include "engine/scene/color_maps.h"
#include "engine/scene/labels.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"
#include "render/extract/legends.h"

namespace catena::render {

namespace {

/// Returns the scalar grid of a field as it is rendered.
Result<std::shared_ptr<const field::ScalarGrid>> drawn_grid(const scene::Scene& scene, scene::Entity field, const json::Node& where,
                                                            const char* what) {
  const field::AnyField& any = scene::rendered_field(scene, field);
  if (!any.scalar)
    return json::error_at(json::member_or_parent(where, "field"),
                          "\"" + entity_name(scene, field) + "\" is a vector field; expected a scalar field for " + what);
  CATENA_ASSERT(any.scalar->grid() != nullptr);
  return std::shared_ptr<const field::ScalarGrid>(any.scalar, any.scalar->grid());
}

/// Returns the colors by another field of an item that shows the field `of`.
Result<std::optional<ColorSource>> color_source(const scene::Scene& scene, const std::optional<scene::ColorBy>& by, scene::Entity of) {
  if (!by) return std::optional<ColorSource>();
  ColorSource source;
  CATENA_TRY(source.grid, drawn_grid(scene, by->field, by->where, "\"color_by\""));
  const DisplayRange& range = display_range(*source.grid);
  CATENA_CHECK(scene::check_mapping(*by, range.lo));
  for (const auto& c : scene::make_display_color_table(scene, by->field, by->colors, by->named, range.lo, range.hi))
    source.colors.push_back({c.value, c.color.r, c.color.g, c.color.b});
  source.linear_below = scene::linear_below(by->named.mapping, source.colors.front()[0], source.colors.back()[0]);
  // a surface of labels lies between their voxels and others, and has the colors of its own labels
  const auto& label = scene.entities.get<scene::FieldSource>(of).label;
  const scene::LabelMap* map = scene::find_label_map(scene, by->field);
  source.is_categorical = map != nullptr;
  source.spread_labels = source.is_categorical && label && label->label_map == entity_name(scene, by->field);
  if (source.spread_labels && !label->all_labels) source.labels = scene::labels_inside(*label, *map);
  return std::optional<ColorSource>(std::move(source));
}

Projection projection_of(scene::Volume::Projection projection) {
  using From = scene::Volume::Projection;
  return projection == From::maximum   ? Projection::maximum
         : projection == From::minimum ? Projection::minimum
         : projection == From::average ? Projection::average
                                       : Projection::composite;
}

/// Adds the visible volumes. Error: a vector field.
Outcome extract_volumes(const scene::Scene& scene, FramePacket& packet) {
  for (const scene::Entity e : entities_with<scene::Volume>(scene.entities)) {
    const scene::Volume& volume = scene.entities.get<scene::Volume>(e);
    if (is_hidden(scene.entities, e)) continue;
    CATENA_TRY(auto grid, drawn_grid(scene, volume.field, volume.where, "a volume"));
    const field::AnyField& any = scene::rendered_field(scene, volume.field);
    TransferTable transfer = make_transfer_table(volume.transfer, any);
    transfer.is_categorical = scene::find_label_map(scene, volume.field) != nullptr;
    CATENA_TRY(auto color_by, color_source(scene, volume.color_by, volume.field));
    const std::uint32_t id = packet.add_object("volume", entity_name(scene, volume.field), volume.where.label);
    packet.volumes.push_back({std::move(grid), std::move(transfer), volume.shaded, id, volume.clipped, projection_of(volume.projection),
                              std::move(color_by), any.paged});
    packet.volumes.back().scattering = {volume.albedo, volume.anisotropy, volume.reflected_share};
  }
  return Done{};
}

/// Adds the visible isosurfaces. Error: a vector field, or a level that the field does not have.
Outcome extract_isosurfaces(const scene::Scene& scene, FramePacket& packet) {
  for (const scene::Entity e : entities_with<scene::Isosurface>(scene.entities)) {
    const scene::Isosurface& surface = scene.entities.get<scene::Isosurface>(e);
    if (is_hidden(scene.entities, e)) continue;
    CATENA_TRY(auto grid, drawn_grid(scene, surface.field, surface.where, "an isosurface"));
    CATENA_CHECK(scene::check_surface(scene, surface.field, json::member_or_parent(surface.where, "field")));
    // the finest level may have values that the level in memory does not have
    const std::shared_ptr<const field::PagedGrid>& paged = scene::rendered_field(scene, surface.field).paged;
    if (!paged) CATENA_CHECK(scene::check_level(*grid, surface.level, json::member_or_parent(surface.where, "level")));
    CATENA_TRY(auto color_by, color_source(scene, surface.color_by, surface.field));
    const std::uint32_t id = packet.add_object("isosurface", entity_name(scene, surface.field), surface.where.label);
    packet.isosurfaces.push_back({std::move(grid), surface.level, surface.color, static_cast<float>(surface.opacity), id, surface.clipped,
                                  std::move(color_by), paged});
  }
  return Done{};
}

}  // namespace

DrawableExtraction volumes_extraction() { return {"volumes", nullptr, extract_volumes, volume_legend}; }
DrawableExtraction isosurfaces_extraction() { return {"isosurfaces", nullptr, extract_isosurfaces, isosurface_legend}; }

}  // namespace catena::render
