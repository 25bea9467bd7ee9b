#include "engine/app/viewer/edit/transfer_edit.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/base/result.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/write_values.h"

namespace catena::app {

namespace {

constexpr double kGap = 1e-4;  // of the plot: neighbours are not nearer, unless they were

template <class Points>
bool rises(const Points& points) {
  const auto falls = [](const auto& a, const auto& b) { return !(a.value < b.value); };
  return std::adjacent_find(points.begin(), points.end(), falls) == points.end();
}

/// Where a point between `below` and `above` (either may lack) goes if it is wanted at `value`; none: no room.
std::optional<double> between(const double* below, const double* above, const PlotFrame& frame, double value) {
  if (!std::isfinite(value)) return std::nullopt;
  const double gap = kGap * (frame.hi - frame.lo);
  double least = below ? *below + gap : frame.lo, most = above ? *above - gap : frame.hi;
  if (!(least <= most)) {
    if (!below || !above) {
      // the only neighbour lies beyond the plot
      value = below ? *below + gap : *above - gap;
    } else {
      value = 0.5 * *below + 0.5 * *above;
    }
  } else {
    value = std::clamp(value, least, most);
  }
  if ((below && !(*below < value)) || (above && !(value < *above)) || !std::isfinite(value)) return std::nullopt;
  return value;
}

template <class Points>
std::optional<double> place_of(const Points& points, const PlotFrame& frame, std::size_t index, double value) {
  const double* below = index > 0 ? &points[index - 1].value : nullptr;
  const double* above = index + 1 < points.size() ? &points[index + 1].value : nullptr;
  return between(below, above, frame, value);
}

template <class Points>
std::optional<std::size_t> insert(Points& points, const PlotFrame& frame, typename Points::value_type point) {
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

/// The points to either side of a value and how far it is between them.
template <class Points>
auto around(const Points& points, double value) {
  struct Pieces {
    const typename Points::value_type *a, *b;
    double t;
  };
  if (!(value > points.front().value)) return Pieces{&points.front(), &points.front(), 0};
  if (value >= points.back().value) return Pieces{&points.back(), &points.back(), 0};
  const auto next = std::upper_bound(points.begin(), points.end(), value, [](double v, const auto& p) { return v < p.value; });
  return Pieces{&*(next - 1), &*next, (value - (next - 1)->value) / (next->value - (next - 1)->value)};
}

}  // namespace

std::optional<std::size_t> point_at(const OpacityPoints& points, const PlotFrame& frame, double x, double y, double reach) {
  std::optional<std::size_t> found;
  double nearest = reach;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = std::hypot(frame.x_of(points[i].value) - x, frame.y_of(points[i].alpha) - y);
    if (distance <= nearest) nearest = distance, found = i;
  }
  return found;
}

std::optional<std::size_t> point_at(const ColorPoints& points, const PlotFrame& frame, double x, double reach) {
  std::optional<std::size_t> found;
  double nearest = reach;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = std::fabs(frame.x_of(points[i].value) - x);
    if (distance <= nearest) nearest = distance, found = i;
  }
  return found;
}

std::optional<std::size_t> add_point(OpacityPoints& points, const PlotFrame& frame, double value, double alpha) {
  return insert(points, frame, {value, usable(alpha)});
}

std::optional<std::size_t> add_point(ColorPoints& points, const PlotFrame& frame, double value) {
  return insert(points, frame, {value, color_at(points, value)});
}

void move_point(OpacityPoints& points, const PlotFrame& frame, std::size_t index, double value, double alpha) {
  CATENA_ASSERT(index < points.size());
  if (const auto place = place_of(points, frame, index, value)) points[index].value = *place;
  points[index].alpha = usable(alpha);
}

void move_point(ColorPoints& points, const PlotFrame& frame, std::size_t index, double value) {
  CATENA_ASSERT(index < points.size());
  if (const auto place = place_of(points, frame, index, value)) points[index].value = *place;
}

bool remove_point(OpacityPoints& points, std::size_t index) { return take_out(points, index); }
bool remove_point(ColorPoints& points, std::size_t index) { return take_out(points, index); }

double alpha_at(const OpacityPoints& points, double value) {
  if (points.empty()) return 0;
  const auto [a, b, t] = around(points, value);
  const double low = std::log1p(-a->alpha), high = std::log1p(-b->alpha);
  return -std::expm1(low + t * (high - low));
}

Color color_at(const ColorPoints& points, double value) {
  if (points.empty()) return {0.5f, 0.5f, 0.5f};
  const auto [a, b, share] = around(points, value);
  const auto t = static_cast<float>(share);
  const Color &p = a->color, &q = b->color;
  return {p.r + t * (q.r - p.r), p.g + t * (q.g - p.g), p.b + t * (q.b - p.b)};
}

std::optional<std::array<double, 2>> reach_of(const ColorPoints& colors, const OpacityPoints& opacities) {
  std::optional<std::array<double, 2>> reach;
  const auto take = [&](double value) {
    if (!reach) reach = {value, value};
    reach = {std::min((*reach)[0], value), std::max((*reach)[1], value)};
  };
  for (const auto& p : colors) take(p.value);
  for (const auto& p : opacities) take(p.value);
  return reach;
}

bool lay_over(ColorPoints& colors, OpacityPoints& opacities, double lo, double hi) {
  const auto from = reach_of(colors, opacities);
  if (!from || !(lo < hi) || !std::isfinite(hi - lo) || !((*from)[0] < (*from)[1])) return false;
  const auto laid = [&](double value) {
    const double t = (value - (*from)[0]) / ((*from)[1] - (*from)[0]);
    return (1 - t) * lo + t * hi;
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

void add_colors(const std::string& at, const TransferEdit& edit, TextEdits& edits) {
  edits.push_back({at + "/color", edit.map.empty() ? scene::text_of(edit.colors) : scene::text_of(std::string_view(edit.map))});
  // a range beside a table is an error of the scene's
  std::optional<std::string> range;
  if (!edit.map.empty() && edit.has_range)
    range = scene::text_of(std::array<double, 2>{edit.colors.front().value, edit.colors.back().value});
  edits.push_back({at + "/range", range});
}

/// All that the transfer function is, and nothing else that says it.
TextEdits all_of(const scene::Volume& volume, const TransferEdit& edit) {
  const std::string at = pointer_of(volume.where);
  TextEdits edits{{at + "/transfer", std::nullopt}, {at + "/extinction", std::nullopt}};
  add_colors(at, edit, edits);
  edits.push_back({at + "/opacity", scene::text_of(edit.opacities)});
  edits.push_back({at + "/opacity_unit", scene::text_of(edit.unit)});
  if (const auto& factors = volume.transfer.gradient_factors; !factors.empty() && volume.where.find("gradient_opacity") == nullptr)
    edits.push_back({at + "/gradient_opacity", scene::text_of(factors)});
  return edits;
}

}  // namespace

std::optional<TransferEdit> transfer_edit(const scene::Volume& volume, double smallest_edge) {
  const scene::TransferFunction& transfer = volume.transfer;
  if (transfer.colors.empty() || (transfer.opacities.empty() && transfer.extinctions.empty())) return std::nullopt;
  TransferEdit edit;
  edit.colors = transfer.colors;
  edit.map = transfer.named.map;
  edit.has_range = transfer.named.range.has_value();
  if (!transfer.opacities.empty()) {
    edit.opacities = transfer.opacities;
    edit.unit = transfer.opacity_unit > 0 ? transfer.opacity_unit : smallest_edge;
    return edit;
  }
  double thickest = 0;
  for (const auto& e : transfer.extinctions) thickest = std::max(thickest, e.sigma);
  edit.unit = thickest > 0 ? -std::log1p(-kThickest) / thickest : smallest_edge;
  edit.unit = rounded_in(edit.unit, 0, edit.unit, 100);
  for (const auto& e : transfer.extinctions) edit.opacities.push_back({e.value, std::min(-std::expm1(-e.sigma * edit.unit), kMaxAlpha)});
  return edit;
}

TextEdits opacity_edits(const scene::Volume& volume, TransferEdit edit) {
  if (!is_stated(volume)) return all_of(volume, edit);
  return {{pointer_of(volume.where) + "/opacity", scene::text_of(edit.opacities)}};
}

TextEdits unit_edits(const scene::Volume& volume, const TransferEdit& edit) {
  if (!is_stated(volume)) return all_of(volume, edit);
  return {{pointer_of(volume.where) + "/opacity_unit", scene::text_of(edit.unit)}};
}

TextEdits color_edits(const scene::Volume& volume, TransferEdit edit) {
  edit.map.clear();
  if (!is_stated(volume)) return all_of(volume, edit);
  TextEdits edits;
  add_colors(pointer_of(volume.where), edit, edits);
  return edits;
}

TextEdits map_edits(const scene::Volume& volume, TransferEdit edit, const std::string& map) {
  const bool rises = scene::is_color_range(edit.colors.front().value, edit.colors.back().value);
  edit.has_range = rises && (edit.has_range || edit.map.empty());
  edit.map = map;
  if (!is_stated(volume)) return all_of(volume, edit);
  TextEdits edits;
  add_colors(pointer_of(volume.where), edit, edits);
  return edits;
}

TextEdits range_edits(const scene::Volume& volume, TransferEdit edit, double lo, double hi) {
  if (!lay_over(edit.colors, edit.opacities, lo, hi)) return {};
  edit.has_range = !edit.map.empty();
  if (edit.has_range && !scene::is_color_range(edit.colors.front().value, edit.colors.back().value)) return {};
  return all_of(volume, edit);
}

}  // namespace catena::app
