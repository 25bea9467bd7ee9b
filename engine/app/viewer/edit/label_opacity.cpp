// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/label_opacity.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/text.h"
#include "engine/scene/labels.h"
#include "engine/scene/to_json.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

/// An isosurface around labels of a map.
struct LabelSurface {
  std::string field, pointer;  ///< Name of the field; the isosurface's place in the text.
  std::vector<double> labels;
  double opacity = 1;
};

std::vector<LabelSurface> label_surfaces(const scene::Scene& scene, const std::string& map) {
  std::vector<LabelSurface> surfaces;
  const scene::LabelMap* known = scene::find_label_map(scene, scene::find_field(scene, map));
  if (known == nullptr) return surfaces;
  scene.entities.each<scene::Isosurface>([&](scene::Entity e, const scene::Isosurface& surface) {
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(surface.field);
    if (scene::is_hidden(scene.entities, e) || !source.label || source.label->label_map != map) return;
    surfaces.push_back(
        {entity_name(scene, surface.field), item_pointer(surface.where), scene::labels_inside(*source.label, *known), surface.opacity});
  });
  return surfaces;
}

bool holds(const LabelSurface& surface, double label) { return std::ranges::find(surface.labels, label) != surface.labels.end(); }

}  // namespace

double label_opacity(const scene::Scene& scene, const std::string& map, double label) {
  double opacity = 0;
  for (const LabelSurface& surface : label_surfaces(scene, map))
    if (holds(surface, label)) opacity = std::max(opacity, surface.opacity);
  return opacity;
}

TextEdits make_label_opacity_edits(const scene::Scene& scene, const std::string& map, double label, double opacity) {
  const std::vector<LabelSurface> surfaces = label_surfaces(scene, map);
  TextEdits edits;
  for (const LabelSurface& surface : surfaces)
    if (surface.labels == std::vector{label}) edits.push_back({surface.pointer + "/opacity", scene::to_json(opacity)});
  if (!edits.empty()) return edits;
  for (const LabelSurface& surface : surfaces) {
    if (!holds(surface, label)) continue;
    if (surface.labels.size() > kMaxListedLabels) return {};
    std::vector<double> others = surface.labels;
    std::erase(others, label);
    const std::string pointer = "/fields/" + surface.field + "/label";
    if (std::ranges::find(edits, pointer, &scene::Document::Edit::pointer) == edits.end())
      edits.push_back({pointer, scene::to_json(others)});
  }
  const std::string name =
      make_unique_name(fmt::format("{}_label_{:.0f}", map, label), [&](const std::string& n) { return bool(scene::find_field(scene, n)); });
  edits.push_back({"/fields/" + name, fmt::format("{{\"label\": {}, \"of\": {}}}", scene::to_json(label), scene::to_json(map))});
  edits.push_back({"/isosurfaces/-",
                   fmt::format("{{\"field\": {}, \"level\": {}, \"color_by\": {{\"field\": {}}}, \"opacity\": {}}}", scene::to_json(name),
                               scene::to_json(field::kLabelLevel), scene::to_json(map), scene::to_json(opacity))});
  return edits;
}

}  // namespace catena::app
