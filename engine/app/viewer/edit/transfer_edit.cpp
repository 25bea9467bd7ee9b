#include "engine/app/viewer/edit/transfer_edit.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/pointers.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/write_values.h"

namespace catena::app {

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
