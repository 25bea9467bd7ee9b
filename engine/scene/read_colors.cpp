// SPDX-License-Identifier: MIT
#include "engine/base/text.h"
#include "engine/scene/reader_bindings.h"
#include "engine/scene/to_json.h"

namespace catena::scene {

Key clip_key() {
  return schema::boolean("clip", "Clipping by the planes of `clip`; false: the object is not clipped.").with_default("true");
}
Key visible_key() {
  return schema::boolean("visible", "Visibility in the image; haptics and objects that refer to a hidden object are unaffected.")
      .with_default("true");
}
Key threshold_key() {
  return schema::any_of("threshold", {schema::vector("", 2, "value", ""), schema::table("", 2, "value", "")},
                        "Range `[LO, HI]` of the values that are shown, or two such ranges; whatever has another value is left out.")
      .with_range_text("not falling")
      .with_default("all values");
}
Key opacity_key(const std::string& help) { return schema::number("opacity", "", help).within(0, 1); }

Keys color_scale_keys(std::string_view map, const std::string& range) {
  return {schema::any_of("color", {schema::table("", 4, "value", ""), schema::text("", "")},
                         "Colour table with rows `[value, r, g, b]`, or the name of a colour map (`catena info --colormaps`).")
              .with_range_text("values rising")
              .with_default("\"" + std::string(map) + "\""),
          schema::vector("range", 2, "value", "Values at the two ends of the colour map; not together with a colour table.")
              .with_range_text("rising")
              .with_default(range),
          schema::choice("mapping", {std::begin(kMappingNames), std::end(kMappingNames)},
                         "Scale between the points of colours and opacities: linear, logarithmic, or `symlog`, logarithmic on both sides "
                         "of 0 and linear near 0.")
              .with_default("\"linear\""),
          schema::number("linear_below", "value", "Magnitude of the values up to which `symlog` is linear.")
              .positive()
              .with_default("a thousandth of the maximum magnitude"),
          schema::file("transfer",
                       "File with the colours and opacities: a transfer file of Catena (`assets/transfer/`) or a colour map of ParaView.")};
}

Keys transfer_keys() {
  return schema::concatenate(
      color_scale_keys(kDefaultVolumeColorMap, "0.5 to 99.8 percentile; with a named map the display range"),
      {schema::table("opacity", 2, "value, 1", "Rows `[value, alpha]`, with alpha per `opacity_unit`; an alpha of 1 is treated as 0.999.")
           .with_range_text("0 <= alpha <= 1")
           .with_default("fitted to the values"),
       schema::number("opacity_unit", "world", "Length to which alpha refers.").positive().with_default("the smallest voxel edge"),
       schema::table("extinction", 2, "value, 1/world", "Rows `[value, sigma]` of the extinction, instead of `opacity`.")
           .with_range_text("sigma >= 0"),
       schema::table("gradient_opacity", 2, "value/world, 1",
                     "Rows `[gradient, factor]`; the factor multiplies the extinction where the gradient has this magnitude.")
           .with_range_text("factor 0 to 1")
           .with_default("1 everywhere"),
       threshold_key()});
}

/// Reads the colors of values: the object "color_by", {"field", "quantity" or "value", "color", "range", "mapping", "transfer"}.

namespace {

constexpr std::string_view kQuantities[] = {"speed", "arc_length"};

bool knows_quantities(ColorTarget subjects) { return subjects == ColorTarget::lines || subjects == ColorTarget::glyphs; }

Outcome take_scale(const Scene& scene, const json::Node& object, ColorBy& by) {
  by.where = object;
  CATENA_TRY(ColorScale scale, read_color_scale(scene.path, object));
  by.colors = std::move(scale.colors);
  by.named = std::move(scale.named);
  return Done{};
}

Outcome read_object(const Scene& scene, const json::Node& node, ColorTarget subjects, ColorBy& by) {
  CATENA_CHECK(json::check_known_keys(node, schema::key_names(*color_by_key(subjects).members)));
  const json::Node *field = node.find("field"), *quantity = node.find("quantity"), *value = node.find("value");
  if (knows_quantities(subjects) && (field != nullptr) == (quantity != nullptr))
    return json::error_at(node, std::string("\"color_by\" names ") + (field != nullptr ? "both" : "neither") +
                                    " \"field\" and \"quantity\"; exactly one of them was expected");
  if (subjects == ColorTarget::curves && (field != nullptr) + (quantity != nullptr) + (value != nullptr) != 1)
    return json::error_at(node,
                          "\"color_by\" names none or several of \"field\", \"value\" and \"quantity\"; exactly one of them was expected");
  if (subjects == ColorTarget::points && (field != nullptr) == (value != nullptr))
    return json::error_at(node, std::string("\"color_by\" names ") + (field != nullptr ? "both" : "neither") +
                                    " \"field\" and \"value\"; exactly one of them was expected");
  if (value != nullptr) {
    by.source = ColorBy::Source::value;
    CATENA_TRY(by.value_name, json::require_string(node, "value"));
  } else if (quantity != nullptr && subjects == ColorTarget::curves) {
    CATENA_CHECK(json::get_choice(node, "quantity", 0, {kQuantities[1]}));
    by.source = ColorBy::Source::arc_length;
  } else if (quantity != nullptr) {
    std::vector<std::string_view> known{kQuantities[0]};
    if (subjects == ColorTarget::lines) known.push_back(kQuantities[1]);
    CATENA_TRY(const int index, json::get_choice(node, "quantity", 0, known));
    by.source = index == 0 ? ColorBy::Source::speed : ColorBy::Source::arc_length;
  } else {
    CATENA_TRY(by.field, read_field_name(scene, node));
  }
  return take_scale(scene, node, by);
}

}  // namespace

Key color_by_key(ColorTarget subjects) {
  Keys keys{schema::reference("field", Role::any_field, "Field whose values give the colours; of a vector field, the magnitude.")};
  if (subjects == ColorTarget::lines)
    keys.push_back(schema::choice("quantity", {std::string(kQuantities[0]), std::string(kQuantities[1])},
                                  "Quantity that gives the colours, instead of `field`: speed of the flow, or arc length from the seed."));
  else if (subjects == ColorTarget::glyphs)
    keys.push_back(schema::choice("quantity", {std::string(kQuantities[0])},
                                  "Quantity that gives the colours, instead of `field`: speed of the flow."));
  else if (subjects == ColorTarget::points)
    keys.push_back(schema::text("value", "Name of the table column that gives the colours, instead of `field`."));
  else if (subjects == ColorTarget::curves) {
    keys.push_back(schema::text("value", "Name of the point values in the file that give the colours, instead of `field` or `quantity`."));
    keys.push_back(schema::choice("quantity", {std::string(kQuantities[1])},
                                  "Quantity that gives the colours, instead of `field` or `value`: arc length along the curve."));
  } else
    keys[0] = keys[0].required();
  keys = schema::concatenate(keys, color_scale_keys());
  if (subjects != ColorTarget::rays) keys.push_back(threshold_key());
  return schema::object("color_by", std::move(keys), "Colouring by values.");
}

Outcome read_plain_color(const json::Node& item, Color& out) {
  const json::Node* color = item.find("color");
  const bool of_values =
      color != nullptr && (color->kind == json::Kind::string ||
                           (color->kind == json::Kind::array && !color->items.empty() && color->items[0].kind == json::Kind::array));
  if (of_values) return json::error_at(*color, "\"color\" is a table or a colour map; such colours were expected within \"color_by\"");
  return schema::read_value(schema::color("color", ""), item, out);
}

Outcome read_color_by(Scene& scene, const json::Node& item, ColorTarget subjects, std::optional<ColorBy>& out) {
  const json::Node* node = item.find("color_by");
  if (node == nullptr) return Done{};
  out.emplace();
  CATENA_CHECK(json::expect_object(*node, "color_by"));
  return read_object(scene, *node, subjects, *out);
}

std::string to_json(const Scene& scene, const ColorBy& by) {
  std::string out =
      by.source == ColorBy::Source::field   ? "{\"field\": " + to_json(std::string_view(scene.entities.get<Name>(by.field).value))
      : by.source == ColorBy::Source::value ? "{\"value\": " + to_json(std::string_view(by.value_name))
                                            : "{\"quantity\": " + to_json(kQuantities[by.source == ColorBy::Source::speed ? 0 : 1]);
  for (const auto& [key, value] : color_scale_members(by.colors, by.named)) out += ", \"" + key + "\": " + value;
  return out + "}";
}

schema::Members color_scale_members(const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named) {
  schema::Members out;
  if (!colors.empty()) out.emplace_back("color", to_json(colors));
  if (colors.empty() && !named.map.empty()) out.emplace_back("color", to_json(std::string_view(named.map)));
  if (colors.empty() && named.range) out.emplace_back("range", to_json(*named.range));
  if (named.mapping.kind != ValueMapping::Kind::linear) out.emplace_back("mapping", to_json(to_string(named.mapping.kind)));
  if (named.mapping.linear_below > 0) out.emplace_back("linear_below", to_json(named.mapping.linear_below));
  if (!named.threshold.empty()) out.emplace_back("threshold", to_json(named.threshold));
  return out;
}

schema::Members transfer_members(const TransferFunction& transfer) {
  auto out = color_scale_members(transfer.colors, transfer.named);
  if (!transfer.opacities.empty()) out.emplace_back("opacity", to_json(transfer.opacities));
  if (!transfer.opacities.empty() && transfer.opacity_unit > 0) out.emplace_back("opacity_unit", to_json(transfer.opacity_unit));
  if (transfer.opacities.empty() && !transfer.extinctions.empty()) out.emplace_back("extinction", to_json(transfer.extinctions));
  if (!transfer.gradient_factors.empty()) out.emplace_back("gradient_opacity", to_json(transfer.gradient_factors));
  return out;
}

}  // namespace catena::scene
