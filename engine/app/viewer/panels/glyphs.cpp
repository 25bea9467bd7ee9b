// SPDX-License-Identifier: MIT
// Panel of the arrow glyphs: vector field, positions, spacing, length, colors.
#include "engine/app/viewer/edit/chain_editing.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/field/field_display_range.h"
#include "engine/field/grid/grid.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

/// Choice of the glyphs' positions: JSON text of the scene, and the label shown. The first choice, without text, is the field's domain.
struct Stand {
  std::string text, words;
};

template <class T>
void add_stands(const scene::Scene& scene, const std::string& word, const auto& field_of, std::vector<Stand>& stands) {
  int index = 0;
  scene.entities.each<T>([&](scene::Entity, const T& item) {
    stands.push_back({"{\"" + word + "\": " + std::to_string(index) + "}",
                      word + " " + std::to_string(index) + ", " + entity_name(scene, field_of(item))});
    ++index;
  });
}

std::vector<Stand> stands_of(const scene::Scene& scene, const Vec3& middle) {
  std::vector<Stand> stands{{"", "the domain"}};
  add_stands<scene::Slice>(
      scene, "slice", [](const scene::Slice& slice) { return slice.color_by.field; }, stands);
  add_stands<scene::Isosurface>(
      scene, "isosurface", [](const scene::Isosurface& surface) { return surface.field; }, stands);
  scene.entities.each<scene::MeshSource>([&](scene::Entity e, const scene::MeshSource&) {
    stands.push_back({"{\"mesh\": " + scene::to_json(entity_name(scene, e)) + "}", "mesh " + entity_name(scene, e)});
  });
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    if (widget.spec.kind == widget::Kind::cutting_plane)
      stands.push_back({"{\"plane\": {\"widget\": " + scene::to_json(entity_name(scene, e)) + "}}", "plane of " + entity_name(scene, e)});
  });
  for (int a = 0; a < 3; ++a)
    stands.push_back({"{\"plane\": {\"axis\": \"" + std::string(1, "xyz"[a]) + "\", \"at\": " + scene::to_json(middle[a]) + "}}",
                      std::string("plane normal to ") + "xyz"[a]});
  return stands;
}

std::string words_of(const scene::Scene& scene, const scene::GlyphSet& set) {
  using On = scene::GlyphSet::Support;
  switch (set.support) {
    case On::box:
      return set.box ? "a box" : "the domain";
    case On::plane:
      return set.widget ? "plane of " + entity_name(scene, set.widget) : "a plane";
    case On::slice:
      return "slice, " + entity_name(scene, scene.entities.get<scene::Slice>(set.support_entity).color_by.field);
    case On::isosurface:
      return "isosurface, " + entity_name(scene, scene.entities.get<scene::Isosurface>(set.support_entity).field);
    case On::mesh:
      return "mesh " + entity_name(scene, set.support_entity);
  }
  return {};
}

void choose_stand(Edits& edits, const scene::Scene& scene, const scene::GlyphSet& set, const Vec3& middle) {
  if (!ImGui::BeginCombo("on", words_of(scene, set).c_str())) return;
  const std::string pointer = item_pointer(set.where) + "/on";
  for (const Stand& stand : stands_of(scene, middle)) {
    if (!ImGui::Selectable(stand.words.c_str())) continue;
    if (!stand.text.empty())
      edits.set(pointer, stand.text, "glyphs on");
    else if (set.where.find("on") != nullptr)
      edits.remove(pointer, "glyphs on");
  }
  ImGui::EndCombo();
}

/// Edits a plane or box that the glyphs state themselves.
void edit_stand(Edits& edits, const scene::GlyphSet& set, double length) {
  const std::string pointer = item_pointer(set.where) + "/on";
  const double speed = length / 500;
  if (set.support == scene::GlyphSet::Support::box && set.box) {
    edit_vector(edits, "min", pointer + "/box/min", set.box->lo, speed);
    edit_vector(edits, "max", pointer + "/box/max", set.box->hi, speed);
  }
  const json::Node* on = set.where.find("on");
  const json::Node* plane = on != nullptr ? on->find("plane") : nullptr;
  if (plane == nullptr || set.widget) return;
  if (const json::Node* at = plane->find("at")) {
    edit_number(edits, {"at", pointer + "/plane/at", at->number, 0, 0, speed});
    return;
  }
  edit_vector(edits, "point", pointer + "/plane/point", set.point, speed);
  edit_vector(edits, "normal", pointer + "/plane/normal", set.normal, 0.005);
}

/// Estimated maximum speed of the field, used as the step size of a drag.
double fastest(const scene::Scene& scene, const scene::GlyphSet& set) {
  const auto& vector = scene.entities.get<scene::FieldSource>(set.field).loaded.vector;
  return vector && vector->grid() != nullptr ? field::display_range(*vector->grid()).hi : 1;
}

void draw_glyphs(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.entities.each<scene::GlyphSet>([&](scene::Entity e, const scene::GlyphSet& set) {
    if (!begin_item(edits, set.where, !is_hidden(scene.entities, e), "glyphs", entity_name(scene, set.field))) return;
    const std::string pointer = item_pointer(set.where);
    std::string field = entity_name(scene, set.field);
    if (choose_from_list("field", list_field_names(scene, true), field)) edits.set(pointer + "/field", scene::to_json(field), "field");
    const field::Field* loaded = scene.entities.get<scene::FieldSource>(set.field).loaded.get();
    const double length = loaded != nullptr ? loaded->domain_length() : 1;
    choose_stand(edits, scene, set, loaded != nullptr ? loaded->world_bounds().center() : Vec3(0.0));
    edit_stand(edits, set, length);
    edit_auto_length(edits, "spacing", set.where, set.spacing, 0.25 * length,
                     "distance between neighbouring glyphs, world units; left end: chosen from the size of the domain");
    edit_auto_length(edits, "length", set.where, set.length, 0.5 * length,
                     "length of the longest arrow, world units; left end: the spacing");
    edit_auto_length(edits, "radius", set.where, set.radius, 0.05 * length,
                     "shaft radius of the longest arrow, world units; left end: chosen automatically");
    edit_number(edits, {"min_speed", pointer + "/min_speed", set.min_speed, 0, 1e30, 0.005 * fastest(scene, set)});
    show_short_tooltip("minimum speed: shorter vectors have no arrow");
    edit_colors(edits, scene, set.where, set.color, set.color_by, {"speed"});
    edit_simple_keys(edits, "glyphs", set.where);
    end_item();
  });
}

}  // namespace

Panel glyphs_panel() { return {"Glyphs", false, draw_glyphs, has_any<scene::GlyphSet>}; }

}  // namespace catena::app
