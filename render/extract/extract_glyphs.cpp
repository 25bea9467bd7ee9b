// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/system_failure.h"
#include "engine/field/grid/grid.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/uniform_sampling.h"
#include "engine/scene/visibility.h"
#include "render/extract/extract_internal.h"
#include "render/extract/legends.h"

namespace catena::render {

namespace {

using On = scene::GlyphSet::Support;

constexpr double kSurfaceShare = 1.0 / 24, kBoxShare = 1.0 / 16;  // fitted spacing / domain diagonal
constexpr double kShaftShare = 0.06;                              // fitted shaft radius / longest glyph
constexpr double kMaxHeadShare = 0.8;                             // maximum head length / arrow length
constexpr double kGlyphBytes = 6000;                              // memory of one glyph's triangles while they are made

/// State that the glyph positions depend on, besides the set's own description.
struct GlyphBasis {
  std::uint64_t field = 0, shown = 0, base = 0;  ///< versions of the field, of the "color_by" field and of the support
  Vec3 lo{0.0}, hi{0.0};                         ///< bounds of the domain
  Vec3 point{0.0}, normal{0.0};
  double level = 0;
  bool operator==(const GlyphBasis&) const = default;
};

/// Cached glyphs of a GlyphSet.
struct MadeGlyphs {
  std::optional<GlyphBasis> basis;
  SharedList<Glyph> glyphs;
  double shaft = 0, head = 0;  ///< radius of the shaft and length of the head / length of the longest glyph
  ColorTable colors;           ///< from "color_by"
};

/// Returns the domain of a field: the grid's, or the stated box of a formula.
scene::Domain domain_of(const scene::Scene& scene, scene::Entity field) {
  const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(field);
  if (source.loaded.get()->is_grid()) return {source.loaded.get()->mapping(), source.loaded.get()->index_box()};
  return {{}, {Vec3(source.box[0]), Vec3(source.box[1])}};
}

const scene::Slice* slice_of(const scene::Scene& scene, const scene::GlyphSet& set) {
  return set.support == On::slice ? &scene.entities.get<scene::Slice>(set.support_entity) : nullptr;
}

const scene::Isosurface* surface_of(const scene::Scene& scene, const scene::GlyphSet& set) {
  return set.support == On::isosurface ? &scene.entities.get<scene::Isosurface>(set.support_entity) : nullptr;
}

GlyphBasis basis_of(const scene::Scene& scene, const scene::GlyphSet& set) {
  GlyphBasis basis;
  basis.field = scene::loaded_field(scene, set.field).get()->version();
  const scene::Domain domain = domain_of(scene, set.field);
  basis.lo = domain.box.lo;
  basis.hi = domain.box.hi;
  if (set.color_by && set.color_by->source == scene::ColorBy::Source::field)
    basis.shown = scene::loaded_field(scene, set.color_by->field).get()->version();
  basis.point = set.point;
  basis.normal = set.normal;
  if (const scene::Slice* slice = slice_of(scene, set)) {
    basis.base = scene::rendered_field(scene, slice->color_by.field).get()->version();
    basis.point = slice->point;
    basis.normal = slice->normal;
  }
  if (const scene::Isosurface* surface = surface_of(scene, set)) {
    basis.base = scene::rendered_field(scene, surface->field).get()->version();
    basis.level = surface->level;
  }
  if (set.support == On::mesh) basis.base = scene.entities.get<scene::MeshSource>(set.support_entity).loaded->version();
  return basis;
}

Result<scene::UniformSamples> places_at(const scene::Scene& scene, const scene::GlyphSet& set, const GlyphBasis& basis, double spacing) {
  const scene::Domain domain = domain_of(scene, set.field);
  switch (set.support) {
    case On::box:
      return scene::sample_box(set.box ? scene::Domain{{}, *set.box} : domain, spacing, scene::kMaxGlyphs);
    case On::plane:
    case On::slice:
      return scene::sample_plane(domain, basis.point, basis.normal, spacing, scene::kMaxGlyphs);
    case On::mesh:
      return scene::sample_mesh(*scene.entities.get<scene::MeshSource>(set.support_entity).loaded, spacing, scene::kMaxGlyphs);
    case On::isosurface:
      break;
  }
  const scene::Isosurface& surface = *surface_of(scene, set);
  const field::AnyField& any = scene::rendered_field(scene, surface.field);
  if (!any.scalar)
    return json::error_at(json::member_or_parent(surface.where, "field"),
                          "\"" + entity_name(scene, surface.field) + "\" is a vector field; expected a scalar field for an isosurface");
  CATENA_CHECK(scene::check_level(*any.scalar, surface.level, json::member_or_parent(surface.where, "level")));
  return scene::sample_isosurface(*any.scalar, surface.level, spacing, scene::kMaxGlyphs);
}

/// Returns whether the hand can move the support. Such a set widens its spacing beyond the maximum count instead of reporting an error.
bool follows_hand(const scene::Scene& scene, const scene::GlyphSet& set) {
  const scene::Slice* slice = slice_of(scene, set);
  const scene::Isosurface* surface = surface_of(scene, set);
  return set.widget || (slice != nullptr && slice->widget) || (surface != nullptr && surface->level_widget);
}

Result<std::vector<Vec3>> places_of(const scene::Scene& scene, const scene::GlyphSet& set, const GlyphBasis& basis, double spacing) {
  const double max_count = static_cast<double>(scene::kMaxGlyphs);
  for (;;) {
    CATENA_TRY(scene::UniformSamples even, places_at(scene, set, basis, spacing));
    if (even.expected_count <= max_count) {
      const Outcome asked = check_text_memory_available(to_text(even.expected_count) + " glyphs", kGlyphBytes * even.expected_count);
      if (!asked) return with_cause(json::error_at(set.where, asked.error().message), asked.error());
      return std::move(even.positions);
    }
    if (follows_hand(scene, set) && std::isfinite(even.expected_count)) {
      spacing *= 1.05 * std::sqrt(even.expected_count / max_count);
      continue;
    }
    const std::string count = even.expected_count < 1e15 ? to_text(std::round(even.expected_count)) : to_text(even.expected_count);
    return json::error_at(json::member_or_parent(set.where, "spacing"), "a \"spacing\" of " + to_text(spacing) + " would give about " +
                                                                            count + " glyphs; a wider one that gives at most " +
                                                                            std::to_string(scene::kMaxGlyphs) + " was expected");
  }
}

/// Returns the vector at p, or axis x magnitude of a line field; zero where the field has no value.
Vec3 arrow_at(const scene::GlyphSet& set, const field::VectorField& field, const Vec3& p, field::Cursor& cursor) {
  Vec3 arrow(0.0);
  if (set.is_line_field) {
    const field::LineSample sample = field.sample_line(p, cursor);
    if (sample.inside) arrow = sample.speed * sample.axis;
  } else {
    const field::VectorSample sample = field.sample(p, cursor);
    if (sample.inside) arrow = sample.value;
  }
  return is_finite(arrow) && norm(arrow) > set.min_speed ? arrow : Vec3(0.0);
}

double value_at(const field::AnyField& shown, const Vec3& p, field::Cursor& cursor) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (shown.vector) {
    const field::VectorSample sample = shown.vector->sample(p, cursor);
    return sample.inside ? norm(sample.value) : none;
  }
  const field::ScalarSample sample = shown.scalar->sample(p, cursor);
  return sample.inside ? sample.value : none;
}

/// Makes the color table, sets each glyph's color and leaves out the glyphs outside the threshold.
Result<ColorTable> color_glyphs(const scene::Scene& scene, const scene::GlyphSet& set, const std::vector<Vec3>& places,
                                const std::vector<double>& speeds, std::vector<Glyph>& glyphs) {
  std::vector<double> values = speeds;
  field::AnyField shown = scene::loaded_field(scene, set.field);
  if (set.color_by->source == scene::ColorBy::Source::field) {
    field::Cursor cursor;
    shown = scene::loaded_field(scene, set.color_by->field);
    for (std::size_t i = 0; i < places.size(); ++i) values[i] = value_at(shown, places[i], cursor);
  }
  const DisplayRange range = field::display_range(values, shown);
  CATENA_CHECK(scene::check_mapping(*set.color_by, range.lo));
  ColorTable table = scene::make_color_table(set.color_by->colors, set.color_by->named, range.lo, range.hi);
  std::vector<Glyph> shown_glyphs;
  for (std::size_t i = 0; i < glyphs.size(); ++i) {
    if (!is_within(set.color_by->named.threshold, values[i])) continue;
    shown_glyphs.push_back({glyphs[i].tail, glyphs[i].tip, sample_color_table(table, values[i])});
  }
  glyphs = std::move(shown_glyphs);
  return table;
}

Result<MadeGlyphs> make_glyphs(const scene::Scene& scene, const scene::GlyphSet& set, const GlyphBasis& basis) {
  const field::AnyField& any = scene::loaded_field(scene, set.field);
  if (!any.vector)
    return json::error_at(json::member_or_parent(set.where, "field"),
                          "\"" + entity_name(scene, set.field) + "\" is a scalar field; expected a vector field for glyphs");
  const scene::Domain domain = domain_of(scene, set.field);
  const double diagonal = norm(domain.mapping.world_from_index_linear * (domain.box.hi - domain.box.lo));
  const double fitted = (set.support == On::box ? kBoxShare : kSurfaceShare) * diagonal, spacing = set.spacing > 0 ? set.spacing : fitted;
  CATENA_TRY(const std::vector<Vec3> all, places_of(scene, set, basis, spacing));

  // a slice is drawn only within the domain of its own field
  std::optional<scene::Domain> within;
  if (const scene::Slice* slice = slice_of(scene, set)) {
    const field::Field& slice_field = *scene::rendered_field(scene, slice->color_by.field).get();
    within = {slice_field.mapping(), slice_field.index_box()};
  }
  std::vector<Vec3> places, arrows;
  std::vector<double> speeds;
  field::Cursor cursor;
  for (const Vec3& p : all) {
    if (within && !within->box.contains(within->mapping.index_from_world(p), 1e-9)) continue;
    const Vec3 arrow = arrow_at(set, *any.vector, p, cursor);
    if (max_abs(arrow) == 0) continue;
    places.push_back(p);
    arrows.push_back(arrow);
    speeds.push_back(norm(arrow));
  }

  MadeGlyphs made;
  made.basis = basis;
  // vectors beyond the field's display range are drawn at the maximum length
  const DisplayRange range = field::display_range(speeds, any);
  const double fastest = range.hi;
  const double longest = set.length > 0 ? set.length : spacing, full = set.reference_speed > 0 ? set.reference_speed : fastest;
  made.shaft = set.radius > 0 ? set.radius / longest : kShaftShare;
  made.head = set.is_line_field ? 0 : std::min(kMaxHeadShare, kArrowLength * made.shaft);
  const double before = set.anchor == scene::GlyphSet::Anchor::tail ? 0 : set.anchor == scene::GlyphSet::Anchor::head ? 1 : 0.5;
  std::vector<Glyph> glyphs;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3 whole =
                   (set.constant_length ? longest : longest * (range.contains(speeds[i]) ? speeds[i] / full : 1)) * direction(arrows[i]),
               tail = places[i] - before * whole;
    glyphs.push_back({tail, tail + whole, set.color});
  }
  if (set.color_by) {
    CATENA_TRY(made.colors, color_glyphs(scene, set, places, speeds, glyphs));
  }
  made.glyphs = std::move(glyphs);
  return made;
}

Outcome prepare_glyphs(scene::Scene& scene) {
  for (const scene::Entity e : entities_with<scene::GlyphSet>(scene.entities)) {
    if (is_hidden(scene.entities, e)) continue;
    const scene::GlyphSet& set = scene.entities.get<scene::GlyphSet>(e);
    if (!scene.cache.has<MadeGlyphs>(e)) scene.cache.emplace<MadeGlyphs>(e);
    const GlyphBasis basis = basis_of(scene, set);
    if (scene.cache.get<MadeGlyphs>(e).basis == basis) continue;
    CATENA_TRY(MadeGlyphs made, make_glyphs(scene, set, basis));
    scene.cache.get<MadeGlyphs>(e) = std::move(made);
  }
  return Done{};
}

Outcome extract_glyphs(const scene::Scene& scene, FramePacket& packet) {
  scene.entities.each<scene::GlyphSet>([&](scene::Entity e, const scene::GlyphSet& set) {
    if (is_hidden(scene.entities, e)) return;
    const MadeGlyphs& made = scene.cache.get<MadeGlyphs>(e);
    const std::uint32_t id = packet.add_object("glyphs", entity_name(scene, set.field), set.where.label);
    packet.glyphs.push_back({made.glyphs, made.shaft, made.head, kArrowRadius * made.shaft, id, set.clipped});
  });
  return Done{};
}

Legend glyphs_legend(const scene::Scene& scene, scene::Entity item, const FramePacket&) {
  const scene::GlyphSet& set = scene.entities.get<scene::GlyphSet>(item);
  return colored_legend(scene, cached_colors<MadeGlyphs>(scene.cache, item), set.color_by, set.field);
}

}  // namespace

DrawableExtraction glyphs_extraction() { return {"glyphs", prepare_glyphs, extract_glyphs, glyphs_legend}; }

}  // namespace catena::render
