// SPDX-License-Identifier: MIT
#include "haptics/constraints/presets/mode_presets.h"

#include <fmt/format.h>

namespace catena::haptics {
namespace {

ModePreset anisotropic_friction() {
  return {
      "anisotropic_friction",
      "Three links in one: an isosurface, friction across a vector field, and friction along the field that depends on the angle between "
      "field and surface. `stiffness`, `active_when` and `enabled` apply to all three links, the other common keys to the first.",
      "section 6.1, Eqs. 7-9",
      {scalar_field_key("surface").required(), level_key("Level of `surface` that holds the proxy.").required(),
       vector_field_key("field").required(), schema::line_kind_key(),
       length_key("threshold", "Distance between probe and proxy at which the proxy slips across the field.").with_default("0.005 L"),
       length_key("tau_min", "Threshold of the friction along the field, where the field is tangential to the surface.")
           .with_default("0.001 L"),
       length_key("tau_max", "Threshold of the friction along the field, where the field is normal to the surface.").with_default("0.01 L"),
       law_key("Law of the threshold, as for `modulated_friction`."), free_key("the side of larger values")},
      {{"surface", "isosurface", {{"surface", "field"}, {"level", "level"}, {"free", "free"}}},
       {"direction",
        "friction",
        {{"field", "field"}, {"kind", "kind"}, {"threshold", "threshold"}, {"surface", "surface"}, {"level", "level"}}},
       {"friction",
        "modulated_friction",
        {{"field", "field"},
         {"kind", "kind"},
         {"surface", "surface"},
         {"level", "level"},
         {"tau_min", "tau_min"},
         {"tau_max", "tau_max"},
         {"law", "law"}}}}};
}

json::Node word(const json::Node& like, std::string_view key, std::string text) {
  json::Node node;
  node.kind = json::Kind::string;
  node.line = like.line;
  node.file = like.file;
  node.label = std::string(key);
  node.string = std::move(text);
  return node;
}

}  // namespace

const std::vector<ModePreset>& mode_presets() {
  static const std::vector<ModePreset> list{anisotropic_friction()};
  return list;
}

const ModePreset* find_mode_preset(std::string_view type) {
  for (const ModePreset& mode : mode_presets())
    if (mode.type == type) return &mode;
  return nullptr;
}

Result<std::vector<json::Node>> expand_link(const json::Node& item) {
  const json::Node* type = item.find("type");
  const ModePreset* mode = type != nullptr && type->kind == json::Kind::string ? find_mode_preset(type->string) : nullptr;
  if (mode == nullptr) return std::vector<json::Node>{item};

  // keys of the mode
  CATENA_TRY(const std::string name, json::require_string(item, "name"));
  CATENA_CHECK(json::check_known_keys(item, schema::key_names(common_keys(), mode->keys)));
  for (const schema::Key& key : mode->keys) {
    if (!key.is_required || item.find(key.name) != nullptr) continue;
    if (key.value_type == schema::ValueType::number) {
      CATENA_CHECK(json::require_number(item, key.name));
    } else {
      CATENA_CHECK(json::require_string(item, key.name));
    }
  }

  // one node per link template
  std::vector<json::Node> links;
  for (const ModePreset::LinkTemplate& part : mode->link_templates) {
    json::Node link;
    link.kind = json::Kind::object;
    link.line = item.line;
    link.file = item.file;
    link.label = item.label;
    link.members.emplace_back("name", word(*item.find("name"), "name", fmt::format("{}_{}", name, part.suffix)));
    link.members.emplace_back("type", word(*type, "type", std::string(part.type)));
    for (const schema::Key& key : common_keys()) {
      const bool of_all = key.name == "stiffness" || key.name == "active_when" || key.name == "enabled";
      if (key.name == "name" || key.name == "type" || !(of_all || links.empty())) continue;
      if (const json::Node* value = item.find(key.name)) link.members.emplace_back(key.name, *value);
    }
    for (const auto& [from, to] : part.keys)
      if (const json::Node* value = item.find(from)) link.members.emplace_back(to, *value);
    links.push_back(std::move(link));
  }
  return links;
}

}  // namespace catena::haptics
