#include "engine/base/text.h"
#include "engine/scene/read_named.h"
#include "engine/scene/write_values.h"

namespace catena::scene {

Key clip_key() { return schema::boolean("clip", "False: the clip planes leave it whole.").by_default("true"); }
Key visible_key() { return schema::boolean("visible", "False: it is not drawn, but still felt and followed.").by_default("true"); }
Key opacity_key(const std::string& help) { return schema::number("opacity", "", help).within(0, 1); }

Keys color_scale_keys(std::string_view map, const std::string& range) {
  return {schema::any_of("color", {schema::table("", 4, "value", ""), schema::text("", "")},
                         "Rows `[value, r, g, b]`, or the name of a colour map (`catena info --colormaps`).")
              .ranged("values rising")
              .by_default("\"" + std::string(map) + "\""),
          schema::vector("range", 2, "value", "Between which values the named map lies; not beside a table.")
              .ranged("rising")
              .by_default(range),
          schema::word("mapping", {std::begin(kMappingWords), std::end(kMappingWords)},
                       "The scale between the points of colours and opacities: by the logarithm, or by it away from 0 on both sides.")
              .by_default("\"linear\""),
          schema::number("linear_below", "value", "Of `symlog`: up to this size values are linear.")
              .positive()
              .by_default("a thousandth of the greatest"),
          schema::file("transfer", "A file that says all of it: Catena's (`assets/transfer/`) or a ParaView colour map.")};
}

Keys transfer_keys() {
  return schema::joined(
      color_scale_keys(kDefaultVolumeMap, "0.5 to 99.8 percentile; with a named map the display range"),
      {schema::table("opacity", 2, "value, 1", "Rows `[value, alpha]`, alpha per `opacity_unit`; 1 counts as 0.999.")
           .ranged("0 <= alpha <= 1")
           .by_default("from the values"),
       schema::number("opacity_unit", "world", "The length that alpha is meant for.").positive().by_default("smallest voxel edge"),
       schema::table("extinction", 2, "value, 1/world", "Rows `[value, sigma]`, instead of `opacity`.").ranged("sigma >= 0"),
       schema::table("gradient_opacity", 2, "value/world, 1", "Rows `[slope, factor]`: the slope multiplies the extinction.")
           .ranged("factor 0 to 1")
           .by_default("1 everywhere")});
}

/// How values become colours: the one shape of "color_by", {"field" or "quantity", "color", "range", "mapping", "transfer"}.

namespace {

constexpr std::string_view kQuantities[] = {"speed", "arc_length"};

bool knows_quantities(ColorSubjects subjects) { return subjects == ColorSubjects::lines || subjects == ColorSubjects::glyphs; }

Outcome take_scale(const Scene& scene, const json::Node& object, ColorBy& by) {
  by.where = object;
  CATENA_TRY(ColorScale scale, read_color_scale(scene.path, object));
  by.colors = std::move(scale.colors);
  by.named = std::move(scale.named);
  return Done{};
}

bool is_table(const json::Node& color) {
  return color.kind == json::Kind::string ||
         (color.kind == json::Kind::array && !color.items.empty() && color.items[0].kind == json::Kind::array);
}

Outcome read_object(const Scene& scene, const json::Node& node, ColorSubjects subjects, ColorBy& by) {
  CATENA_CHECK(json::only_keys(node, schema::names_of(*color_by_key(subjects).inner)));
  const json::Node *field = node.find("field"), *quantity = node.find("quantity"), *value = node.find("value");
  if (knows_quantities(subjects) && (field != nullptr) == (quantity != nullptr))
    return json::error_at(node, std::string("\"color_by\" names ") + (field != nullptr ? "both" : "neither") +
                                    " \"field\" and \"quantity\"; exactly one of them was expected");
  if (subjects == ColorSubjects::curves && (field != nullptr) + (quantity != nullptr) + (value != nullptr) != 1)
    return json::error_at(node,
                          "\"color_by\" names none or several of \"field\", \"value\" and \"quantity\"; exactly one of them was expected");
  if (subjects == ColorSubjects::points && (field != nullptr) == (value != nullptr))
    return json::error_at(node, std::string("\"color_by\" names ") + (field != nullptr ? "both" : "neither") +
                                    " \"field\" and \"value\"; exactly one of them was expected");
  if (value != nullptr) {
    by.what = ColorBy::What::value;
    CATENA_TRY(by.value, json::require_string(node, "value"));
  } else if (quantity != nullptr && subjects == ColorSubjects::curves) {
    CATENA_CHECK(json::get_choice(node, "quantity", 0, {kQuantities[1]}));
    by.what = ColorBy::What::arc_length;
  } else if (quantity != nullptr) {
    std::vector<std::string_view> known{kQuantities[0]};
    if (subjects == ColorSubjects::lines) known.push_back(kQuantities[1]);
    CATENA_TRY(const int index, json::get_choice(node, "quantity", 0, known));
    by.what = index == 0 ? ColorBy::What::speed : ColorBy::What::arc_length;
  } else {
    CATENA_TRY(by.field, read_field_name(scene, node));
  }
  return take_scale(scene, node, by);
}

/// As it was written once: a word, with the colours' keys beside it.
Outcome read_word(Scene& scene, const json::Node& item, ColorSubjects subjects, ColorBy& by) {
  const json::Node& node = *item.find("color_by");
  const std::string name = node.string;
  by.field = find_field(scene, name);
  if (!by.field && subjects == ColorSubjects::lines && name == kQuantities[0])
    by.what = ColorBy::What::speed;
  else if (!by.field && subjects == ColorSubjects::lines && name == kQuantities[1])
    by.what = ColorBy::What::arc_length;
  else if (!by.field && subjects == ColorSubjects::lines) {
    std::vector<std::string_view> names{kQuantities[0], kQuantities[1]};
    for (const std::string_view field : all_names<FieldSource>(scene)) names.push_back(field);
    return json::error_at(node, "unknown \"color_by\" " + in_quotes(name) + "; known: " + joined(names) + suggestion(name, names));
  } else if (!by.field) {
    CATENA_TRY(by.field, read_field_name(scene, item, "color_by"));
  }
  if (const json::Node* color = item.find("color"); subjects == ColorSubjects::lines && color != nullptr && !is_table(*color))
    return json::error_at(*color,
                          "\"color\" beside \"color_by\" is no table; rows [value, r, g, b], or the name of a colour map, were expected");
  CATENA_CHECK(take_scale(scene, item, by));
  const char* key = by.what == ColorBy::What::field ? "field" : "quantity";
  scene.notes.push_back(
      json::error_at(node, "\"color_by\" as a word, with \"color\", \"range\" and \"transfer\" beside it, is the old way: {\"" +
                               std::string(key) + "\": " + in_quotes(name) + ", \"color\": ..., ...} says the same")
          .message);
  return Done{};
}

}  // namespace

Key color_by_key(ColorSubjects subjects) {
  Keys keys{schema::named("field", Role::any_field, "The field whose values are shown; of a vector field, its magnitude.")};
  if (subjects == ColorSubjects::lines)
    keys.push_back(schema::word("quantity", {std::string(kQuantities[0]), std::string(kQuantities[1])},
                                "Or what the line itself knows: one of `field` and `quantity`."));
  else if (subjects == ColorSubjects::glyphs)
    keys.push_back(schema::word("quantity", {std::string(kQuantities[0])}, "Or their speed: one of `field` and `quantity`."));
  else if (subjects == ColorSubjects::points)
    keys.push_back(schema::text("value", "Or a column of the table, by its name: one of the two."));
  else if (subjects == ColorSubjects::curves) {
    keys.push_back(schema::text("value", "Or what the file says at each point, by its name there."));
    keys.push_back(schema::word("quantity", {std::string(kQuantities[1])}, "Or the way along the line: one of the three."));
  } else
    keys[0] = keys[0].required();
  return schema::object("color_by", schema::joined(keys, color_scale_keys()), "Colours by values.");
}

Outcome read_color_by(Scene& scene, const json::Node& item, ColorSubjects subjects, std::optional<ColorBy>& out) {
  const json::Node* node = item.find("color_by");
  if (node == nullptr) return Done{};
  out.emplace();
  if (node->kind == json::Kind::string && (subjects == ColorSubjects::surfaces || subjects == ColorSubjects::lines))
    return read_word(scene, item, subjects, *out);
  CATENA_CHECK(json::expect_object(*node, "color_by"));
  return read_object(scene, *node, subjects, *out);
}

std::string text_of(const Scene& scene, const ColorBy& by) {
  std::string out = by.what == ColorBy::What::field   ? "{\"field\": " + text_of(std::string_view(scene.world.get<Name>(by.field).value))
                    : by.what == ColorBy::What::value ? "{\"value\": " + text_of(std::string_view(by.value))
                                                      : "{\"quantity\": " + text_of(kQuantities[by.what == ColorBy::What::speed ? 0 : 1]);
  for (const auto& [key, value] : scale_members(by.colors, by.named)) out += ", \"" + key + "\": " + value;
  return out + "}";
}

schema::Members scale_members(const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named) {
  schema::Members out;
  if (!colors.empty()) out.emplace_back("color", text_of(colors));
  if (colors.empty() && !named.map.empty()) out.emplace_back("color", text_of(std::string_view(named.map)));
  if (colors.empty() && named.range) out.emplace_back("range", text_of(*named.range));
  if (named.mapping.kind != ValueMapping::Kind::linear) out.emplace_back("mapping", text_of(word_of(named.mapping.kind)));
  if (named.mapping.linear_below > 0) out.emplace_back("linear_below", text_of(named.mapping.linear_below));
  return out;
}

schema::Members transfer_members(const TransferFunction& transfer) {
  auto out = scale_members(transfer.colors, transfer.named);
  if (!transfer.opacities.empty()) out.emplace_back("opacity", text_of(transfer.opacities));
  if (!transfer.opacities.empty() && transfer.opacity_unit > 0) out.emplace_back("opacity_unit", text_of(transfer.opacity_unit));
  if (transfer.opacities.empty() && !transfer.extinctions.empty()) out.emplace_back("extinction", text_of(transfer.extinctions));
  if (!transfer.gradient_factors.empty()) out.emplace_back("gradient_opacity", text_of(transfer.gradient_factors));
  return out;
}

}  // namespace catena::scene
