// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "engine/base/symlog_scale.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/field/bricks/paged_grid.h"
#include "engine/field/derived/magnitude.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/labels.h"
#include "engine/scene/visibility.h"
#include "render/extract/extract.h"
#include "render/extract/extract_internal.h"
#include "render/extract/legends.h"
#include "render/extract/slice_texture.h"
#include "render/extract/threshold.h"

namespace catena::render {

TransferTable make_transfer_table(const scene::TransferFunction& transfer, const field::AnyField& field) {
  return field.paged ? make_transfer_table(transfer, *field.paged) : make_transfer_table(transfer, *field.scalar);
}

TransferTable make_transfer_table(const scene::TransferFunction& transfer, const field::ScalarField& field) {
  CATENA_ASSERT(!transfer.colors.empty() && !(transfer.extinctions.empty() && transfer.opacities.empty()));
  constexpr double kOffset = 1.0 / 32768;
  TransferTable table;
  table.linear_below = scene::linear_below(transfer);
  for (const auto& c : transfer.colors) table.colors.push_back({c.value, c.color.r, c.color.g, c.color.b});
  for (const auto& e : transfer.extinctions) table.extinctions.push_back({e.value, e.sigma});
  for (const auto& g : transfer.gradient_factors) table.gradient_factors.push_back({g.gradient, g.factor});
  table.opacity_length = transfer.opacity_unit;
  const double unit = transfer.opacity_unit > 0 ? transfer.opacity_unit : field.mapping().min_voxel_edge();
  if (table.extinctions.empty())
    for (const auto& o : transfer.opacities) table.extinctions.push_back({o.value, -std::log1p(-o.alpha) / unit});
  table.colors = refine_for_symlog(table.colors, table.linear_below, kOffset);
  table.extinctions = refine_for_symlog(table.extinctions, table.linear_below, kOffset);
  if (!transfer.named.threshold.empty()) table.extinctions = cut_extinctions(table.extinctions, transfer.named.threshold);
  return table;
}

namespace {

constexpr double kMaxVoxels = 1 << 28;  ///< maximum size of a grid of magnitudes

// ---- meshes ----

/// Cached triangles of a SurfaceMesh as plain arrays.
struct PlainMesh {
  std::shared_ptr<const MeshGeometry> geometry;
  std::uint64_t version = 0, field_version = 0;
};

/// Error: too little memory for the copy of a mesh as plain arrays.
Outcome ask_for_copy(const mesh::TriangleMesh& mesh, const scene::SurfaceMesh& surface) {
  const std::size_t vertex = sizeof(Vec3) * (surface.smooth_shading ? 3 : 1) + (surface.color_by ? sizeof(Color) + sizeof(double) : 0);
  auto asked =
      check_text_memory_available("drawing the mesh " + in_quotes(mesh.name()),
                                  static_cast<double>(mesh.vertices().size() * vertex + mesh.triangles().size() * sizeof(mesh::Triangle)));
  if (!asked) return with_cause(json::error_at(surface.where, asked.error().message), asked.error());
  return Done{};
}

/// Colors the vertices by the field's values there, and cuts the triangles to the threshold.
Outcome color_triangles(const scene::Scene& scene, const mesh::TriangleMesh& mesh, const field::AnyField& shown,
                        const scene::SurfaceMesh& surface, MeshGeometry& geometry) {
  const scene::ColorBy& by = *surface.color_by;
  std::vector<double> values;
  values.reserve(mesh.vertices().size());
  field::Cursor cursor;
  for (const Vec3& p : mesh.vertices()) {
    double value = NAN;
    if (shown.scalar) {
      const field::ScalarSample sample = shown.scalar->sample(p, cursor);
      if (sample.inside) value = sample.value;
    } else {
      const field::VectorSample sample = shown.vector->sample(p, cursor);
      if (sample.inside) value = norm(sample.value);
    }
    values.push_back(value);
  }
  const DisplayRange range = field::display_range(values, shown);
  CATENA_CHECK(scene::check_mapping(by, range.lo));
  const auto table = scene::make_display_color_table(scene, by.field, by.colors, by.named, range.lo, range.hi);
  const bool labels = scene::find_label_map(scene, by.field) != nullptr;
  if (!by.named.threshold.empty()) cut_triangles(geometry, values, by.named.threshold);
  geometry.colors.reserve(values.size());
  for (const double value : values) geometry.colors.push_back(labels && value == 0 ? surface.color : sample_color_table(table, value));
  return Done{};
}

// ---- slices ----

/// Cached magnitude grid of a Slice of a vector field.
struct PlainMagnitude {
  std::shared_ptr<const field::ScalarGrid> grid;
  std::uint64_t version = 0;
};

Outcome prepare_slice(scene::Scene& scene, scene::Entity e) {
  const scene::Entity field = scene.entities.get<scene::Slice>(e).color_by.field;
  CATENA_TRY(const field::AnyField any, scene::resolve_rendered_field(scene, field, scene.entities.get<scene::Slice>(e).where));
  if (any.scalar) return Done{};
  const field::VectorGrid& grid = *any.vector->grid();
  if (!scene.cache.has<PlainMagnitude>(e)) scene.cache.emplace<PlainMagnitude>(e);
  PlainMagnitude& plain = scene.cache.get<PlainMagnitude>(e);
  if (plain.version == grid.version()) return Done{};
  const json::Node& where = json::member_or_parent(scene.entities.get<scene::Slice>(e).where, "field");
  const Vec3 size = grid.index_box().hi - grid.index_box().lo + 1.0;
  if (size.x * size.y * size.z > kMaxVoxels)
    return json::error_at(where, "\"" + entity_name(scene, field) + "\" has " + to_text(size.x * size.y * size.z) +
                                     " voxels; a vector field of at most " + to_text(kMaxVoxels) + " was expected for a slice");
  auto made = field::make_magnitude_grid(grid, "the magnitude of \"" + entity_name(scene, field) + "\"");
  if (!made) return with_cause(json::error_at(where, made.error().message), made.error());
  plain = {*made, grid.version()};
  return Done{};
}

std::shared_ptr<const field::ScalarGrid> sliced_grid(const scene::Scene& scene, scene::Entity e) {
  const field::AnyField& any = scene::rendered_field(scene, scene.entities.get<scene::Slice>(e).color_by.field);
  if (any.scalar) return {any.scalar, any.scalar->grid()};
  return scene.cache.get<PlainMagnitude>(e).grid;
}

/// Returns whether two slices have the same plane, up to rounding.
bool is_same_plane(const SliceItem& a, const SliceItem& b) {
  const Vec3 n = direction(a.normal), m = direction(b.normal);
  constexpr double kRounding = 1e-6;
  const double voxel_edge = a.grid->mapping().min_voxel_edge();
  return norm(cross(n, m)) < kRounding && std::fabs(dot(n, b.point - a.point)) < kRounding * voxel_edge;
}

/// Returns whether the slice's plane meets the grid's domain.
bool cuts(const scene::Slice& slice, const field::Field& grid) {
  const Vec3 normal = direction(slice.normal);
  double min_distance = HUGE_VAL, max_distance = -HUGE_VAL;
  for (int i = 0; i < 8; ++i) {
    const double distance = dot(normal, grid.corner(i) - slice.point);
    min_distance = std::min(min_distance, distance);
    max_distance = std::max(max_distance, distance);
  }
  const double slack = 1e-6 * (max_distance - min_distance);
  return min_distance <= slack && max_distance >= -slack;
}

/// Builds the triangles of the meshes. The rendered mesh is the haptic one: the same object of the scene. Colors by a field are those of
/// its values at the vertices; gray outside its domain.
Outcome prepare_meshes(scene::Scene& scene) {
  for (const scene::Entity e : entities_with<scene::SurfaceMesh>(scene.entities)) {
    const scene::SurfaceMesh& surface = scene.entities.get<scene::SurfaceMesh>(e);
    if (is_hidden(scene.entities, e)) continue;
    CATENA_TRY(const mesh::MeshPtr mesh, scene::resolve_mesh(scene, surface.mesh));
    field::AnyField shown;
    if (surface.color_by) {
      CATENA_TRY(shown, scene::resolve_field(scene, surface.color_by->field, surface.where));
    }
    const std::uint64_t field_version = shown.get() ? shown.get()->version() : 0;
    if (!scene.cache.has<PlainMesh>(e)) scene.cache.emplace<PlainMesh>(e);
    PlainMesh& plain = scene.cache.get<PlainMesh>(e);
    if (plain.version == mesh->version() && plain.field_version == field_version) continue;
    CATENA_CHECK(ask_for_copy(*mesh, surface));
    auto geometry = std::make_shared<MeshGeometry>();
    geometry->vertices = mesh->vertices();
    geometry->triangles.reserve(3 * mesh->triangles().size());
    for (const mesh::Triangle& t : mesh->triangles()) geometry->triangles.insert(geometry->triangles.end(), t.begin(), t.end());
    for (std::uint32_t v = 0; surface.smooth_shading && v < geometry->vertices.size(); ++v)
      geometry->normals.push_back(mesh->vertex_normal(v));
    if (shown.get()) CATENA_CHECK(color_triangles(scene, *mesh, shown, surface, *geometry));
    plain = {std::move(geometry), mesh->version(), field_version};
  }
  return Done{};
}

Outcome extract_meshes(const scene::Scene& scene, FramePacket& packet) {
  scene.entities.each<scene::SurfaceMesh>([&](scene::Entity e, const scene::SurfaceMesh& surface) {
    if (is_hidden(scene.entities, e)) return;
    MeshItem item{scene.cache.get<PlainMesh>(e).geometry, surface.color,
                  packet.add_object("mesh", entity_name(scene, surface.mesh), surface.where.label), surface.clipped};
    item.opacity = static_cast<float>(surface.opacity);
    item.smooth = surface.smooth_shading;
    item.show_edges = surface.show_edges;
    packet.meshes.push_back(std::move(item));
  });
  return Done{};
}

/// Builds what the slices need. An Error for a plane that misses the field, a spacing that gives more than scene::kMaxContours lines, or a
/// vector grid too large for its magnitudes.
Outcome prepare_slices(scene::Scene& scene) {
  for (const scene::Entity e : entities_with<scene::Slice>(scene.entities))
    if (!is_hidden(scene.entities, e)) {
      CATENA_CHECK(prepare_slice(scene, e));
      CATENA_CHECK(
          prepare_slice_texture(scene, e, *scene::rendered_field(scene, scene.entities.get<scene::Slice>(e).color_by.field).get()));
    }
  return Done{};
}

}  // namespace

Result<std::vector<double>> contour_levels(const scene::Slice::Contours& contours, double lo, double hi) {
  if (!contours.levels.empty()) return contours.levels;
  std::vector<double> levels;
  for (int i = 0; i < contours.count; ++i) levels.push_back(lo + (hi - lo) * (i + 1) / (contours.count + 1));
  if (!(contours.spacing > 0)) return levels;
  const double first = std::ceil(lo / contours.spacing), last = std::floor(hi / contours.spacing);
  if (last - first + 1 > scene::kMaxContours)
    return json::error_at(json::member_or_parent(contours.where, "spacing"),
                          "\"spacing\" is " + to_text(contours.spacing) + ", which gives " + to_text(last - first + 1) +
                              " levels; at most " + to_text(scene::kMaxContours) + " were expected");
  for (double n = first; n <= last; ++n) levels.push_back(n * contours.spacing);
  return levels;
}

namespace {

/// Adds the slices to the packet. An Error for contour levels as described at prepare_slices().
Outcome extract_slices(const scene::Scene& scene, FramePacket& packet) {
  for (const scene::Entity e : entities_with<scene::Slice>(scene.entities)) {
    if (is_hidden(scene.entities, e)) continue;
    const std::shared_ptr<const field::ScalarGrid> grid = sliced_grid(scene, e);
    const scene::Slice& slice = scene.entities.get<scene::Slice>(e);
    // a widget may be dragged out of the domain: then nothing is drawn, without an error
    const std::shared_ptr<const field::PagedGrid>& paged = scene::rendered_field(scene, slice.color_by.field).paged;
    if (!slice.widget && !cuts(slice, paged ? static_cast<const field::Field&>(*paged) : *grid))
      return json::error_at(slice.where, "the slice's plane does not meet the domain of \"" + entity_name(scene, slice.color_by.field) +
                                             "\"; a plane that cuts it was expected");
    SliceItem item;
    item.grid = grid;
    item.paged = paged;
    item.point = slice.point;
    item.normal = slice.normal;
    const DisplayRange& range = display_range(*grid);
    CATENA_CHECK(scene::check_mapping(slice.color_by, range.lo));
    for (const auto& row :
         scene::make_display_color_table(scene, slice.color_by.field, slice.color_by.colors, slice.color_by.named, range.lo, range.hi))
      item.colors.push_back({row.value, row.color.r, row.color.g, row.color.b});
    if (scene::find_label_map(scene, slice.color_by.field) != nullptr) item.hidden_label = 0;
    item.threshold = slice.color_by.named.threshold;
    item.stack_order = static_cast<int>(
        std::count_if(packet.slices.begin(), packet.slices.end(), [&](const SliceItem& before) { return is_same_plane(before, item); }));
    item.opacity = static_cast<float>(slice.opacity);
    item.lit = slice.lit;
    if (slice.contours) {
      // levels lie between the ends of the color map, the range in which colors differ
      const bool spread = item.colors.size() > 1 && item.colors.front()[0] < item.colors.back()[0];
      const double lo = spread ? item.colors.front()[0] : range.lo, hi = spread ? item.colors.back()[0] : range.hi;
      const bool multiples = slice.contours->spacing > 0;
      CATENA_TRY(item.contour_levels, contour_levels(*slice.contours, multiples ? range.lo : lo, multiples ? range.hi : hi));
      item.line_color = slice.contours->color;
      item.line_width = static_cast<float>(slice.contours->width);
    }
    if (slice.flow_texture) {
      item.texture = slice_texture(scene, e);
      item.texture_strength = static_cast<float>(slice.flow_texture->strength);
      item.texture_phase = static_cast<float>(scene.animation_phase - std::floor(scene.animation_phase));
    }
    item.id = packet.add_object("slice", entity_name(scene, slice.color_by.field), slice.where.label);
    item.is_clipped = slice.clipped;
    packet.slices.push_back(std::move(item));
  }
  return Done{};
}

}  // namespace

DrawableExtraction meshes_extraction() { return {"meshes", prepare_meshes, extract_meshes, nullptr}; }
DrawableExtraction slices_extraction() { return {"slices", prepare_slices, extract_slices, slice_legend}; }

}  // namespace catena::render
