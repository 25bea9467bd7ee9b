// Streamlines: one colour or the colours of values, radius.
#include <algorithm>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/look_parts.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/hidden.h"

namespace catena::app {

namespace {

/// A colour alone, or the colours of values.
void choose_what(Edits& edits, const scene::Scene& scene, const scene::StreamlineSet& set) {
  const std::string now = !set.color_by                                            ? "one colour"
                          : set.color_by->what == scene::ColorBy::What::speed      ? "speed"
                          : set.color_by->what == scene::ColorBy::What::arc_length ? "arc_length"
                                                                                   : name_of(scene, set.color_by->field);
  if (!ImGui::BeginCombo("colour by", now.c_str())) return;
  std::vector<std::string> choices{"one colour", "speed", "arc_length"};
  for (const std::string& name : field_names(scene)) choices.push_back(name);
  for (const std::string& choice : choices) {
    if (!ImGui::Selectable(choice.c_str(), choice == now) || choice == now) continue;
    const std::string pointer = pointer_of(set.where);
    // as a word with keys beside it, as it was written once: those go; a stated range or table lies elsewhere for other values
    TextEdits change{{pointer + "/range", std::nullopt}, {pointer + "/transfer", std::nullopt}};
    if (choice == "one colour") {
      change.push_back({pointer + "/color_by", std::nullopt});
      change.push_back({pointer + "/color", scene::text_of(set.color)});
    } else {
      const bool named = set.color_by && !set.color_by->named.map.empty();
      scene::ColorBy by;
      by.what = choice == "speed"        ? scene::ColorBy::What::speed
                : choice == "arc_length" ? scene::ColorBy::What::arc_length
                                         : scene::ColorBy::What::field;
      if (by.what == scene::ColorBy::What::field) by.field = scene::find_field(scene, choice);
      by.named.map = named ? set.color_by->named.map : std::string(scene::kDefaultLineMap);
      if (set.color_by) change.push_back({pointer + "/color", std::nullopt});
      change.push_back({pointer + "/color_by", scene::text_of(scene, by)});
    }
    edits.set(change, "colours");
  }
  ImGui::EndCombo();
}

void draw_lines(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.world.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    if (!begin_item(edits, set.where, !is_hidden(scene.world, e), "streamlines", name_of(scene, set.field))) return;
    const std::string pointer = pointer_of(set.where);
    choose_what(edits, scene, set);
    if (set.color_by)
      edit_color_scale(edits, set.where, *set.color_by);
    else
      edit_color(edits, "colour", set.color, pointer + "/color");

    const scene::FieldSource& source = scene.world.get<scene::FieldSource>(set.field);
    const double length = source.loaded.get() != nullptr ? source.loaded.get()->length() : 1;
    auto radius = static_cast<float>(set.radius);
    const auto most = static_cast<float>(0.05 * length);
    if (ImGui::SliderFloat("radius", &radius, 0, most, set.radius > 0 ? "%.4g" : "fitted",
                           ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat | ImGuiSliderFlags_Logarithmic)) {
      const double to = rounded_in(radius, 0, most);
      if (to > 0)
        edits.drag(pointer + "/radius", scene::text_of(to), "radius");
      else if (set.where.find("radius") != nullptr)
        edits.remove(pointer + "/radius", "radius");
    }
    short_tip("of the tubes, world units; at the left end: fitted to the domain");
    edit_plain_keys(edits, "streamlines", set.where, {"tolerance"});
    end_item();
  });
}

}  // namespace

Panel lines_panel() { return {"Lines", false, draw_lines, has_any<scene::StreamlineSet>}; }

}  // namespace catena::app
