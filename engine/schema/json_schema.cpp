// SPDX-License-Identifier: MIT
#include "engine/schema/documents.h"

#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"

namespace catena::schema {

namespace {

using json::serialize_string;

std::string items_limits(const Key& key) {
  std::string out;
  if (key.min_size > 0) out += ", \"minItems\": " + std::to_string(key.min_size);
  if (key.max_size > 0) out += ", \"maxItems\": " + std::to_string(key.max_size);
  return out;
}

std::string number_schema(const Key& key) {
  std::string out = key.value_type == ValueType::integer ? R"("type": "integer")" : R"("type": "number")";
  const Limits& l = key.limits;
  if (l.lo) out += (l.lo_open ? ", \"exclusiveMinimum\": " : ", \"minimum\": ") + to_text(*l.lo);
  if (l.hi) out += (l.hi_open ? ", \"exclusiveMaximum\": " : ", \"maximum\": ") + to_text(*l.hi);
  return out;
}

/// Returns the schema of an array of `count` numbers, each within the limits.
std::string row_schema(int count, const Limits& limits = {}) {
  Key one;
  one.limits = limits;
  const std::string n = std::to_string(count);
  return R"("type": "array", "items": {)" + number_schema(one) + "}, \"minItems\": " + n + ", \"maxItems\": " + n;
}

std::string list_schema(const std::string& item, const Key& key) {
  return R"("type": "array", "items": {)" + item + "}" + items_limits(key);
}

/// Schema of a value mapped from a field (haptics/constraints/common/link_schema.h).
const char* const kFieldMap =
    R"({"type": "object", "required": ["field", "map"], "properties": {"field": {"type": "string", "description": "Field that is evaluated at the proxy."}, "map": {"type": "array", "minItems": 1, "description": "Pairs [value, output] with increasing values; linear interpolation between them.", "items": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}}, "quantity": {"enum": ["value", "gradient", "magnitude"]}, "normalise": {"type": "boolean", "description": "Whether the values of `map` are fractions of the range of the field, from 0 to 1."}, "outside": {"type": "number", "description": "Output where the field has no value. Default: the first output of `map`."}}, "additionalProperties": false})";
const char* const kWidget =
    R"({"type": "object", "required": ["widget"], "properties": {"widget": {"type": "string", "description": "Name of the widget that sets the value."}}, "additionalProperties": false})";
const char* const kRotation =
    R"("oneOf": [{"type": "array", "items": {"type": "number"}, "minItems": 9, "maxItems": 9}, {"type": "array", "items": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}, "minItems": 3, "maxItems": 3}, {"type": "object", "required": ["axis", "angle_deg"], "properties": {"axis": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}, "angle_deg": {"type": "number"}}, "additionalProperties": false}])";

/// Returns the members of the key's schema, without the braces and the description.
std::string body(const Key& key) {
  switch (key.value_type) {
    case ValueType::number:
    case ValueType::integer:
      return number_schema(key);
    case ValueType::boolean:
      return R"("type": "boolean")";
    case ValueType::text:
      return std::string(R"("type": "string")") + (key.is_identifier ? R"(, "pattern": "^[a-z][a-z0-9_]*$")" : "") +
             (key.max_size > 0 ? ", \"maxLength\": " + std::to_string(key.max_size) : "");
    case ValueType::choice: {
      std::string words;
      for (const std::string& w : key.options) words += (words.empty() ? "" : ", ") + serialize_string(w);
      return "\"enum\": [" + words + "]";
    }
    case ValueType::vector:
      return row_schema(key.count, key.limits) + (key.range_text == "not 0" ? R"(, "not": {"const": [0, 0, 0]})" : "");
    case ValueType::color:
      return row_schema(3, {0.0, 1.0});
    case ValueType::numbers:
      return list_schema(R"("type": "number")", key);
    case ValueType::texts:
      return list_schema(R"("type": "string")", key);
    case ValueType::points:
      return list_schema(row_schema(3), key);
    case ValueType::table:
      return list_schema(row_schema(key.count), key);
    case ValueType::rotation:
      return kRotation;
    case ValueType::null:
      return R"("type": "null")";
    case ValueType::object: {
      // an object without declared keys is read by another module
      if (key.members->empty()) return R"("type": "object")";
      const std::string object_text = object_schema(*key.members);
      return object_text.substr(1, object_text.size() - 2);
    }
    case ValueType::any_of: {
      if (key.alternatives.empty()) return R"("type": ["array", "object"])";
      std::string all;
      for (const Key& choice : key.alternatives) all += (all.empty() ? "" : ", ") + json_schema(choice);
      return "\"anyOf\": [" + all + "]";
    }
  }
  return {};
}

std::string sentence(const std::string& help) { return help.empty() ? std::string() : "\"description\": " + serialize_string(help) + ", "; }

/// Returns the description with the unit and the default, as an editor shows it.
std::string described(const Key& key) {
  std::string text = key.help;
  if (key.unit == "world") text += " In world units.";
  if (key.unit == "value") text += " In the field's units.";
  if (!key.unit.empty() && key.unit != "world" && key.unit != "value") text += " In " + key.unit + ".";
  if (!key.default_text.empty()) text += " Default: " + key.default_text + ".";
  return key.name.empty() ? std::string() : sentence(text);
}

}  // namespace

std::string json_schema(const Key& key) {
  if (!key.accepts_field_map && !key.accepts_widget) return "{" + described(key) + body(key) + "}";
  return "{" + described(key) + "\"oneOf\": [{" + body(key) + "}" + (key.accepts_field_map ? std::string(", ") + kFieldMap : "") +
         (key.accepts_widget ? std::string(", ") + kWidget : "") + "]}";
}

std::string object_schema(const Keys& keys, const std::string& help, const std::string& more) {
  std::string properties = more, required;
  for (const Key& key : keys) {
    properties += (properties.empty() ? "" : ", ") + serialize_string(key.name) + ": " + json_schema(key);
    if (key.is_required) required += (required.empty() ? "" : ", ") + serialize_string(key.name);
  }
  return "{" + sentence(help) + "\"type\": \"object\", \"properties\": {" + properties + "}" +
         (required.empty() ? "" : ", \"required\": [" + required + "]") + ", \"additionalProperties\": false}";
}

namespace {

/// Returns the schema of one item of a list or map section, or of a section that is a single object.
std::string item_schema(const Section& component) {
  if (component.variants.empty()) return object_schema(component.keys);
  const bool typed = find(component.keys, "type") != nullptr;
  std::string all;
  for (const Variant& variant : component.variants) {
    Keys keys;
    for (const Key& key : component.keys)
      if (key.name != "type") keys.push_back(key);
    const std::string type = typed ? "\"type\": {\"const\": " + serialize_string(variant.name) + "}" : std::string();
    std::string one = object_schema(concatenate(keys, variant.keys), variant.help, type);
    if (typed) {
      // "type" is required as well
      const std::string list = "\"required\": [";
      const std::size_t at = one.rfind(list);
      one = at == std::string::npos ? one.substr(0, one.size() - 1) + ", \"required\": [\"type\"]}"
                                    : one.insert(at + list.size(), "\"type\", ");
    }
    all += (all.empty() ? "" : ",\n      ") + one;
  }
  return std::string("{\"") + (typed ? "oneOf" : "anyOf") + "\": [\n      " + all + "]}";
}

}  // namespace

std::string json_schema(const Section& component) {
  if (component.layout == Section::Layout::value) return json_schema(component.keys.front());
  const std::string item = item_schema(component);
  switch (component.layout) {
    case Section::Layout::list:
      return "{" + sentence(component.help) + "\"type\": \"array\", \"items\": " + item +
             (component.max_items > 0 ? ", \"maxItems\": " + std::to_string(component.max_items) : "") + "}";
    case Section::Layout::map:
      return "{" + sentence(component.help) + R"("type": "object", "propertyNames": {"pattern": "^[a-z][a-z0-9_]*$"}, )" +
             "\"additionalProperties\": " + item + "}";
    case Section::Layout::on_off:
      return "{" + sentence(component.help) + R"("anyOf": [{"type": "boolean"}, )" + item + "]}";
    default:
      return "{" + sentence(component.help) + item.substr(1);
  }
}

std::string json_schema(const std::vector<Section>& components, const std::string& title) {
  std::string properties = "    \"$schema\": {\"type\": \"string\"}";
  for (const Section& component : components) properties += ",\n    " + serialize_string(component.name) + ": " + json_schema(component);
  return "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": " + serialize_string(title) +
         ",\n  \"type\": \"object\",\n  \"properties\": {\n" + properties + "\n  },\n  \"additionalProperties\": false\n}\n";
}

}  // namespace catena::schema
