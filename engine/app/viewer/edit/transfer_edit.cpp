#include "engine/app/viewer/edit/transfer_edit.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/color_maps.h"

namespace catena::app {

namespace {

constexpr double kThickest = 0.6;

/// The colours as keys of a volume.
std::vector<std::pair<std::string, std::string>> color_keys(const TransferEdit& edit) {
  if (edit.map.empty()) return {{"color", json_of(edit.colors)}};
  std::vector<std::pair<std::string, std::string>> keys{{"color", "\"" + edit.map + "\""}};
  if (edit.has_range) keys.push_back({"range", json_of(std::array<double, 2>{edit.colors.front().value, edit.colors.back().value})});
  return keys;
}

std::string gradient_text(const scene::TransferFunction& transfer) {
  std::string text = "[";
  for (const auto& g : transfer.gradient_factors)
    text += (text.size() > 1 ? ", [" : "[") + json_of(g.gradient) + ", " + json_of(g.factor) + "]";
  return text + "]";
}

/// The whole volume with stated points.
Write whole(const scene::Volume& volume, const TransferEdit& edit) {
  auto keys = color_keys(edit);
  keys.push_back({"opacity", json_of(edit.opacities)});
  keys.push_back({"opacity_unit", json_of(edit.unit)});
  if (!volume.transfer.gradient_factors.empty()) keys.push_back({"gradient_opacity", gradient_text(volume.transfer)});
  return {pointer_of(volume.where), json_with(volume.where, {"transfer", "extinction", "range"}, keys)};
}

/// The text has keys of its own for what is edited, and nothing that contradicts them.
bool has_points(const scene::Volume& volume, const TransferEdit& edit) {
  return edit.stated && volume.where.find("transfer") == nullptr && volume.where.find("color") != nullptr;
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
    edit.stated = volume.where.find("opacity") != nullptr;
    return edit;
  }
  double thickest = 0;
  for (const auto& e : transfer.extinctions) thickest = std::max(thickest, e.sigma);
  edit.unit = thickest > 0 ? -std::log1p(-kThickest) / thickest : smallest_edge;
  edit.unit = rounded_in(edit.unit, 0, edit.unit, 100);
  for (const auto& e : transfer.extinctions) edit.opacities.push_back({e.value, std::min(-std::expm1(-e.sigma * edit.unit), kMostAlpha)});
  return edit;
}

std::vector<Write> opacity_writes(const scene::Volume& volume, const TransferEdit& edit) {
  if (!has_points(volume, edit)) return {whole(volume, edit)};
  return {{pointer_of(volume.where) + "/opacity", json_of(edit.opacities)}};
}

std::vector<Write> unit_writes(const scene::Volume& volume, const TransferEdit& edit) {
  if (!has_points(volume, edit)) return {whole(volume, edit)};
  return {{pointer_of(volume.where) + "/opacity_unit", json_of(edit.unit)}};
}

std::vector<Write> color_writes(const scene::Volume& volume, const TransferEdit& edit) {
  TransferEdit stated = edit;
  stated.map.clear();
  stated.has_range = false;
  // a range beside a table is an error of the scene's: both go together
  if (!has_points(volume, edit) || volume.where.find("range") != nullptr) return {whole(volume, stated)};
  return {{pointer_of(volume.where) + "/color", json_of(edit.colors)}};
}

std::vector<Write> map_writes(const scene::Volume& volume, const TransferEdit& edit, const std::string& map) {
  TransferEdit named = edit;
  named.map = map;
  const bool rises = scene::is_color_range(edit.colors.front().value, edit.colors.back().value);
  named.has_range = rises && (edit.has_range || edit.map.empty());
  if (!has_points(volume, edit)) return {whole(volume, named)};
  const std::string at = pointer_of(volume.where);
  std::vector<Write> writes;
  for (const auto& [key, value] : color_keys(named)) writes.push_back({at + "/" + key, value});
  return writes;
}

std::vector<Write> range_writes(const scene::Volume& volume, TransferEdit edit, double lo, double hi) {
  if (!lay_over(edit.colors, edit.opacities, lo, hi)) return {};
  edit.has_range = !edit.map.empty();
  if (edit.has_range && !scene::is_color_range(edit.colors.front().value, edit.colors.back().value)) return {};
  return {whole(volume, edit)};
}

}  // namespace catena::app
