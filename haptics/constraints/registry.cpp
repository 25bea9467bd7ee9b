#include "haptics/constraints/registry.h"

#include <fmt/format.h>

#include "haptics/constraints/forces/gradient_force.h"
#include "haptics/constraints/forces/viscosity.h"
#include "haptics/constraints/friction/drag.h"
#include "haptics/constraints/friction/friction.h"
#include "haptics/constraints/friction/modulated_friction.h"
#include "haptics/constraints/friction/texture.h"
#include "haptics/constraints/isosurface/isosurface.h"
#include "haptics/constraints/mesh/mesh.h"
#include "haptics/constraints/presets/modes.h"
#include "haptics/constraints/rules/snap.h"
#include "haptics/constraints/shapes/box.h"
#include "haptics/constraints/shapes/line.h"
#include "haptics/constraints/shapes/plane.h"
#include "haptics/constraints/shapes/point.h"
#include "haptics/constraints/shapes/polyline.h"
#include "haptics/constraints/shapes/segment.h"
#include "haptics/constraints/shapes/sphere.h"
#include "haptics/constraints/streamline/streamline.h"
#include "haptics/constraints/streamline/vortex_core.h"

namespace catena::haptics {
namespace {

/// A parameter: a number, or an object (read_parameter.h).
std::string parameter(const Key& key) {
  return fmt::format(
      R"("{0}": {{"description": "{1}", "oneOf": [{{"type": "number"{2}{3}}}, {{"type": "object", "required": ["field", "map"], "properties": {{"field": {{"type": "string"}}, "map": {{"type": "array", "minItems": 1, "description": "[value, output] pairs, values rising", "items": {{"type": "array", "items": {{"type": "number"}}, "minItems": 2, "maxItems": 2}}}}, "of": {{"enum": ["value", "gradient", "magnitude"]}}, "normalise": {{"type": "boolean", "description": "values run 0..1 over the range of the field"}}, "outside": {{"type": "number", "description": "where the field says nothing; default: the first output"}}}}, "additionalProperties": false}}]}})",
      key.name, key.help, key.schema.empty() ? "" : ", ", key.schema);
}

std::string property(const Key& key) {
  if (key.type == "parameter") return parameter(key);
  if (key.type == "rotation")
    return fmt::format(
        R"("{}": {{"description": "{}", "oneOf": [{{"type": "array", "minItems": 3, "maxItems": 9}}, {{"type": "object", "required": ["axis", "angle_deg"], "properties": {{"axis": {{"type": "array", {}}}, "angle_deg": {{"type": "number"}}}}, "additionalProperties": false}}]}})",
        key.name, key.help, kVec3Schema);
  const bool named = key.type == "scalar_field" || key.type == "vector_field" || key.type == "mesh";
  return fmt::format(R"("{}": {{"type": "{}", "description": "{}"{}{}}})", key.name, named ? "string" : key.type, key.help,
                     key.schema.empty() ? "" : ", ", key.schema);
}

/// Of a constraint, or of a ready-made mode.
template <class Type>
std::string link_schema(const Type& type) {
  std::string properties = fmt::format(R"("type": {{"const": "{}", "description": "{}"}})", type.type, type.paper);
  std::string required = R"("type")";
  const auto add = [&](const Key& key) {
    if (key.name == "type") return;
    properties += fmt::format(",\n        {}", property(key));
    if (key.required) required += fmt::format(R"(, "{}")", key.name);
  };
  for (const Key& key : common_keys()) add(key);
  for (const Key& key : type.keys) add(key);
  return fmt::format(
      "    {{\n      \"type\": \"object\",\n      \"properties\": {{\n        {}\n      }},\n      \"required\": [{}],\n"
      "      \"additionalProperties\": false\n    }}",
      properties, required);
}

std::string known_types() {
  std::string list;
  for (const ConstraintType& type : registry()) list += (list.empty() ? "" : ", ") + std::string(type.type);
  for (const ReadyMode& mode : ready_modes()) list += ", " + std::string(mode.type);
  return list;
}

}  // namespace

const std::vector<ConstraintType>& registry() {
  static const std::vector<ConstraintType> list{
      point_constraint(),               //
      line_constraint(),                //
      segment_constraint(),             //
      polyline_constraint(),            //
      plane_constraint(),               //
      sphere_constraint(),              //
      box_constraint(),                 //
      mesh_constraint(),                //
      isosurface_constraint(),          //
      streamline_constraint(),          //
      drag_constraint(),                //
      friction_constraint(),            //
      modulated_friction_constraint(),  //
      texture_constraint(),             //
      viscosity_constraint(),           //
      gradient_force_constraint(),      //
      vortex_core_constraint(),         //
  };
  return list;
}

const ConstraintType* find_constraint(std::string_view type) {
  for (const ConstraintType& entry : registry())
    if (entry.type == type) return &entry;
  return nullptr;
}

const std::vector<Key>& common_keys() {
  static const std::vector<Key> keys{
      {"name", "string", true, "unique; names the columns of the tick CSV", R"("pattern": "^[a-z][a-z0-9_]*$")"},
      {"type", "string", true, "which constraint"},
      {"stiffness", "parameter", false, "N/m; default: the coupling's", kNotNegativeSchema},
      {"snap", "parameter", false, "starts apart and takes hold within this distance of the feature, world units", kPositiveSchema},
      {"release", "parameter", false, "lets go at this distance of the probe from the proxy, world units; default: 2 snap, or never",
       kPositiveSchema},
      {"on", "object", false, "its switch: {button: n, toggle: true} or {force_above: newtons, force_below: newtons}",
       R"("properties": {"button": {"type": "integer", "minimum": 1, "maximum": 32}, "toggle": {"type": "boolean"}, "force_above": {"type": "number", "exclusiveMinimum": 0}, "force_below": {"type": "number", "minimum": 0}}, "additionalProperties": false, "minProperties": 1, "maxProperties": 2)"},
      {"enabled", "boolean", false, "false: off, whatever its switch says"},
      {"indicate", "object", false, "how the hand is told that it leaves the feature",
       R"("properties": {"cue": {"enum": ["none", "detent", "vibration"]}, "at": {"type": "number", "exclusiveMinimum": 0}, "from": {"type": "number", "minimum": 0, "maximum": 1}, "amplitude": {"type": "number", "minimum": 0}, "frequency": {"type": "number", "exclusiveMinimum": 0}, "duration": {"type": "number", "exclusiveMinimum": 0}}, "additionalProperties": false)"},
      {"align", "object", false, "turns the tool's axis onto the surface's normal or the curve's tangent; stiffness in N m/rad",
       R"("properties": {"axis": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3, "description": "tool frame; default [0, 0, 1]"}, "stiffness": {"type": "number", "minimum": 0, "description": "default: the coupling's rotational_stiffness"}, "sign": {"enum": ["either", "same"], "description": "either (default): the nearer of the axis's two ends"}}, "additionalProperties": false)"}};
  return keys;
}

std::string chain_schema() {
  std::string links;
  for (const ConstraintType& type : registry()) links += (links.empty() ? "" : ",\n") + link_schema(type);
  for (const ReadyMode& mode : ready_modes()) links += ",\n" + link_schema(mode);
  return fmt::format(
      "{{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"chain\",\n  \"type\": \"array\",\n"
      "  \"maxItems\": {},\n  \"items\": {{ \"oneOf\": [\n{}\n  ] }}\n}}\n",
      exchange::kMaxSceneLinks, links);
}

Result<std::shared_ptr<const Constraint>> build_constraint(const json::Node& link, const BuildContext& context) {
  CATENA_CHECK(json::expect_object(link, "a link of the chain"));
  CATENA_TRY(const std::string word, json::require_string(link, "type"));
  const ConstraintType* type = find_constraint(word);
  if (!type)
    return json::error_at(*link.find("type"), fmt::format("unknown constraint type \"{}\"; expected one of {}", word, known_types()));
  std::vector<std::string_view> keys;
  for (const Key& key : common_keys()) keys.push_back(key.name);
  for (const Key& key : type->keys) keys.push_back(key.name);
  CATENA_CHECK(json::only_keys(link, keys));
  CATENA_TRY(std::shared_ptr<const Constraint> made, type->build(link, context));
  return wrap_snap(link, type->releases_itself, std::move(made), context);
}

}  // namespace catena::haptics
