// SPDX-License-Identifier: MIT
#include "engine/scene/default_visualization.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/field/derived/label_surface.h"
#include "engine/geometry/flow/seeds.h"
#include "engine/scene/auto_transfer.h"
#include "engine/scene/classify_scalar.h"
#include "engine/scene/classify_vector.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/opacity_presets.h"
#include "engine/scene/readers.h"
#include "engine/scene/to_json.h"

namespace catena::scene {
namespace {

constexpr Color kBone{0.94f, 0.89f, 0.79f}, kSkin{0.87f, 0.67f, 0.56f}, kTissue{0.86f, 0.76f, 0.69f}, kSolid{0.72f, 0.77f, 0.84f};
constexpr double kSkinLevel = -300, kBoneLevel = 250, kSkinOpacity = 0.25, kShellOpacity = 0.2;
constexpr double kMeanDepth = 3.5, kMaxDepth = 12, kLowDepth = 0.5;                          // optical depths along a ray across the domain
constexpr double kTailOpacity = 0.25, kPeakOpacity = 0.8;                                    // of a statistic's tails, per voxel
constexpr double kPhaseRamp = 0.04, kPhaseOpacity = 0.9;                                     // two phases: half width by range; per voxel
constexpr double kMostlyEmpty = 0.5;                                                         // background as a fraction of the values
constexpr double kApart = 1.0 / 17, kLineWidth = 0.0035, kLineLength = 2, kNarrowest = 0.3;  // relative to the domain's diagonal
constexpr Color kDarkPhase{0.50f, 0.54f, 0.60f}, kLightPhase{0.99f, 0.97f, 0.92f};
constexpr Color kFibre{0.90f, 0.62f, 0.42f};
constexpr double kFlat = 1, kWide = 7;  // cells: a single image has at most kFlat along one axis and at least kWide along the others
constexpr std::string_view kQuantityMap = kDefaultVolumeColorMap;

/// Returns whether an isosurface of this level can exist: the level lies within the range of values.
bool has_level(const field::ScalarGrid& grid, double level) {
  const DisplayRange& range = display_range(grid);
  return level > range.lo && level < range.hi;
}

/// Rounds a value to a thousandth of the range.
double rounded(double value, const ScalarStats& facts) {
  const double step = std::pow(10, std::floor(std::log10(std::max(facts.hi - facts.lo, 1e-30))) - 2);
  return std::round(value / step) * step;
}

double three_digits(double value) { return round_to_digits(value, 3); }

std::string surface(const std::string& field, double level, const Color& color, double opacity = 1) {
  return "{\"field\": " + field + ", \"level\": " + to_json(level) + ", \"color\": " + to_json(color) +
         (opacity < 1 ? ", \"opacity\": " + to_json(opacity) : "") + "}";
}

std::string surfaces(const std::vector<std::string>& items) {
  std::string text = "  \"isosurfaces\": [";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i > 0 ? ",\n                  " : "") + items[i];
  return text + "]";
}

/// Returns a scalar bar; its title is the name of the colored object, with its unit.
std::string bar_of(const std::string& what, bool box = true) {
  return ",\n  \"scalar_bars\": [{" + what + "}]" + (box ? ",\n  \"bounding_box\": true" : "");
}

/// Returns the range about 0 that contains the range; -1 to 1 if all values are 0.
std::array<double, 2> symmetric_range(const DisplayRange& range) {
  const double largest = std::max(std::fabs(range.lo), std::fabs(range.hi));
  return largest > 0 ? std::array{-largest, largest} : std::array{-1.0, 1.0};
}

/// Returns a volume in the requested colors. A named color map without a range covers the values that the opacity covers, not all values.
std::string colored_volume(const std::string& field, const field::ScalarGrid& grid, NamedColors colors) {
  if (!colors.map.empty() && !colors.range) {
    TransferFunction transfer;
    transfer.named.mapping = colors.mapping;
    complete_transfer(transfer, grid);
    const double lo = transfer.colors.front().value, hi = transfer.colors.back().value;
    if (is_color_range(lo, hi)) colors.range = {lo, hi};
  }
  return "  \"volumes\": [{\"field\": " + field + color_members(colors) + ", \"shade\": true}]";
}

/// Returns a volume in the requested colors and opacities.
std::string requested_volume(const std::string& field, const field::ScalarGrid& grid, const FileColors& colors) {
  const OpacityPreset* found = find_opacity_preset(colors.preset);
  if (found != nullptr) {
    const DisplayRange& range = field::display_range(grid);
    const OpacityPreset preset = scaled_to(*found, range.lo, range.lo < range.hi ? range.hi : range.lo + 1);
    return "  \"volumes\": [{\"field\": " + field + ", \"color\": " + to_json(preset.colors) +
           ", \"opacity\": " + to_json(preset.opacities) +
           (preset.is_projection ? ", \"projection\": \"maximum\"}]" : ", \"shade\": true}]");
  }
  if (colors.opacities.empty()) return colored_volume(field, grid, colors.named);
  NamedColors named = colors.named;
  const double lo = colors.opacities.front().value, hi = colors.opacities.back().value;
  if (named.map.empty()) named.map = kDefaultVolumeColorMap;
  if (!named.range && is_color_range(lo, hi)) named.range = {lo, hi};
  return "  \"volumes\": [{\"field\": " + field + color_members(named) + ", \"opacity\": " + to_json(colors.opacities) +
         ", \"shade\": true}]";
}

std::string quantity(const std::string& field, const field::ScalarGrid& grid, const ScalarStats& facts) {
  double lo = rounded(facts.lo, facts), hi = rounded(facts.hi, facts);
  if (!is_color_range(lo, hi)) return colored_volume(field, grid, {std::string(kQuantityMap), {}});
  // the background is omitted; without one, low values may be visible, too
  const bool empty = facts.background_share > kMostlyEmpty;
  const double clear = 1 / std::max(grid.domain_length(), 1e-300);
  std::string text = "  \"volumes\": [{\"field\": " + field + ", \"color\": " + to_json(kQuantityMap) +
                     ", \"range\": " + to_json(std::array<double, 2>{lo, hi}) + ",\n               \"extinction\": ";
  std::string rows = "[";
  const double mean = std::max((facts.mean - facts.lo) / (facts.hi - facts.lo), 1e-3);
  const double max_depth = std::clamp(kMeanDepth / mean, kMeanDepth, kMaxDepth);
  for (const auto& [share, depth] : {std::pair{0.0, empty ? 0.0 : kLowDepth}, {0.1, kLowDepth}, {1.0, max_depth}})
    rows += (share > 0 ? ", [" : "[") + to_json(rounded(lo + share * (hi - lo), facts)) + ", " + to_json(three_digits(depth * clear)) + "]";
  text += rows + "]}]";
  return text + bar_of("\"volume\": 0");
}

std::string computed_tomography(const std::string& field, const field::ScalarGrid& grid, const ScalarStats& facts) {
  std::vector<std::string> items;
  const bool bone = has_level(grid, kBoneLevel);
  if (bone) items.push_back(surface(field, kBoneLevel, kBone));
  if (has_level(grid, kSkinLevel)) items.push_back(surface(field, kSkinLevel, kSkin, bone ? kSkinOpacity : 1));
  return items.empty() ? quantity(field, grid, facts) : surfaces(items);
}

std::string angiogram(const std::string& field, const ScalarStats& facts) {
  const double lo = rounded(facts.background, facts), hi = rounded(facts.hi, facts);
  return "  \"volumes\": [{\"field\": " + field + ", \"color\": \"grey\", \"range\": " + to_json(std::array<double, 2>{lo, hi}) +
         ", \"opacity\": [[" + to_json(lo) + ", 0], [" + to_json(hi) + ", 0.95]], \"projection\": \"maximum\"}]" +
         bar_of("\"volume\": 0", false);
}

/// Returns the two tails of a statistic, blue and red about 0. Of values of one sign, the upper tail.
std::string statistic(const std::string& field, const field::ScalarGrid& grid, const ScalarStats& facts, NamedColors colors) {
  const DisplayRange& range = display_range(grid);
  const double largest = std::max(std::fabs(range.lo), std::fabs(range.hi)), from = rounded(facts.strong_magnitude, facts);
  if (!is_color_range(from, largest)) return colored_volume(field, grid, std::move(colors));
  const double top = three_digits(std::max(std::fabs(facts.lo), std::fabs(facts.hi)));
  const double end = is_color_range(from, top) ? top : largest;
  const bool both = range.lo < -from;
  if (colors.map.empty()) colors.map = both ? "cool-warm" : "inferno";
  if (!colors.range) colors.range = {both ? -end : 0, end};
  if (colors.threshold.empty()) {
    if (both) colors.threshold.push_back({-largest, -from});
    colors.threshold.push_back({from, largest});
  }
  const double weakest = std::min(std::fabs(colors.threshold.front()[1]), std::fabs(colors.threshold.back()[0]));
  const double strongest = std::max({weakest, std::fabs((*colors.range)[0]), std::fabs((*colors.range)[1])}) + 1e-9 * largest;
  std::vector<TransferFunction::OpacityPoint> opacities{{weakest, kTailOpacity}, {strongest, kPeakOpacity}};
  if (both) opacities = {{-strongest, kPeakOpacity}, {-weakest, kTailOpacity}, {weakest, kTailOpacity}, {strongest, kPeakOpacity}};
  return "  \"volumes\": [{\"field\": " + field + color_members(colors) + ", \"opacity\": " + to_json(opacities) + ", \"shade\": true}]" +
         bar_of("\"volume\": 0");
}

/// Returns a volume of values over several powers of ten, on a logarithmic scale.
std::string decades(const std::string& field, const field::ScalarGrid& grid, const ScalarStats& facts) {
  const double lo = three_digits(facts.low), hi = three_digits(facts.brightest);
  if (!is_color_range(lo, hi)) return colored_volume(field, grid, {"inferno", {}});
  const double clear = 1 / std::max(grid.domain_length(), 1e-300);
  std::string rows;
  for (const auto& [share, depth] : {std::pair{0.0, 0.0}, {0.4, kLowDepth}, {1.0, 10 * kMaxDepth}})
    rows += (rows.empty() ? "[" : ", [") + to_json(three_digits(lo * std::pow(hi / lo, share))) + ", " +
            to_json(three_digits(depth * clear)) + "]";
  return "  \"volumes\": [{\"field\": " + field + ", \"color\": \"inferno\", \"range\": " + to_json(std::array{lo, hi}) +
         ", \"mapping\": \"log\",\n               \"extinction\": [" + rows + "]}]" + bar_of("\"volume\": 0");
}

/// Returns a volume that is opaque above the threshold between two phases.
std::string two_phases(const std::string& field, const ScalarStats& facts) {
  const double width = kPhaseRamp * (facts.hi - facts.lo), hi = rounded(facts.hi, facts);
  const double from = rounded(facts.threshold - width, facts), to = rounded(facts.threshold + width, facts);
  const std::vector<TransferFunction::ColorPoint> colors{{from, kDarkPhase}, {std::max(hi, to), kLightPhase}};
  const std::vector<TransferFunction::OpacityPoint> opacities{{from, 0}, {to, kPhaseOpacity}};
  return "  \"volumes\": [{\"field\": " + field + ", \"color\": " + to_json(colors) + ", \"opacity\": " + to_json(opacities) +
         ", \"shade\": true}]" + bar_of("\"volume\": 0");
}

/// Returns the axis along which the grid is a single image, or -1.
int flat_axis(const field::ScalarGrid& grid) {
  const Vec3 size = grid.index_box().hi - grid.index_box().lo;
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] <= kFlat && std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]) >= kWide) return axis;
  return -1;
}

/// Returns the members of a single image: a slice with a linear gray map from lo to hi.
std::string image(const std::string& field, const field::ScalarGrid& grid, int axis, const ScalarStats& facts, NamedColors colors) {
  const Vec3 middle = grid.mapping().world_from_index(0.5 * (grid.index_box().lo + grid.index_box().hi));
  if (colors.map.empty()) colors.map = facts.is_integral || facts.is_patient_space ? "grey" : kQuantityMap;
  if (!colors.range && is_color_range(rounded(facts.lo, facts), rounded(facts.hi, facts)))
    colors.range = {rounded(facts.lo, facts), rounded(facts.hi, facts)};
  const Vec3 normal = direction(grid.mapping().world_from_index_gradient(Vec3(axis == 0, axis == 1, axis == 2)));
  return "  \"slices\": [{\"field\": " + field + ", \"point\": " + to_json(middle) + ", \"normal\": " + to_json(normal) +
         color_members(colors) + "}]" + bar_of("\"slice\": 0", false);
}

}  // namespace

// faces between two labels of a group are hidden, and one surface per label would cost many times as much
void show_label_groups(const std::string& field, const std::vector<LabelGroup>& groups, DefaultVisualization& visualization) {
  std::vector<std::string> items;
  visualization.extra_fields.clear();
  for (const LabelGroup& group : groups) {
    if (group.opacity == 0) continue;
    const std::string number = items.empty() ? "" : "_" + std::to_string(items.size() + 1);
    const std::string surface = json::serialize_string(field.substr(1, field.size() - 2) + "_labels" + number);
    const std::string labels = group.values.empty() ? "\"*\"" : to_json(group.values);
    visualization.extra_fields += ",\n             " + surface + ": {\"label\": " + labels + ", \"of\": " + field + "}";
    items.push_back("{\"field\": " + surface + ", \"level\": " + to_json(field::kLabelLevel) + ", \"color_by\": {\"field\": " + field +
                    "}" + (group.opacity < 1 ? ", \"opacity\": " + to_json(group.opacity) : "") + "}");
  }
  visualization.scene_members = surfaces(items) + bar_of("\"field\": " + field, false);
}

std::string color_members(const NamedColors& colors) {
  std::string text;
  for (const auto& [key, value] : color_scale_members({}, colors)) text += ", \"" + key + "\": " + value;
  return text;
}

DefaultVisualization choose_default_visualization(const std::string& field, const field::ScalarGrid& grid, const field::Units& units,
                                                  const FileColors& requested) {
  FileColors colors = requested;
  if (colors.is_symmetric) colors.named.range = symmetric_range(display_range(grid));
  const ScalarStats facts = compute_scalar_stats(grid, units);
  DataKind kind = classify_scalar(facts);
  // a sample of the voxels may look like a label map although the complete grid is not
  if (kind == DataKind::label_map && !field::count_labels(grid)) kind = DataKind::solid;
  DefaultVisualization visualization;
  visualization.ignore_mask = facts.has_mask && (kind == DataKind::ct || kind == DataKind::mr || kind == DataKind::solid);
  visualization.note = "looks like " + std::string(to_string(kind)) + ": " + explain_kind(kind, facts);
  const DisplayRange& range = display_range(grid);
  const bool one_value = !(range.lo < range.hi);
  if (one_value)
    visualization.note = std::string(range.has_outliers() ? "every other value is " : "every value is ") + format_readable(range.lo);
  const auto level = [&](double value) {
    return has_level(grid, rounded(value, facts)) ? rounded(value, facts) : 0.5 * (range.lo + range.hi);
  };
  const double opacity = colors.overlay.empty() ? 1 : kShellOpacity;
  const auto body = [&](double at) {
    visualization.shell_members = surfaces({surface(field, at, kSolid, kShellOpacity)});
    return surfaces({surface(field, at, kSolid, opacity)});
  };
  if (const int axis = flat_axis(grid); axis >= 0) {
    visualization.note = "is a single image";
    visualization.scene_members = image(field, grid, axis, facts, colors.named);
    return visualization;
  }
  if (colors.is_overlay && kind != DataKind::label_map && !colors.makes_volume() && !one_value) {
    visualization.note = "is drawn over the other data where its values are strong";
    visualization.scene_members = statistic(field, grid, facts, colors.named);
  } else if ((!colors.is_default() && !colors.is_overlay) || colors.makes_volume() || one_value) {
    visualization.scene_members = requested_volume(field, grid, colors);
  } else {
    switch (kind) {
      case DataKind::ct:
        visualization.scene_members = computed_tomography(field, grid, facts);
        break;
      case DataKind::mr:
        visualization.scene_members = surfaces({surface(field, level(0.5 * (facts.background + facts.threshold)), kTissue, opacity)});
        break;
      case DataKind::label_map:
        visualization.is_label_map = true;
        show_label_groups(field, {{}}, visualization);
        break;
      case DataKind::solid:
        visualization.scene_members = body(level(facts.threshold));
        break;
      case DataKind::level_set:
        visualization.scene_members = body(level(0));
        break;
      case DataKind::angiogram:
        visualization.scene_members = angiogram(field, facts);
        break;
      case DataKind::statistic:
        visualization.scene_members = statistic(field, grid, facts, {});
        break;
      case DataKind::decades:
        visualization.scene_members = decades(field, grid, facts);
        break;
      case DataKind::inclusions:
        visualization.scene_members = surfaces({surface(field, level(facts.background + 0.5 * (facts.brightest - facts.background)), kBone),
                                                surface(field, level(facts.body_threshold), kSolid, kShellOpacity)});
        break;
      case DataKind::two_phases:
        visualization.scene_members = two_phases(field, facts);
        break;
      case DataKind::cloud:
        visualization.scene_members = colored_volume(field, grid, {"grey", {}});
        break;
      case DataKind::simulation:
        visualization.scene_members = quantity(field, grid, facts);
        break;
    }
  }
  return visualization;
}

DefaultVisualization choose_default_visualization(const std::string& field, const field::VectorGrid& grid, const NamedColors& colors) {
  const VectorStats facts = compute_vector_stats(grid);
  const double diagonal = grid.world_bounds().diagonal();
  // where most of the field is stagnant, the moving region is narrow
  const bool narrow = facts.median_speed < kStillSpeedRatio * facts.fast_speed;
  const double size = narrow ? std::clamp(std::cbrt(facts.moving_share), kNarrowest, 1.0) : 1;
  const double distance = three_digits(kApart * size * diagonal), radius = three_digits(kLineWidth * std::sqrt(size) * diagonal);
  const bool named = !colors.is_default(), plain = (facts.is_unit_length || facts.is_line_field) && !named;
  DefaultVisualization visualization;
  visualization.is_fibers = facts.is_unit_length;
  visualization.note = facts.is_unit_length  ? "looks like fibres: all vectors have the same length"
                       : facts.is_line_field ? "looks like fibres: the signs of neighbouring vectors are random"
                                             : "looks like a flow";
  NamedColors specified = colors;
  if (colors.map.empty() && !colors.range) specified.map = kQuantityMap;
  const std::array<double, 2> speeds{three_digits(facts.slow_speed), three_digits(facts.fast_speed)};
  if (!specified.range && is_color_range(speeds[0], speeds[1])) specified.range = speeds;

  // streamlines are shown only if at least one of them is as long as the line distance
  const double still = narrow ? three_digits(kStillSpeedRatio * facts.fast_speed) : 0;
  flow::EvenSpacingOptions spacing{distance, 0.5, facts.fastest_points, 1};
  flow::BatchOptions options;
  options.length = three_digits(kLineLength * diagonal);
  if (!(facts.fast_speed > 0)) {
    visualization.note = "looks like a flow at rest";
    visualization.scene_members = "  \"streamlines\": []";
  } else if (flow::trace_evenly_spaced({&grid, facts.is_line_field, still}, spacing, options).empty()) {
    const Vec3 middle = grid.mapping().world_from_index(0.5 * (grid.index_box().lo + grid.index_box().hi));
    visualization.scene_members = "  \"slices\": [";
    for (int axis = 0; axis < 3; ++axis)
      visualization.scene_members += std::string(axis > 0 ? ",\n             " : "") + "{\"field\": " + field + ", \"axis\": \"" +
                                     "xyz"[axis] + "\", \"at\": " + to_json(middle[axis]) + color_members(specified) + "}";
    visualization.scene_members += "]" + bar_of("\"slice\": 0");
  } else {
    visualization.scene_members = "  \"streamlines\": [{\"field\": " + field;
    if (facts.is_line_field) visualization.scene_members += ", \"kind\": \"line\"";
    if (still > 0) visualization.scene_members += ", \"min_speed\": " + to_json(still);
    visualization.scene_members +=
        plain ? ", \"color\": " + to_json(kFibre) : ", \"color_by\": {\"quantity\": \"speed\"" + color_members(specified) + "}";
    visualization.scene_members += ", \"radius\": " + to_json(radius) + ", \"length\": " + to_json(options.length) +
                                   ",\n                   \"seeds\": {\"evenly_spaced\": {\"distance\": " + to_json(distance) +
                                   ",\n                                               \"start\": " + to_json(facts.fastest_points) + "}}}]";
    if (!plain) visualization.scene_members += bar_of("\"streamlines\": 0");
  }
  return visualization;
}

}  // namespace catena::scene
