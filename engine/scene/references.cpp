// SPDX-License-Identifier: MIT
#include "engine/scene/references.h"

#include <algorithm>
#include <vector>

#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

/// A string and the role of its key.
struct Reference {
  schema::Role role;
  const json::Node* node;
};

void add_value(const json::Node& value, const schema::Key& key, std::vector<Reference>& found);

void add_members(const json::Node& object, const schema::Keys& keys, std::vector<Reference>& found) {
  for (const schema::Key& key : keys)
    if (const json::Node* value = object.find(key.name)) add_value(*value, key, found);
}

void add_value(const json::Node& value, const schema::Key& key, std::vector<Reference>& found) {
  if (key.role != schema::Role::none && value.kind == json::Kind::string && !value.string.empty()) found.push_back({key.role, &value});
  if (key.members) add_members(value, *key.members, found);
  for (const schema::Key& alternative : key.alternatives) add_value(value, alternative, found);
  if (const json::Node* widget = key.accepts_widget ? value.find("widget") : nullptr) found.push_back({schema::Role::widget, widget});
  if (const json::Node* field = key.accepts_field_map ? value.find("field") : nullptr) found.push_back({schema::Role::scalar_field, field});
}

void add_item(const json::Node& item, const schema::Section& section, std::vector<Reference>& found) {
  add_members(item, section.keys, found);
  for (const schema::Variant& variant : section.variants) add_members(item, variant.keys, found);
  // "transfer" is allowed where "color_by" is a name
  if (schema::find(section.keys, "color_by") != nullptr) add_members(item, {schema::file("transfer", "")}, found);
}

}  // namespace

void each_reference(const json::Node& root, const std::function<void(schema::Role, const json::Node&)>& visit) {
  std::vector<Reference> found;
  for (const schema::Section& section : scene_components()) {
    const json::Node* part = root.find(section.name);
    if (part == nullptr) continue;
    for (const json::Node& item : part->items) add_item(item, section, found);
    if (section.layout == schema::Section::Layout::map)
      for (const auto& [name, item] : part->members) add_item(item, section, found);
    else
      add_item(*part, section, found);
  }
  if (const json::Node* device = root.find("device")) add_members(*device, {schema::file("firmware", "")}, found);
  // several variants may have the same key
  std::ranges::stable_sort(found, {}, [](const Reference& reference) { return reference.node->begin; });
  found.erase(std::unique(found.begin(), found.end(), [](const Reference& a, const Reference& b) { return a.node == b.node; }),
              found.end());
  for (const Reference& reference : found) visit(reference.role, *reference.node);
}

}  // namespace catena::scene
