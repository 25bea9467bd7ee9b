#include "render/extract/extract_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/result.h"
#include "engine/scene/hidden.h"
#include "engine/scene/lines.h"
#include "render/extract/flat_lines.h"

namespace catena::render {

namespace {

constexpr double kIndicatorShare = 0.004;  // radius by the domain's diagonal
constexpr double kIndicatorLength = 0.1;   // of L
constexpr double kDimmest = 0.25;          // brightness between pulses

/// The tube with its colours dimmed between the pulses.
TubeItem with_pulse(TubeItem tube, const std::vector<double>& arc, double pulse, double phase) {
  std::vector<Color> colors = tube.colors.empty() ? std::vector<Color>(tube.points.size(), tube.color) : tube.colors.list();
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (arc[i] / pulse - phase));
    const auto bright = static_cast<float>(kDimmest + (1 - kDimmest) * wave * wave);
    Color& c = colors[i];
    c = {bright * c.r, bright * c.g, bright * c.b};
  }
  tube.colors = std::move(colors);
  return tube;
}

}  // namespace

Color table_color(const ColorTable& table, double value) {
  CATENA_ASSERT(!table.empty());
  if (std::isnan(value)) return {0.5f, 0.5f, 0.5f};
  if (value <= table.front().value) return table.front().color;
  if (value >= table.back().value) return table.back().color;
  const auto next = std::upper_bound(table.begin(), table.end(), value, [](double v, const auto& point) { return v < point.value; });
  const auto &a = *(next - 1), &b = *next;
  const auto t = static_cast<float>((value - a.value) / (b.value - a.value));
  return {a.color.r + t * (b.color.r - a.color.r), a.color.g + t * (b.color.g - a.color.g), a.color.b + t * (b.color.b - a.color.b)};
}

const ColorTable* shown_colors(const scene::World& made, scene::Entity set) { return kept_colors<FlatLines>(made, set); }

Outcome prepare_streamlines(scene::Scene& scene) {
  for (const scene::Entity e : owners_of<scene::StreamlineSet>(scene.world)) {
    if (is_hidden(scene.world, e)) continue;
    if (!scene.made.has<FlatLines>(e)) scene.made.emplace<FlatLines>(e);
    const std::uint64_t version = scene::lines_version(scene, e);
    if (version != 0 && scene.made.get<FlatLines>(e).version == version) continue;
    CATENA_TRY(FlatLines made, flat_lines(scene, e));
    scene.made.get<FlatLines>(e) = std::move(made);
  }
  return Done{};
}

void extract_streamlines(const scene::Scene& scene, FramePacket& packet) {
  scene.world.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    if (is_hidden(scene.world, e)) return;
    const FlatLines& flat = scene.made.get<FlatLines>(e);
    const std::uint32_t id = packet.add_object("streamlines", name_of(scene, set.field), set.where.label);
    const auto add = [&](auto& items, auto item) {
      item.id = id;
      item.clipped = set.clipped;
      items.push_back(std::move(item));
    };
    for (std::size_t i = 0; i < flat.tubes.size(); ++i)
      add(packet.tubes, set.pulse > 0 ? with_pulse(flat.tubes[i], flat.arc_lengths[i], set.pulse, scene.phase) : flat.tubes[i]);
    for (const ArrowItem& arrow : flat.arrows) add(packet.arrows, arrow);
  });
}

Outcome extract_indicators(const scene::Scene& scene, FramePacket& packet) {
  for (const scene::Entity e : owners_of<scene::Indicator>(scene.world)) {
    const scene::Indicator& indicator = scene.world.get<scene::Indicator>(e);
    const field::AnyField& any = scene::loaded_field(scene, indicator.field);
    if (!any.vector) return json::error_at(indicator.where, "\"indicator\" names a scalar field; a vector field was expected");
    const double length = indicator.length > 0 ? indicator.length : kIndicatorLength * any.vector->length();
    const double radius = indicator.radius > 0 ? indicator.radius : kIndicatorShare * domain_diagonal(*any.vector);
    for (const CursorItem& cursor : packet.cursors) {
      flow::TraceOptions options;
      options.length = indicator.ahead ? length : 0.5 * length;
      options.tolerance = 1e-7;
      options.hermite_tolerance = 1e-6;
      const auto curve = flow::trace({any.vector.get()}, cursor.probe, options);
      if (!curve) continue;
      const flow::Knot& end = (*curve)->closed() ? (*curve)->knots().front() : (*curve)->knots().back();
      const bool cut = indicator.ahead && !(*curve)->closed();
      std::vector<Vec3> points;
      if (cut) points.push_back(cursor.probe);
      for (const FlatPoint& place : flatten_places(**curve, {radius}))
        if (!cut || place.s > 0) points.push_back(place.p);
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
