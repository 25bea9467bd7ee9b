// SPDX-License-Identifier: MIT
/// Reads fields that are derived from other fields: "derived" and "expression".
#include <fmt/format.h>

#include <algorithm>

#include "engine/base/numbers.h"
#include "engine/field/derived/derive.h"
#include "engine/field/derived/node_function.h"
#include "engine/scene/derived_fields.h"
#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

using Kind = DerivedSource::Kind;

constexpr std::size_t kMaxVariables = 32;

std::vector<std::string> derived_names() {
  std::vector<std::string> names;
  for (const field::QuantityInfo& info : field::quantities()) names.emplace_back(info.name);
  for (const char* name : {"component", "vector", "smooth", "resample"}) names.emplace_back(name);
  return names;
}

/// Returns 0, 1 or 2 for "x", "y" or "z"; -1: something else.
int component_of(std::string_view text) { return text.size() == 1 && text[0] >= 'x' && text[0] <= 'z' ? text[0] - 'x' : -1; }

Outcome refuse_key(const json::Node& node, const char* key, bool is_used, const std::string& word) {
  const json::Node* value = node.find(key);
  if (value == nullptr || is_used) return Done{};
  return json::error_at(*value, in_quotes(key) + " does not belong to " + in_quotes(word) + "; it was not expected here");
}

Outcome read_sources(const json::Node& node, Kind kind, DerivedSource& derived) {
  const json::Node* sources = node.find("source");
  if (sources == nullptr) return json::error_at(node, "key \"source\" is missing; the name of a field was expected");
  const bool is_list = sources->kind == json::Kind::array;
  if (is_list != (kind == Kind::vector) || (is_list && sources->items.size() != 3))
    return json::error_at(*sources, kind == Kind::vector ? "\"source\" is not a list of three names; three scalar fields were expected"
                                                         : "\"source\" is not a name; one field was expected");
  if (!is_list) {
    CATENA_TRY(derived.sources.emplace_back(), json::as_string(*sources, "source"));
    return Done{};
  }
  for (const json::Node& item : sources->items) {
    CATENA_TRY(derived.sources.emplace_back(), json::as_string(item, "source"));
  }
  return Done{};
}

Outcome read_derived(const json::Node& node, DerivedSource& derived) {
  CATENA_CHECK(json::check_known_keys(node, schema::key_names(derived_keys())));
  int index = 0;
  CATENA_CHECK(schema::read_choice(*schema::find(derived_keys(), "derived"), node, index));
  const std::string word = derived_names()[std::size_t(index)];
  const auto quantities = int(field::quantities().size());
  derived.kind = index < quantities
                     ? Kind::quantity
                     : std::array{Kind::component, Kind::vector, Kind::smooth, Kind::resample}[std::size_t(index - quantities)];
  if (index < quantities) derived.quantity = field::quantities()[std::size_t(index)].quantity;
  CATENA_CHECK(read_sources(node, derived.kind, derived));
  const bool differs = derived.kind == Kind::quantity && field::info_of(derived.quantity).derivatives > 0;
  CATENA_CHECK(refuse_key(node, "order", differs, word));
  CATENA_CHECK(refuse_key(node, "component", derived.kind == Kind::component, word));
  CATENA_CHECK(refuse_key(node, "sigma", derived.kind == Kind::smooth, word));
  CATENA_CHECK(refuse_key(node, "on", derived.kind == Kind::resample || derived.kind == Kind::vector, word));
  CATENA_TRY(derived.order, json::get_integer(node, "order", 2, 2, 4));
  if (derived.order == 3) return json::error_at(*node.find("order"), "\"order\" is 3; 2 or 4 was expected");
  CATENA_TRY(derived.on, json::get_string(node, "on", {}));
  if (derived.kind == Kind::component) {
    CATENA_TRY(const std::string component, json::require_string(node, "component"));
    derived.component = component_of(component);
    if (derived.component < 0)
      return json::error_at(*node.find("component"), in_quotes(component) + " is no component; \"x\", \"y\" or \"z\" was expected");
  }
  if (derived.kind == Kind::smooth) {
    CATENA_TRY(derived.sigma, json::require_number(node, "sigma"));
    if (!(derived.sigma > 0)) return json::error_at(*node.find("sigma"), "\"sigma\" is not positive; a number > 0 was expected");
  }
  if (derived.kind == Kind::resample && derived.on.empty())
    return json::error_at(node, "key \"on\" is missing; the name of the field whose nodes are used was expected");
  return Done{};
}

Outcome read_variables(const json::Node& node, DerivedSource& derived) {
  const json::Node* variables = node.find("variables");
  if (variables == nullptr) return Done{};
  CATENA_CHECK(json::expect_object(*variables, "variables"));
  if (variables->members.size() > kMaxVariables)
    return json::error_at(*variables,
                          fmt::format("\"variables\" has {} entries; at most {} were expected", variables->members.size(), kMaxVariables));
  for (const auto& [name, value] : variables->members) {
    CATENA_CHECK(check_name("variable", name, value));
    if (name == "x" || name == "y" || name == "z" || name == "t")
      return json::error_at(value, "variable " + in_quotes(name) + " is the position or the time; another name was expected");
    CATENA_TRY(const std::string text, json::as_string(value, name));
    const std::size_t dot = text.rfind('.');
    const int component = dot == std::string::npos ? -1 : component_of(std::string_view(text).substr(dot + 1));
    if (dot != std::string::npos && component < 0)
      return json::error_at(value,
                            in_quotes(text) + " has no such component; a name like \"wind.x\", \"wind.y\" or \"wind.z\" was expected");
    derived.variables.push_back(name);
    derived.sources.push_back(text.substr(0, dot));
    derived.components.push_back(component);
  }
  return Done{};
}

Outcome read_expression(const json::Node& node, FieldSource& source, DerivedSource& derived) {
  CATENA_CHECK(json::check_known_keys(node, schema::key_names(expression_keys())));
  derived.kind = Kind::expression;
  CATENA_CHECK(read_variables(node, derived));
  const json::Node& expression = *node.find("expression");
  const auto add = [&](const json::Node& text) -> Outcome {
    CATENA_TRY(const std::string& added, Result<std::string>(json::as_string(text, "expression")));
    const field::ExpressionFault fault = field::check_expression(added, derived.variables);
    if (!fault.message.empty())
      return json::error_at(text, fmt::format("expression {}, column {}: {}", in_quotes(added), fault.column, fault.message));
    derived.expressions.push_back(added);
    return Done{};
  };
  if (expression.kind != json::Kind::array) CATENA_CHECK(add(expression));
  if (expression.kind == json::Kind::array && expression.items.size() != 3)
    return json::error_at(expression,
                          "\"expression\" is not one text or a list of three; a scalar or the components of a vector were expected");
  for (const json::Node& item : expression.items) CATENA_CHECK(add(item));
  CATENA_TRY(derived.on, json::get_string(node, "on", {}));
  return read_sampling(node, source);
}

}  // namespace

Keys derived_keys() {
  std::vector<std::string> names = derived_names();
  return {schema::choice(
              "derived", std::move(names),
              "Quantity, by its name; or a component, three fields as a vector, a smoothed field, or a field at another one's nodes.")
              .required(),
          schema::any_of("source", {schema::reference("", Role::any_field, "Field."), schema::texts("", "Three scalar fields.")},
                         "Field that it is derived from; for `vector` three of them.")
              .required(),
          schema::integer("order", "", "Order of the differences between nodes: 2 or 4.", 2, 4).with_default("2"),
          schema::text("component", "Component: `\"x\"`, `\"y\"` or `\"z\"`."),
          schema::number("sigma", "world", "Standard deviation of the Gaussian that smooths.").positive(),
          schema::reference("on", Role::any_field, "Field whose nodes are used.").with_default("for `vector` the first one on a grid"),
          unit_key()};
}

Keys expression_keys() {
  return schema::concatenate(
      {schema::any_of("expression", {schema::text("", ""), schema::texts("", "")},
                      "Expression of the variables, of `x`, `y`, `z` (world) and of `t` (time); three of them for a vector field.")
           .required(),
       schema::object("variables", {}, "Names and the fields they stand for: `{\"u\": \"wind.x\", \"p\": \"pressure\"}`.")
           .with_default("none"),
       schema::reference("on", Role::any_field, "Field whose nodes are used.").with_default("the first variable on a grid, else `box`")},
      schema::concatenate(sampling_keys(), {unit_key()}));
}

Outcome read_derived_source(const json::Node& node, FieldSource& source) {
  DerivedSource& derived = source.derived.emplace();
  return node.find("derived") != nullptr ? read_derived(node, derived) : read_expression(node, source, derived);
}

Outcome check_derived_sources(const Scene& scene) {
  Outcome outcome = Done{};
  scene.entities.each<FieldSource>([&](Entity, const FieldSource& source) {
    if (!outcome || !source.derived) return;
    std::vector<std::string> names = source.derived->sources;
    if (!source.derived->on.empty()) names.push_back(source.derived->on);
    for (const std::string& name : names)
      if (outcome && !find_field(scene, name)) {
        const auto known = require_named<FieldSource>(scene, name, source.where, "field", "fields");
        outcome = known.error();
      }
  });
  if (!outcome) return outcome;
  // a field that is derived from itself
  scene.entities.each<FieldSource>([&](Entity entity, const FieldSource& source) {
    if (!outcome || !source.derived || !is_derived_from(scene, entity, entity)) return;
    outcome = json::error_at(source.where, "field " + in_quotes(scene.entities.get<Name>(entity).value) +
                                               " is derived from itself; another source was expected");
  });
  return outcome;
}

}  // namespace catena::scene
