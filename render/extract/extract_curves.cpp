// SPDX-License-Identifier: MIT
/// Extracts curves from files as tubes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/base/result.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/visibility.h"
#include "render/extract/colored_tubes.h"
#include "render/extract/extract_internal.h"
#include "render/extract/legends.h"

namespace catena::render {

namespace {

constexpr double kRadiusShare = 0.003;  // fitted tube radius / diagonal of the set
constexpr double kFullRadiusCurves = 300,
                 kMinRadiusFactor = 0.25;  // sets of more lines get thinner tubes, down to this share of the radius
constexpr std::size_t kBytesPerPoint = 160,
                      kBytesPerLine = 400;  // memory of a drawn point (position, color, ring on host and device) and of a tube item

/// Cached tubes of a curve set.
struct FlatCurves {
  curves::CurveSetPtr of;
  std::vector<TubeItem> tubes;
  ColorTable colors;  ///< from "color_by"
  std::string left_out;
};

/// Returns the indices of the drawn lines: all, or evenly spaced ones within the budget of points.
std::vector<std::size_t> drawn_lines(const curves::CurveSet& set) {
  const double share = std::min(1.0, static_cast<double>(kMaxCurvePoints) / static_cast<double>(set.points.size()));
  std::vector<std::size_t> lines;
  for (std::size_t k = 0; k < set.line_count(); ++k)
    if (share == 1 || std::floor(share * static_cast<double>(k + 1)) > std::floor(share * static_cast<double>(k))) lines.push_back(k);
  if (lines.empty()) lines.push_back(0);
  return lines;
}

/// Returns the color of each point by the line's direction, taken as the chord from the previous to the next point.
std::vector<Color> direction_colors(const std::vector<Vec3>& points) {
  std::vector<Color> colors;
  colors.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 along = direction(points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1]);
    colors.push_back(
        {static_cast<float>(std::fabs(along.x)), static_cast<float>(std::fabs(along.y)), static_cast<float>(std::fabs(along.z))});
  }
  return colors;
}

/// Evaluates the quantity of "color_by" at the points of a curve set.
class CurveValue {
 public:
  CurveValue(const scene::ColorBy& by, field::AnyField shown, const curves::PointValues* values)
      : by_(&by), shown_(std::move(shown)), values_(values) {}
  std::vector<double> of_line(const std::vector<Vec3>& points, std::size_t first) {
    std::vector<double> out;
    out.reserve(points.size());
    double way = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i > 0) way += norm(points[i] - points[i - 1]);
      out.push_back(by_->source == scene::ColorBy::Source::value        ? static_cast<double>(values_->values[first + i])
                    : by_->source == scene::ColorBy::Source::arc_length ? way
                                                                        : at(points[i]));
    }
    return out;
  }
  const field::AnyField& shown() const { return shown_; }

 private:
  double at(const Vec3& p) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (shown_.vector) {
      const field::VectorSample sample = shown_.vector->sample(p, cursor_);
      return sample.inside ? norm(sample.value) : none;
    }
    const field::ScalarSample sample = shown_.scalar->sample(p, cursor_);
    return sample.inside ? sample.value : none;
  }
  const scene::ColorBy* by_;
  field::AnyField shown_;
  const curves::PointValues* values_;
  field::Cursor cursor_;
};

Result<CurveValue> curve_value(scene::Scene& scene, const scene::ColorBy& by, const curves::CurveSet& set) {
  field::AnyField shown;
  if (by.source == scene::ColorBy::Source::field) {
    CATENA_TRY(shown, scene::resolve_field(scene, by.field, by.where));
  }
  const curves::PointValues* values = by.source == scene::ColorBy::Source::value ? set.find_values(by.value_name) : nullptr;
  if (by.source == scene::ColorBy::Source::value && values == nullptr) {
    std::vector<std::string_view> names;
    for (const curves::PointValues& one : set.values) names.push_back(one.name);
    return json::error_at(json::member_or_parent(by.where, "value"), "the file has no values called " + in_quotes(by.value_name) +
                                                                         "; known: " + (names.empty() ? "none" : join_words(names)) +
                                                                         ", one of them was expected" + suggestion(by.value_name, names));
  }
  return CurveValue(by, std::move(shown), values);
}

double fitted_radius(const curves::CurveSet& set) {
  const double many = std::sqrt(std::sqrt(kFullRadiusCurves / static_cast<double>(set.line_count())));
  return kRadiusShare * norm(set.max_corner - set.min_corner) * std::clamp(many, kMinRadiusFactor, 1.0);
}

Result<FlatCurves> flat_curves(scene::Scene& scene, const scene::CurvesSource& drawn, const std::string& name) {
  const curves::CurveSet& set = *drawn.loaded;
  FlatCurves flat;
  flat.of = drawn.loaded;
  const std::vector<std::size_t> lines = drawn_lines(set);
  std::size_t points = 0;
  for (const std::size_t k : lines) points += set.line_offsets[k + 1] - set.line_offsets[k];
  CATENA_CHECK(check_memory_available("drawing " + std::to_string(lines.size()) + " lines of curves " + in_quotes(name),
                                      static_cast<double>(points * kBytesPerPoint + lines.size() * kBytesPerLine)));
  if (lines.size() < set.line_count())
    flat.left_out = "curves " + in_quotes(name) + ": " + std::to_string(lines.size()) + " of " + std::to_string(set.line_count()) +
                    " lines are drawn, evenly chosen, so that they have about " + std::to_string(kMaxCurvePoints) + " points; all are felt";

  std::optional<CurveValue> value;
  if (drawn.color_by) {
    CATENA_TRY(value, curve_value(scene, *drawn.color_by, set));
  }
  const double radius = drawn.radius > 0 ? drawn.radius : fitted_radius(set);
  std::vector<std::vector<double>> values;
  std::vector<double> all;
  flat.tubes.reserve(lines.size());
  for (const std::size_t k : lines) {
    std::vector<Vec3> places(set.points.begin() + set.line_offsets[k], set.points.begin() + set.line_offsets[k + 1]);
    TubeItem tube{{}, radius, drawn.color.value_or(Color{}), {}};
    if (value) {
      values.push_back(value->of_line(places, set.line_offsets[k]));
      all.insert(all.end(), values.back().begin(), values.back().end());
    } else if (!drawn.color) {
      tube.colors = direction_colors(places);
    }
    tube.points = std::move(places);
    flat.tubes.push_back(std::move(tube));
  }
  if (value) {
    const DisplayRange range = field::display_range(all, value->shown());
    CATENA_CHECK(scene::check_mapping(*drawn.color_by, range.lo));
    flat.colors = scene::make_color_table(drawn.color_by->colors, drawn.color_by->named, range.lo, range.hi);
    std::vector<TubeItem> colored;
    for (std::size_t i = 0; i < values.size(); ++i)
      add_colored_tubes(flat.tubes[i], values[i], flat.colors, drawn.color_by->named.threshold, colored);
    flat.tubes = std::move(colored);
  }
  return flat;
}

Outcome prepare_curves(scene::Scene& scene) { return prepare_cached<FlatCurves, scene::CurvesSource>(scene, flat_curves); }

Outcome extract_curves(const scene::Scene& scene, FramePacket& packet) {
  scene.entities.each<scene::CurvesSource>([&](scene::Entity e, const scene::CurvesSource& drawn) {
    if (is_hidden(scene.entities, e)) return;
    const FlatCurves& flat = scene.cache.get<FlatCurves>(e);
    const std::uint32_t id = packet.add_object("curves", entity_name(scene, e), drawn.where.label);
    if (!flat.left_out.empty()) packet.omitted += (packet.omitted.empty() ? "" : "; ") + flat.left_out;
    for (TubeItem tube : flat.tubes) {
      tube.id = id;
      tube.is_clipped = drawn.clipped;
      packet.tubes.push_back(std::move(tube));
    }
  });
  return Done{};
}

Legend curves_legend(const scene::Scene& scene, scene::Entity item, const FramePacket&) {
  return colored_legend(scene, cached_colors<FlatCurves>(scene.cache, item), scene.entities.get<scene::CurvesSource>(item).color_by);
}

}  // namespace

DrawableExtraction curves_extraction() { return {"curves", prepare_curves, extract_curves, curves_legend}; }

}  // namespace catena::render
