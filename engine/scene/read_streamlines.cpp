#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/lines.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/read_transfer.h"

namespace catena::scene {
namespace {

/// "color_by": a field's name, "speed" or "arc_length"; the colours are then those of read_transfer.h.
Outcome read_color_by(const Scene& scene, const json::Node& item, StreamlineSet& set) {
  const json::Node *by = item.find("color_by"), *color = item.find("color");
  const bool of_values =
      color != nullptr && (color->kind == json::Kind::string ||
                           (color->kind == json::Kind::array && !color->items.empty() && color->items[0].kind == json::Kind::array));
  if (by == nullptr) {
    for (const json::Node* node : {of_values ? color : nullptr, item.find("range"), item.find("transfer")})
      if (node != nullptr)
        return json::error_at(*node,
                              in_quotes(node->label) + (node == color && color->kind == json::Kind::array ? " is a table" : " is given") +
                                  ", but nothing says of what; \"color_by\": a field, \"speed\" or \"arc_length\" was expected beside it");
    CATENA_TRY(set.color, read_color(item, "color", set.color));
    return Done{};
  }
  CATENA_TRY(const std::string name, json::require_string(item, "color_by"));
  set.color_by.emplace();
  if ((set.color_by->field = find_field(scene, name)))
    set.color_by->what = ColorBy::What::field;
  else if (name == "speed")
    set.color_by->what = ColorBy::What::speed;
  else if (name == "arc_length")
    set.color_by->what = ColorBy::What::arc_length;
  else {
    std::vector<std::string_view> names{"speed", "arc_length"};
    scene.world.each<FieldSource>([&](Entity e, const FieldSource&) { names.push_back(scene.world.get<Name>(e).value); });
    return json::error_at(*by, "unknown \"color_by\" " + in_quotes(name) + "; known: " + joined(names) + suggestion(name, names));
  }
  if (color != nullptr && !of_values)
    return json::error_at(*color,
                          "\"color\" beside \"color_by\" is no table; rows [value, r, g, b], or the name of a colour map, were expected");
  CATENA_TRY(ColorScale scale, read_color_scale(scene.path, item));
  set.color_by->colors = std::move(scale.colors);
  set.color_by->named = std::move(scale.named);
  return Done{};
}

}  // namespace

Outcome read_streamlines(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"streamlines\" is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"field", "seeds", "radius", "color", "color_by", "range", "transfer", "kind", "min_speed", "length",
                                        "tolerance", "arrows", "pulse", "clip", "visible"}));
    StreamlineSet set;
    set.where = item;
    CATENA_TRY(set.field, read_field_name(scene, item));
    const json::Node* seeds = item.find("seeds");
    if (seeds == nullptr)
      return json::error_at(item, "\"seeds\" is missing or empty; at least one seed [x, y, z], or a pattern, was expected");
    CATENA_TRY(set.seeds, read_seeds(scene, *seeds));
    CATENA_TRY(set.radius, json::get_number(item, "radius", 0, json::Range::positive));
    CATENA_CHECK(read_color_by(scene, item, set));
    CATENA_TRY(const int kind, json::get_choice(item, "kind", 0, {"vector", "line"}));
    set.line = kind == 1;
    CATENA_TRY(set.min_speed, json::get_number(item, "min_speed", 0, json::Range::not_negative));
    CATENA_TRY(set.length, json::get_number(item, "length", 0, json::Range::positive));
    CATENA_TRY(set.tolerance, json::get_number(item, "tolerance", 0, json::Range::positive));
    CATENA_TRY(set.arrows, json::get_number(item, "arrows", 0, json::Range::positive));
    CATENA_TRY(set.clipped, json::get_boolean(item, "clip", true));
    CATENA_TRY(set.pulse, json::get_number(item, "pulse", 0, json::Range::positive));
    if (set.tolerance > 1e-2)
      return json::error_at(*item.find("tolerance"),
                            "\"tolerance\" is " + to_text(set.tolerance) + " of the domain's length; at most 0.01 was expected");
    const Entity e = scene.world.create();
    scene.world.emplace<StreamlineSet>(e, std::move(set));
    CATENA_CHECK(read_visible(scene, e, item));
  }
  return Done{};
}

Outcome read_indicator(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "indicator"));
  CATENA_CHECK(json::only_keys(node, {"field", "length", "radius", "color"}));
  Indicator indicator;
  indicator.where = node;
  CATENA_TRY(indicator.field, read_field_name(scene, node));
  CATENA_TRY(indicator.length, json::get_number(node, "length", 0, json::Range::positive));
  CATENA_TRY(indicator.radius, json::get_number(node, "radius", 0, json::Range::positive));
  CATENA_TRY(indicator.color, read_color(node, "color", indicator.color));
  scene.world.emplace<Indicator>(scene.world.create(), std::move(indicator));
  return Done{};
}

}  // namespace catena::scene
