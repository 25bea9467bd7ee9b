#include "haptics/constraints/presets/modes.h"

#include <fmt/format.h>

namespace catena::haptics {
namespace {

ReadyMode anisotropic_friction() {
  return {
      "anisotropic_friction",
      "section 6.1, Eqs. 7-9",
      {{"surface", "scalar_field", true, "a scalar field of the scene"},
       {"level", "number", true, "the field's value on the surface"},
       {"field", "vector_field", true, "a vector field of the scene: easy along it, hard across"},
       {"kind", "string", false, "line: v and -v are the same, as for fibres", R"("enum": ["vector", "line"])"},
       {"threshold", "parameter", false, "across the field, world units; default 0.005 L", kNotNegativeSchema},
       {"tau_min", "parameter", false, "along the field where it is tangential, world units; default 0.001 L", kNotNegativeSchema},
       {"tau_max", "parameter", false, "along the field where it is normal, world units; default 0.01 L", kNotNegativeSchema},
       {"law", "string", false, "safe: harder the more normal the field; printed: Eq. 7 to the letter", R"("enum": ["safe", "printed"])"},
       {"free", "string", false, "the side, by field value, where the hand moves freely", kFreeSchema}},
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

const std::vector<ReadyMode>& ready_modes() {
  static const std::vector<ReadyMode> list{anisotropic_friction()};
  return list;
}

const ReadyMode* find_ready_mode(std::string_view type) {
  for (const ReadyMode& mode : ready_modes())
    if (mode.type == type) return &mode;
  return nullptr;
}

Result<std::vector<json::Node>> expand_link(const json::Node& item) {
  const json::Node* type = item.find("type");
  const ReadyMode* mode = type != nullptr && type->kind == json::Kind::string ? find_ready_mode(type->string) : nullptr;
  if (mode == nullptr) return std::vector<json::Node>{item};

  // the mode's own keys
  CATENA_TRY(const std::string name, json::require_string(item, "name"));
  std::vector<std::string_view> allowed;
  for (const Key& key : common_keys()) allowed.push_back(key.name);
  for (const Key& key : mode->keys) allowed.push_back(key.name);
  CATENA_CHECK(json::only_keys(item, allowed));
  for (const Key& key : mode->keys) {
    if (!key.required || item.find(key.name) != nullptr) continue;
    if (key.type == "number") {
      CATENA_CHECK(json::require_number(item, key.name));
    } else {
      CATENA_CHECK(json::require_string(item, key.name));
    }
  }

  // one node a part
  std::vector<json::Node> links;
  for (const ReadyMode::Part& part : mode->parts) {
    json::Node link;
    link.kind = json::Kind::object;
    link.line = item.line;
    link.file = item.file;
    link.label = item.label;
    link.members.emplace_back("name", word(*item.find("name"), "name", fmt::format("{}_{}", name, part.suffix)));
    link.members.emplace_back("type", word(*type, "type", std::string(part.type)));
    for (const Key& key : common_keys()) {
      const bool of_all = key.name == "stiffness" || key.name == "on" || key.name == "enabled";
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
