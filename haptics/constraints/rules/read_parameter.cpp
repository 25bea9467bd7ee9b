#include "haptics/constraints/rules/read_parameter.h"

#include <fmt/format.h>

#include "engine/field/magnitude.h"

namespace catena::haptics {
namespace {

/// What `normalise` maps to 0 and 1.
Outcome set_scale(const json::Node& node, const std::string& name, ParameterMap& map) {
  if (map.by == ParameterMap::By::value) {
    map.lo = map.field.scalar->min_value();
    map.hi = map.field.scalar->max_value();
    if (!std::isfinite(map.lo) || !std::isfinite(map.hi))
      return json::error_at(*node.find("normalise"),
                            fmt::format("field \"{}\" has no finite range to normalise by; \"map\" over its values, "
                                        "without \"normalise\", was expected",
                                        name));
    return Done{};
  }
  map.hi = map.field.scalar ? field::largest_gradient(*map.field.scalar) : field::largest_magnitude(*map.field.vector);
  return Done{};
}

Result<Parameter> read_map(const json::Node& node, std::string_view key, json::Range range, const BuildContext& context) {
  CATENA_CHECK(json::only_keys(node, {"field", "map", "of", "normalise", "outside"}));
  auto map = std::make_shared<ParameterMap>();
  CATENA_TRY(const std::string name, json::require_string(node, "field"));
  CATENA_TRY(map->field, context.field(*node.find("field"), name));

  // which quantity of the field
  const bool vector = map->field.vector != nullptr;
  CATENA_TRY(const int of, json::get_choice(node, "of", vector ? 2 : 0, {"value", "gradient", "magnitude"}));
  map->by = static_cast<ParameterMap::By>(of);
  if (vector != (map->by == ParameterMap::By::magnitude))
    return json::error_at(*node.find("of"), fmt::format("\"{}\" is a {} field; \"of\": {} was expected", name, vector ? "vector" : "scalar",
                                                        vector ? "\"magnitude\"" : "\"value\" or \"gradient\""));
  CATENA_TRY(map->normalise, json::get_boolean(node, "normalise", false));
  if (map->normalise) CATENA_CHECK(set_scale(node, name, *map));

  // the points
  const json::Node* points = node.find("map");
  if (points == nullptr) return json::error_at(node, fmt::format("\"{}\" has no \"map\"; [[value, output], ...] was expected", key));
  CATENA_TRY(const auto rows, json::as_rows(*points, "map", 2));
  if (rows.empty()) return json::error_at(*points, "\"map\" is empty; [[value, output], ...] was expected");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const json::Node& item = points->items[i];
    CATENA_TRY(const double output, json::as_number(item.items[1], key, range));
    if (i > 0 && !(rows[i][0] > rows[i - 1][0]))
      return json::error_at(item, fmt::format("the values of \"map\" do not rise; a value > {} was expected", rows[i - 1][0]));
    map->points.push_back({rows[i][0], output});
  }
  CATENA_TRY(map->outside, json::get_number(node, "outside", map->points.front().output, range));
  return Parameter(std::shared_ptr<const ParameterMap>(std::move(map)));
}

}  // namespace

Result<Parameter> get_parameter(const json::Node& link, std::string_view key, const Parameter& fallback, json::Range range,
                                const BuildContext& context) {
  const json::Node* node = link.find(key);
  if (node == nullptr) return fallback;
  if (node->kind == json::Kind::object) return read_map(*node, key, range, context);
  CATENA_TRY(const double value, json::as_number(*node, key, range));
  return Parameter(value);
}

Result<Parameter> require_parameter(const json::Node& link, std::string_view key, json::Range range, const BuildContext& context) {
  if (link.find(key) == nullptr) {
    CATENA_CHECK(json::require_number(link, key, range));
  }
  return get_parameter(link, key, 0.0, range, context);
}

}  // namespace catena::haptics
