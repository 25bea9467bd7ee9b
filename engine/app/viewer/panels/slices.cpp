// SPDX-License-Identifier: MIT
// Panel of the slices: plane, colors, opacity, contours.
#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/haptic_binding.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

/// Edits of the slice, and of the links on its plane, which move to the new plane.
TextEdits with_links(const scene::Scene& scene, const scene::Slice& slice, TextEdits edits, const Vec3& point, const Vec3& normal) {
  for (const std::string& link : find_coplanar_links(scene, slice.point, slice.normal)) {
    edits.push_back({link + "/point", scene::to_json(point)});
    edits.push_back({link + "/normal", scene::to_json(normal)});
  }
  return edits;
}

constexpr int kFree = 3;  // choice after the axes

std::vector<std::string> cutting_planes(const scene::Scene& scene) {
  std::vector<std::string> names;
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    if (widget.spec.kind == widget::Kind::cutting_plane) names.push_back(entity_name(scene, e));
  });
  return names;
}

void draw_plane(Edits& edits, const scene::Scene& scene, const scene::Slice& slice, const field::Field& field) {
  const std::string pointer = item_pointer(slice.where);
  const Bounds box = field.world_bounds();
  const json::Node* axis = slice.where.find("axis");
  const bool free = axis == nullptr;
  int which = axis != nullptr ? static_cast<int>(std::string_view("xyz").find(axis->string)) : kFree;
  std::vector<std::string> choices{"x", "y", "z", "free"};
  for (const std::string& widget : cutting_planes(scene)) {
    if (slice.widget && entity_name(scene, slice.widget) == widget) which = static_cast<int>(choices.size());
    choices.push_back("plane of " + widget);
  }
  std::string chosen = choices[static_cast<std::size_t>(which)];
  ImGui::SetNextItemWidth(slice.widget ? -FLT_MIN : 90);
  if (choose_from_list("##axis", choices, chosen)) {
    which = static_cast<int>(std::ranges::find(choices, chosen) - choices.begin());
    TextEdits edit;
    for (const char* key : {"axis", "at", "point", "normal", "widget"}) edit.push_back({pointer + "/" + key, std::nullopt});
    const auto set = [&](const char* key, std::string value) {
      std::ranges::find(edit, pointer + "/" + key, &scene::Document::Edit::pointer)->value = std::move(value);
    };
    if (which > kFree) {
      set("widget", scene::to_json(cutting_planes(scene)[static_cast<std::size_t>(which - kFree - 1)]));
      return edits.set(edit, "slice");
    }
    if (which == kFree) {
      set("point", scene::to_json(slice.point));
      set("normal", scene::to_json(slice.normal));
      return edits.set(edit, "slice");
    }
    const Vec3 middle = 0.5 * (box.lo + box.hi);
    Vec3 at(0.0), normal(0.0);
    normal[which] = 1;
    at[which] =
        free ? std::clamp(slice.point[which], box.lo[which], box.hi[which]) : round_within(middle[which], box.lo[which], box.hi[which]);
    set("axis", scene::to_json(std::string(1, "xyz"[which])));
    set("at", scene::to_json(at[which]));
    return edits.set(with_links(scene, slice, std::move(edit), at, normal), "slice");
  }
  show_short_tooltip("axis normal to the slice; free: any point and normal; or the plane of a cutting plane widget");
  if (slice.widget) return;
  if (!free) {
    ImGui::SameLine();
    const double lo = box.lo[which], hi = box.hi[which];
    double at = slice.point[which];
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::SliderScalar("##at", ImGuiDataType_Double, &at, &lo, &hi, "%.5g",
                            ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat)) {
      Vec3 to = slice.point;
      to[which] = std::clamp(round_within(at, lo, hi), lo, hi);
      edits.drag(with_links(scene, slice, {{pointer + "/at", scene::to_json(to[which])}}, to, slice.normal), "slice");
    }
    return;
  }
  double point[3] = {slice.point.x, slice.point.y, slice.point.z}, normal[3] = {slice.normal.x, slice.normal.y, slice.normal.z};
  const auto step = static_cast<float>(field.domain_length() / 500);
  if (ImGui::DragScalarN("point", ImGuiDataType_Double, point, 3, step, nullptr, nullptr, "%.4g", ImGuiSliderFlags_NoRoundToFormat)) {
    Vec3 to;
    for (int k = 0; k < 3; ++k) to[k] = round_within(point[k], 0, field.domain_length(), 20000);
    edits.drag(with_links(scene, slice, {{pointer + "/point", scene::to_json(to)}}, to, slice.normal), "slice");
  }
  if (ImGui::DragScalarN("normal", ImGuiDataType_Double, normal, 3, 0.005f, nullptr, nullptr, "%.3f", ImGuiSliderFlags_NoRoundToFormat)) {
    Vec3 to;
    for (int k = 0; k < 3; ++k) to[k] = round_within(normal[k], 0, 1, 1000);
    if (max_abs(to) > 0) edits.drag(with_links(scene, slice, {{pointer + "/normal", scene::to_json(to)}}, slice.point, to), "slice");
  }
}

void draw_contours(Edits& edits, const scene::Slice& slice) {
  const std::string pointer = item_pointer(slice.where) + "/contours";
  bool on = slice.contours.has_value();
  if (ImGui::Checkbox("contours", &on)) {
    if (on)
      edits.set(pointer, "{\"count\": 8}", "contours");
    else
      edits.remove(pointer, "contours");
    return;
  }
  if (!slice.contours) return;
  ImGui::SameLine();
  edit_color(edits, "##contour colour", slice.contours->color, pointer + "/color");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-FLT_MIN);
  if (slice.contours->count > 0) {
    int count = slice.contours->count;
    if (ImGui::SliderInt("##count", &count, 1, 40, "%d lines", ImGuiSliderFlags_AlwaysClamp))
      edits.drag(pointer + "/count", std::to_string(count), "contours");
  } else if (slice.contours->spacing > 0) {
    double spacing = slice.contours->spacing;
    if (input_number("##spacing", spacing, "difference between neighbouring contour levels, in the field's unit; Enter applies") &&
        spacing > 0)
      edits.drag(pointer + "/spacing", scene::to_json(spacing), "contours");
  } else {
    ImGui::TextDisabled("%zu levels in the file", slice.contours->levels.size());
  }
}

/// Switch, strength and motion of the streaks of a vector field; without a loaded vector field nothing.
void draw_flow_texture(Edits& edits, const scene::Scene& scene, const scene::Slice& slice) {
  std::vector<std::string> fields;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    if (source.loaded.vector) fields.push_back(entity_name(scene, e));
  });
  if (fields.empty()) return;
  const std::string pointer = item_pointer(slice.where) + "/lic";
  bool on = slice.flow_texture.has_value();
  if (ImGui::Checkbox("streaks", &on)) {
    if (on)
      edits.set(pointer, "{\"field\": " + scene::to_json(fields.front()) + "}", "streaks");
    else
      edits.remove(pointer, "streaks");
    return;
  }
  show_short_tooltip("line integral convolution: streaks along a vector field in the plane");
  if (!slice.flow_texture) return;
  std::string chosen = entity_name(scene, slice.flow_texture->field);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-FLT_MIN);
  if (choose_from_list("##streak field", fields, chosen)) edits.set(pointer + "/field", scene::to_json(chosen), "streaks");
  edit_slider(edits, "strength", slice.flow_texture->strength, 0, 1, pointer + "/strength");
  bool animated = slice.flow_texture->is_animated;
  if (ImGui::Checkbox("moving", &animated)) edits.set(pointer + "/animated", animated ? "true" : "false", "streaks");
}

void draw_slices(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.entities.each<scene::Slice>([&](scene::Entity e, const scene::Slice& slice) {
    if (!begin_item(edits, slice.where, !is_hidden(scene.entities, e), "slice", entity_name(scene, slice.color_by.field))) return;
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(slice.color_by.field);
    const field::Field* field = source.rendered.get() != nullptr ? source.rendered.get() : source.loaded.get();
    if (field != nullptr) draw_plane(edits, scene, slice, *field);
    edit_color_scale(edits, scene, slice.where, slice.color_by);
    draw_contours(edits, slice);
    draw_flow_texture(edits, scene, slice);
    edit_simple_keys(edits, "slices", slice.where, {"axis"});
    end_item();
  });
}

}  // namespace

Panel slices_panel() { return {"Slices", false, draw_slices, has_any<scene::Slice>}; }

}  // namespace catena::app
