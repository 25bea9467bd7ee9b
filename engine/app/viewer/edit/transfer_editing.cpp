// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/transfer_editing.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/base/result.h"
#include "engine/base/symlog_scale.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/to_json.h"

namespace catena::app {

namespace {

constexpr double kGap = 1e-4;  // fraction of the plot: minimum distance of neighbors, unless they were closer before the edit

template <class Points>
bool rises(const Points& points) {
  const auto falls = [](const auto& a, const auto& b) { return !(a.value < b.value); };
  return std::adjacent_find(points.begin(), points.end(), falls) == points.end();
}

/// Position of a point between `below` and `above` (either may be null) when it is moved to `value`; std::nullopt if no space is left.
std::optional<double> between(const double* below, const double* above, const PlotTransform& frame, double value) {
  if (!std::isfinite(value)) return std::nullopt;
  // in the coordinates of the plot's scale
  const auto place = [&](double v) { return symlog(v, frame.linear_below); };
  const double lo = place(frame.lo), hi = place(frame.hi), gap = kGap * (hi - lo);
  const double minimum = below ? place(*below) + gap : lo, maximum = above ? place(*above) - gap : hi;
  double to = std::clamp(place(value), minimum, std::max(minimum, maximum));
  // no space: the only neighbor lies beyond the plot, or two neighbors are too close
  if (!(minimum <= maximum)) to = !above ? minimum : !below ? maximum : 0.5 * place(*below) + 0.5 * place(*above);
  if (to != place(value)) value = symlog_inverse(to, frame.linear_below);
  if ((below && !(*below < value)) || (above && !(value < *above)) || !std::isfinite(value)) return std::nullopt;
  return value;
}

template <class Points>
std::optional<double> place_of(const Points& points, const PlotTransform& frame, std::size_t index, double value) {
  const double* below = index > 0 ? &points[index - 1].value : nullptr;
  const double* above = index + 1 < points.size() ? &points[index + 1].value : nullptr;
  return between(below, above, frame, value);
}

template <class Points>
std::optional<std::size_t> insert(Points& points, const PlotTransform& frame, typename Points::value_type point) {
  const auto next = std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.value >= point.value; });
  const double* below = next != points.begin() ? &(next - 1)->value : nullptr;
  const double* above = next != points.end() ? &next->value : nullptr;
  const std::optional<double> value = between(below, above, frame, point.value);
  if (!value) return std::nullopt;
  point.value = *value;
  const auto index = next - points.begin();
  points.insert(next, point);
  return static_cast<std::size_t>(index);
}

template <class Points>
bool take_out(Points& points, std::size_t index) {
  CATENA_ASSERT(index < points.size());
  if (points.size() < 2) return false;
  points.erase(points.begin() + static_cast<std::ptrdiff_t>(index));
  return true;
}

double usable(double alpha) { return std::isfinite(alpha) ? std::clamp(alpha, 0.0, kMaxAlpha) : 0.0; }

/// The points on either side of a value and their distance on the plot's scale.
template <class Points>
auto around(const Points& points, double value, double linear_below) {
  struct Pieces {
    const typename Points::value_type *a, *b;
    double t;
  };
  if (!(value > points.front().value)) return Pieces{&points.front(), &points.front(), 0};
  if (value >= points.back().value) return Pieces{&points.back(), &points.back(), 0};
  const auto next = std::upper_bound(points.begin(), points.end(), value, [](double v, const auto& p) { return v < p.value; });
  const auto place = [&](double v) { return symlog(v, linear_below); };
  const double from = place((next - 1)->value), to = place(next->value);
  return Pieces{&*(next - 1), &*next, (place(value) - from) / (to - from)};
}

}  // namespace

std::optional<std::size_t> find_point(const OpacityPoints& points, const PlotTransform& frame, double x, double y, double max_distance_px) {
  std::optional<std::size_t> found;
  double nearest = max_distance_px;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = std::hypot(frame.to_x(points[i].value) - x, frame.to_y(points[i].alpha) - y);
    if (distance <= nearest) nearest = distance, found = i;
  }
  return found;
}

std::optional<std::size_t> find_point(const ColorPoints& points, const PlotTransform& frame, double x, double max_distance_px) {
  std::optional<std::size_t> found;
  double nearest = max_distance_px;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = std::fabs(frame.to_x(points[i].value) - x);
    if (distance <= nearest) nearest = distance, found = i;
  }
  return found;
}

std::optional<std::size_t> add_point(OpacityPoints& points, const PlotTransform& frame, double value, double alpha) {
  return insert(points, frame, {value, usable(alpha)});
}

std::optional<std::size_t> add_point(ColorPoints& points, const PlotTransform& frame, double value) {
  return insert(points, frame, {value, evaluate_color(points, value, frame.linear_below)});
}

void move_point(OpacityPoints& points, const PlotTransform& frame, std::size_t index, double value, double alpha) {
  CATENA_ASSERT(index < points.size());
  if (const auto place = place_of(points, frame, index, value)) points[index].value = *place;
  points[index].alpha = usable(alpha);
}

void move_point(ColorPoints& points, const PlotTransform& frame, std::size_t index, double value) {
  CATENA_ASSERT(index < points.size());
  if (const auto place = place_of(points, frame, index, value)) points[index].value = *place;
}

bool remove_point(OpacityPoints& points, std::size_t index) { return take_out(points, index); }
bool remove_point(ColorPoints& points, std::size_t index) { return take_out(points, index); }

double evaluate_alpha(const OpacityPoints& points, double value, double linear_below) {
  if (points.empty()) return 0;
  const auto [a, b, t] = around(points, value, linear_below);
  const double low = std::log1p(-a->alpha), high = std::log1p(-b->alpha);
  return -std::expm1(low + t * (high - low));
}

Color evaluate_color(const ColorPoints& points, double value, double linear_below) {
  if (points.empty()) return {0.5f, 0.5f, 0.5f};
  const auto [a, b, share] = around(points, value, linear_below);
  const auto t = static_cast<float>(share);
  const Color &p = a->color, &q = b->color;
  return {p.r + t * (q.r - p.r), p.g + t * (q.g - p.g), p.b + t * (q.b - p.b)};
}

std::optional<std::array<double, 2>> value_range(const ColorPoints& colors, const OpacityPoints& opacities) {
  std::optional<std::array<double, 2>> bounds;
  const auto take = [&](double value) {
    if (!bounds) bounds = {value, value};
    bounds = {std::min((*bounds)[0], value), std::max((*bounds)[1], value)};
  };
  for (const auto& p : colors) take(p.value);
  for (const auto& p : opacities) take(p.value);
  return bounds;
}

bool fit_to_range(ColorPoints& colors, OpacityPoints& opacities, double lo, double hi, double linear_below) {
  const auto from = value_range(colors, opacities);
  if (!from || !(lo < hi) || !std::isfinite(hi - lo) || !((*from)[0] < (*from)[1])) return false;
  const auto laid = [&](double value) {
    const auto place = [&](double v) { return symlog(v, linear_below); };
    const double t = (place(value) - place((*from)[0])) / (place((*from)[1]) - place((*from)[0]));
    return symlog_interpolate(lo, hi, t, linear_below);
  };
  ColorPoints new_colors = colors;
  OpacityPoints new_opacities = opacities;
  for (auto& p : new_colors) p.value = laid(p.value);
  for (auto& p : new_opacities) p.value = laid(p.value);
  if (!rises(new_colors) || !rises(new_opacities)) return false;
  colors = std::move(new_colors);
  opacities = std::move(new_opacities);
  return true;
}

namespace {

constexpr double kThickest = 0.6;

bool is_stated(const scene::Volume& volume) {
  return volume.where.find("transfer") == nullptr && volume.where.find("color") != nullptr && volume.where.find("opacity") != nullptr;
}

void add_mapping(const std::string& at, const scene::ValueMapping& mapping, TextEdits& edits) {
  const bool linear = mapping.kind == scene::ValueMapping::Kind::linear;
  edits.push_back({at + "/mapping", linear ? std::nullopt : std::optional(scene::to_json(scene::to_string(mapping.kind)))});
  edits.push_back({at + "/linear_below", mapping.linear_below > 0 ? std::optional(scene::to_json(mapping.linear_below)) : std::nullopt});
}

void add_colors(const std::string& at, const TransferEdit& edit, TextEdits& edits) {
  edits.push_back({at + "/color", edit.color_map.empty() ? scene::to_json(edit.colors) : scene::to_json(std::string_view(edit.color_map))});
  // a range next to a table is an error of the scene
  std::optional<std::string> range;
  if (!edit.color_map.empty() && edit.has_range)
    range = scene::to_json(std::array<double, 2>{edit.colors.front().value, edit.colors.back().value});
  edits.push_back({at + "/range", range});
}

/// Edits that write the complete transfer function and remove all other keys that describe it.
TextEdits all_of(const scene::Volume& volume, const TransferEdit& edit) {
  const std::string at = item_pointer(volume.where);
  TextEdits edits{{at + "/transfer", std::nullopt}, {at + "/extinction", std::nullopt}};
  add_colors(at, edit, edits);
  edits.push_back({at + "/opacity", scene::to_json(edit.opacities)});
  edits.push_back({at + "/opacity_unit", scene::to_json(edit.opacity_unit)});
  add_mapping(at, edit.mapping, edits);
  if (const auto& factors = volume.transfer.gradient_factors; !factors.empty() && volume.where.find("gradient_opacity") == nullptr)
    edits.push_back({at + "/gradient_opacity", scene::to_json(factors)});
  return edits;
}

}  // namespace

std::optional<TransferEdit> make_transfer_edit(const scene::Volume& volume, double smallest_edge) {
  const scene::TransferFunction& transfer = volume.transfer;
  if (transfer.colors.empty() || (transfer.opacities.empty() && transfer.extinctions.empty())) return std::nullopt;
  TransferEdit edit;
  edit.colors = transfer.colors;
  edit.color_map = transfer.named.map;
  edit.has_range = transfer.named.range.has_value();
  edit.mapping = transfer.named.mapping;
  edit.linear_below = scene::linear_below(transfer);
  if (!transfer.opacities.empty()) {
    edit.opacities = transfer.opacities;
    edit.opacity_unit = transfer.opacity_unit > 0 ? transfer.opacity_unit : smallest_edge;
    return edit;
  }
  double thickest = 0;
  for (const auto& e : transfer.extinctions) thickest = std::max(thickest, e.sigma);
  edit.opacity_unit = thickest > 0 ? -std::log1p(-kThickest) / thickest : smallest_edge;
  edit.opacity_unit = round_within(edit.opacity_unit, 0, edit.opacity_unit, 100);
  for (const auto& e : transfer.extinctions)
    edit.opacities.push_back({e.value, std::min(-std::expm1(-e.sigma * edit.opacity_unit), kMaxAlpha)});
  return edit;
}

std::array<double, 2> plottable_range(const TransferEdit& edit, double lo, double hi) {
  if (edit.mapping.kind != scene::ValueMapping::Kind::log || lo > 0) return make_plot_range(lo, hi);
  const auto bounds = *value_range(edit.colors, edit.opacities);
  return make_plot_range(bounds[0], std::max(bounds[1], hi));
}

TextEdits make_opacity_edits(const scene::Volume& volume, TransferEdit edit) {
  if (!is_stated(volume)) return all_of(volume, edit);
  return {{item_pointer(volume.where) + "/opacity", scene::to_json(edit.opacities)}};
}

TextEdits make_unit_edits(const scene::Volume& volume, const TransferEdit& edit) {
  if (!is_stated(volume)) return all_of(volume, edit);
  return {{item_pointer(volume.where) + "/opacity_unit", scene::to_json(edit.opacity_unit)}};
}

TextEdits make_color_edits(const scene::Volume& volume, TransferEdit edit) {
  edit.color_map.clear();
  if (!is_stated(volume)) return all_of(volume, edit);
  TextEdits edits;
  add_colors(item_pointer(volume.where), edit, edits);
  return edits;
}

TextEdits make_color_map_edits(const scene::Volume& volume, TransferEdit edit, const std::string& map) {
  const bool rises = scene::is_color_range(edit.colors.front().value, edit.colors.back().value);
  edit.has_range = rises && (edit.has_range || edit.color_map.empty());
  edit.color_map = map;
  if (!is_stated(volume)) return all_of(volume, edit);
  TextEdits edits;
  add_colors(item_pointer(volume.where), edit, edits);
  return edits;
}

TextEdits make_mapping_edits(const scene::Volume& volume, TransferEdit edit, const scene::ValueMapping& mapping) {
  const auto bounds = value_range(edit.colors, edit.opacities);
  if (!bounds || !scene::mapping_error(mapping, (*bounds)[0], "range").empty()) return {};
  // a named map lies on the new scale between the same ends
  edit.has_range =
      edit.has_range || (!edit.color_map.empty() && scene::is_color_range(edit.colors.front().value, edit.colors.back().value));
  edit.mapping = mapping;
  return all_of(volume, edit);
}

TextEdits make_range_edits(const scene::Volume& volume, TransferEdit edit, double lo, double hi) {
  if (!scene::mapping_error(edit.mapping, lo, "range").empty()) return {};
  if (!fit_to_range(edit.colors, edit.opacities, lo, hi, edit.linear_below)) return {};
  edit.has_range = !edit.color_map.empty();
  if (edit.has_range && !scene::is_color_range(edit.colors.front().value, edit.colors.back().value)) return {};
  return all_of(volume, edit);
}

}  // namespace catena::app
