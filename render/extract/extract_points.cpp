// SPDX-License-Identifier: MIT
/// Extracts points from tables as spheres.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/base/result.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/visibility.h"
#include "render/extract/extract_internal.h"
#include "render/extract/legends.h"

namespace catena::render {

namespace {

constexpr double kSpacingShare = 0.35;                              // fitted radius / distance of neighbors
constexpr double kMinRadiusShare = 0.0012, kMaxRadiusShare = 0.02;  // bounds of the fitted radius / diagonal of the set without outliers
constexpr double kBytesPerSphere = 80;                              // position, radius, color and value on host and device

/// Cached spheres of a point set.
struct FlatPoints {
  curves::PointSetPtr of;
  std::shared_ptr<const SphereSet> balls;
  ColorTable colors;  ///< from "color_by"
  std::string left_out;
};

/// Returns the column named `name`. Error: at the key `key`, if there is none.
Result<const std::vector<float>*> column_of(const curves::PointSet& set, const json::Node& where, const char* key,
                                            const std::string& name) {
  if (const curves::PointValues* found = set.find_values(name)) return &found->values;
  std::vector<std::string_view> names;
  for (const curves::PointValues& one : set.values) names.push_back(one.name);
  return json::error_at(json::member_or_parent(where, key), "the table has no column of numbers called " + in_quotes(name) +
                                                                "; known: " + (names.empty() ? "none" : join_words(names)) +
                                                                ", one of them was expected" + suggestion(name, names));
}

double fitted_ball(const curves::PointSet& set) {
  const double diagonal = set.robust_bounds.box.diagonal();
  if (!(diagonal > 0)) return 1;
  return std::clamp(kSpacingShare * set.median_spacing, kMinRadiusShare * diagonal, kMaxRadiusShare * diagonal);
}

/// Returns the field's value (of a vector field: the magnitude) at each point; NaN outside of its domain.
std::vector<float> field_values(const field::AnyField& shown, const curves::PointSet& set) {
  field::Cursor cursor;
  std::vector<float> values;
  values.reserve(set.points.size());
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    const Vec3 p = set.position(i);
    double value = std::numeric_limits<double>::quiet_NaN();
    if (shown.vector) {
      if (const auto sample = shown.vector->sample(p, cursor); sample.inside) value = norm(sample.value);
    } else if (const auto sample = shown.scalar->sample(p, cursor); sample.inside) {
      value = sample.value;
    }
    values.push_back(static_cast<float>(value));
  }
  return values;
}

Result<FlatPoints> flat_points(scene::Scene& scene, const scene::PointsSource& drawn, const std::string& name) {
  const curves::PointSet& set = *drawn.loaded;
  FlatPoints flat;
  flat.of = drawn.loaded;
  const std::size_t count = std::min(set.points.size(), kMaxSpheres);
  CATENA_CHECK(check_memory_available("drawing " + std::to_string(count) + " points of " + in_quotes(name),
                                      kBytesPerSphere * static_cast<double>(count)));
  if (count < set.points.size())
    flat.left_out = "points " + in_quotes(name) + ": " + std::to_string(count) + " of " + std::to_string(set.points.size()) +
                    " are drawn, evenly chosen; all are felt";

  const std::vector<float>* radii = nullptr;
  if (!drawn.radius_by.empty()) {
    CATENA_TRY(radii, column_of(set, drawn.where, "radius_by", drawn.radius_by));
  } else if (!(drawn.radius > 0) && set.find_values("radius") != nullptr) {
    radii = &set.find_values("radius")->values;
  }
  std::vector<float> sampled;
  field::AnyField shown;
  const std::vector<float>* values = nullptr;
  if (drawn.color_by && drawn.color_by->source == scene::ColorBy::Source::value) {
    CATENA_TRY(values, column_of(set, drawn.color_by->where, "value", drawn.color_by->value_name));
  } else if (drawn.color_by) {
    CATENA_TRY(shown, scene::resolve_field(scene, drawn.color_by->field, drawn.color_by->where));
    sampled = field_values(shown, set);
    values = &sampled;
  }
  if (values != nullptr) {
    const DisplayRange range = field::display_range(std::vector<double>(values->begin(), values->end()), shown);
    CATENA_CHECK(scene::check_mapping(*drawn.color_by, range.lo));
    flat.colors = scene::make_color_table(drawn.color_by->colors, drawn.color_by->named, range.lo, range.hi);
  }

  // points without a positive finite radius are not drawn
  const auto fitted = static_cast<float>(drawn.radius > 0 ? drawn.radius : fitted_ball(set));
  auto balls = std::make_shared<SphereSet>();
  balls->origin = set.origin;
  balls->offsets.reserve(count);
  balls->radii.reserve(count);
  balls->colors.reserve(count);
  if (set.robust_bounds.outliers > 0) balls->robust_bounds = set.robust_bounds.box;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = k * set.points.size() / count;
    const float radius = radii != nullptr ? (*radii)[i] : fitted;
    if (!(radius > 0) || (values != nullptr && !is_within(drawn.color_by->named.threshold, double((*values)[i])))) continue;
    balls->offsets.push_back(set.points[i]);
    balls->radii.push_back(radius);
    balls->colors.push_back(values != nullptr ? sample_color_table(flat.colors, double((*values)[i])) : drawn.color);
  }
  flat.balls = std::move(balls);
  return flat;
}

Outcome prepare_points(scene::Scene& scene) { return prepare_cached<FlatPoints, scene::PointsSource>(scene, flat_points); }

Outcome extract_points(const scene::Scene& scene, FramePacket& packet) {
  scene.entities.each<scene::PointsSource>([&](scene::Entity e, const scene::PointsSource& drawn) {
    if (is_hidden(scene.entities, e)) return;
    const FlatPoints& flat = scene.cache.get<FlatPoints>(e);
    if (!flat.left_out.empty()) packet.omitted += (packet.omitted.empty() ? "" : "; ") + flat.left_out;
    packet.spheres.push_back({flat.balls, packet.add_object("points", entity_name(scene, e), drawn.where.label), drawn.clipped});
  });
  return Done{};
}

Legend points_legend(const scene::Scene& scene, scene::Entity item, const FramePacket&) {
  return colored_legend(scene, cached_colors<FlatPoints>(scene.cache, item), scene.entities.get<scene::PointsSource>(item).color_by);
}

}  // namespace

DrawableExtraction points_extraction() { return {"points", prepare_points, extract_points, points_legend}; }

}  // namespace catena::render
