// SPDX-License-Identifier: MIT
/// Extracts streamline sets and the local flow indicator. Frame thread.
///   tubes    every line of a set is flattened once; with "color_by" each point is colored by the value there, using the table
///   arrows   cones on the line, at distances of "arrows", the seed's in the middle of the first gap
///   pulse    brightness travels along the line: a cosine of period `pulse` in arc length, moved by the scene's phase
#include "render/extract/extract_internal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/result.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/visibility.h"
#include "render/extract/flatten_streamlines.h"
#include "render/extract/legends.h"

namespace catena::render {

namespace {

constexpr double kIndicatorShare = 0.004;  // indicator radius / domain diagonal
constexpr double kIndicatorLength = 0.1;   // in units of L
constexpr double kMinBrightness = 0.25;    // minimum brightness between pulses

/// Returns the tube with its colors dimmed between the pulses.
TubeItem with_pulse(TubeItem tube, const std::vector<double>& arc, double pulse, double phase) {
  std::vector<Color> colors = tube.colors.empty() ? std::vector<Color>(tube.points.size(), tube.color) : tube.colors.list();
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (arc[i] / pulse - phase));
    const auto bright = static_cast<float>(kMinBrightness + (1 - kMinBrightness) * wave * wave);
    Color& c = colors[i];
    c = {bright * c.r, bright * c.g, bright * c.b};
  }
  tube.colors = std::move(colors);
  return tube;
}

}  // namespace

Color sample_color_table(const ColorTable& table, double value) {
  CATENA_ASSERT(!table.empty());
  if (std::isnan(value)) return {0.5f, 0.5f, 0.5f};
  if (value <= table.front().value) return table.front().color;
  if (value >= table.back().value) return table.back().color;
  const auto next = std::upper_bound(table.begin(), table.end(), value, [](double v, const auto& point) { return v < point.value; });
  const auto &a = *(next - 1), &b = *next;
  const auto t = static_cast<float>((value - a.value) / (b.value - a.value));
  return {a.color.r + t * (b.color.r - a.color.r), a.color.g + t * (b.color.g - a.color.g), a.color.b + t * (b.color.b - a.color.b)};
}

namespace {

Outcome prepare_streamlines(scene::Scene& scene) {
  for (const scene::Entity e : entities_with<scene::StreamlineSet>(scene.entities)) {
    if (is_hidden(scene.entities, e)) continue;
    if (!scene.cache.has<FlattenedStreamlines>(e)) scene.cache.emplace<FlattenedStreamlines>(e);
    const std::uint64_t version = scene::lines_version(scene, e);
    if (version != 0 && scene.cache.get<FlattenedStreamlines>(e).version == version) continue;
    CATENA_TRY(FlattenedStreamlines made, flatten_streamlines(scene, e));
    scene.cache.get<FlattenedStreamlines>(e) = std::move(made);
  }
  return Done{};
}

Outcome extract_streamlines(const scene::Scene& scene, FramePacket& packet) {
  scene.entities.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    if (is_hidden(scene.entities, e)) return;
    const FlattenedStreamlines& flat = scene.cache.get<FlattenedStreamlines>(e);
    const std::uint32_t id = packet.add_object("streamlines", entity_name(scene, set.field), set.where.label);
    const auto add = [&](auto& items, auto item) {
      item.id = id;
      item.is_clipped = set.clipped;
      items.push_back(std::move(item));
    };
    for (std::size_t i = 0; i < flat.tubes.size(); ++i)
      add(packet.tubes,
          set.band_length > 0 ? with_pulse(flat.tubes[i], flat.arc_lengths[i], set.band_length, scene.animation_phase) : flat.tubes[i]);
    for (const ArrowItem& arrow : flat.arrows) add(packet.arrows, arrow);
  });
  return Done{};
}

Legend streamlines_legend(const scene::Scene& scene, scene::Entity item, const FramePacket&) {
  const scene::StreamlineSet& set = scene.entities.get<scene::StreamlineSet>(item);
  return colored_legend(scene, cached_colors<FlattenedStreamlines>(scene.cache, item), set.color_by, set.field);
}

}  // namespace

DrawableExtraction streamlines_extraction() { return {"streamlines", prepare_streamlines, extract_streamlines, streamlines_legend}; }

Outcome extract_indicators(const scene::Scene& scene, FramePacket& packet) {
  for (const scene::Entity e : entities_with<scene::Indicator>(scene.entities)) {
    const scene::Indicator& indicator = scene.entities.get<scene::Indicator>(e);
    const field::AnyField& any = scene::loaded_field(scene, indicator.field);
    if (!any.vector) return json::error_at(indicator.where, "\"indicator\" names a scalar field; a vector field was expected");
    const double length = indicator.length > 0 ? indicator.length : kIndicatorLength * any.vector->domain_length();
    const double radius = indicator.radius > 0 ? indicator.radius : kIndicatorShare * domain_diagonal(*any.vector);
    for (const CursorItem& cursor : packet.cursors) {
      flow::TraceOptions options;
      options.length = indicator.starts_at_cursor ? length : 0.5 * length;
      options.tolerance = 1e-7;
      options.hermite_tolerance = 1e-6;
      const auto curve = flow::trace({any.vector.get()}, cursor.probe, options);
      if (!curve) continue;
      const flow::Knot& end = (*curve)->is_closed() ? (*curve)->knots().front() : (*curve)->knots().back();
      const bool cut = indicator.starts_at_cursor && !(*curve)->is_closed();
      std::vector<Vec3> points;
      if (cut) points.push_back(cursor.probe);
      for (const FlattenedPoint& flattened : flatten_with_arc_length(**curve, {radius}))
        if (!cut || flattened.arc_length > 0) points.push_back(flattened.position);
      if (points.size() < 2) continue;
      IndicatorItem item{{std::move(points), radius, indicator.color, {}},
                         {end.p, end.p + (kArrowLength * radius) * end.t, kArrowRadius * radius, indicator.color}};
      item.tube.id = packet.add_object("indicator", "");
      packet.indicators.push_back(std::move(item));
    }
  }
  return Done{};
}

}  // namespace catena::render
