// SPDX-License-Identifier: MIT
// Panel of the scalar bars: title, side, ticks, and new bars for items that show values as colors.
#include <fmt/format.h>

#include <cstring>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/scene/drawable.h"

namespace catena::app {

namespace {

/// Returns words for an item: "volume of T1".
std::string describe_item(const scene::Scene& scene, const scene::Drawable& kind, scene::Entity item) {
  const scene::Entity field = kind.color_field(scene.entities, item);
  return std::string(kind.singular) + (field ? " of " + entity_name(scene, field) : "");
}

/// Returns the title of a bar, or the item that it shows.
std::string bar_name(const scene::Scene& scene, const scene::ScalarBar& bar) {
  if (bar.title && !bar.title->empty()) return *bar.title;
  const scene::Drawable* kind = scene::find_drawable(scene.entities, bar.target);
  return kind != nullptr ? describe_item(scene, *kind, bar.target) : bar.where.label;
}

void draw_bar(Edits& edits, const scene::ScalarBar& bar, const std::string& name) {
  const std::string pointer = item_pointer(bar.where);
  ImGui::PushID(pointer.c_str());
  if (ImGui::TreeNodeEx("##bar", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", name.c_str())) {
    char title[200] = {};
    std::strncpy(title, bar.title.value_or("").c_str(), sizeof title - 1);
    if (ImGui::InputText("title", title, sizeof title, ImGuiInputTextFlags_EnterReturnsTrue))
      edits.set(pointer + "/title", scene::to_json(std::string_view(title)), "title of the scalar bar");
    show_short_tooltip("title over the bar; Enter applies");
    edit_simple_keys(edits, "scalar_bars", bar.where);
    int ticks = bar.ticks;
    if (ImGui::SliderInt("ticks", &ticks, 2, 12, "%d", ImGuiSliderFlags_AlwaysClamp))
      edits.drag(pointer + "/ticks", std::to_string(ticks), "ticks of the scalar bar");
    if (ImGui::Button("Remove")) edits.remove(pointer, "remove the scalar bar");
    ImGui::TreePop();
  }
  ImGui::PopID();
}

/// Draws the list of items for which a bar can be added.
void draw_new_bar(Edits& edits, const scene::Scene& scene) {
  if (!ImGui::BeginCombo("##add", "Add a scalar bar")) return;
  for (const scene::Drawable& kind : scene::drawables()) {
    if (kind.bar_key.empty()) continue;
    int index = 0;
    for (const auto& [entity, where] : kind.items(scene.entities)) {
      const std::string name = describe_item(scene, kind, entity);
      if (kind.has_colors(scene.entities, entity) && ImGui::Selectable((name + "##" + where->label).c_str()))
        edits.set("/scalar_bars/-", fmt::format("{{\"{}\": {}}}", kind.bar_key, index), "scalar bar of the " + name);
      ++index;
    }
  }
  ImGui::EndCombo();
}

void draw_scalar_bars(PanelContext& context) {
  const scene::Scene& scene = context.scene.scene();
  for (const scene::ScalarBar& bar : scene.annotations.scalar_bars) draw_bar(context.edits, bar, bar_name(scene, bar));
  draw_new_bar(context.edits, scene);
}

}  // namespace

Panel scalar_bars_panel() { return {"Scalar bars", false, draw_scalar_bars}; }

}  // namespace catena::app
