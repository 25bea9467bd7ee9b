// SPDX-License-Identifier: MIT
#include "engine/scene/merge.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "engine/base/json_edit.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/references.h"

namespace catena::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExcluded[] = {"lights", "chain", "modes", "clip"};

/// Section whose names a role refers to; empty: none.
std::string_view section_of(schema::Role role) {
  using schema::Role;
  switch (role) {
    case Role::scalar_field:
    case Role::vector_field:
    case Role::any_field:
      return "fields";
    case Role::mesh:
      return "meshes";
    case Role::curves:
      return "curves";
    case Role::points:
      return "points";
    case Role::widget:
      return "widgets";
    default:
      return {};
  }
}

/// Names of a section's items.
std::vector<const json::Node*> name_nodes(const json::Node& section) {
  std::vector<const json::Node*> names;
  for (const json::Node& item : section.items)
    if (const json::Node* name = item.find("name"); name != nullptr && name->kind == json::Kind::string) names.push_back(name);
  return names;
}

/// Name of a file relative to folder `from`, for a scene in folder `to`: relative if the file is inside it, else absolute.
std::string relocated(const fs::path& from, const fs::path& to, const std::string& file) {
  // a scene path without a folder lies in the current one
  std::error_code code;
  const fs::path here = fs::current_path(code);
  const fs::path whole = (here / from / file).lexically_normal(), near = whole.lexically_relative((here / to).lexically_normal());
  return near.empty() || *near.begin() == ".." ? whole.string() : near.string();
}

/// A part of the text to replace.
struct Replacement {
  std::size_t begin, end;
  std::string text;
};

std::string replaced(std::string text, std::vector<Replacement> parts) {
  std::ranges::sort(parts, std::greater<>(), &Replacement::begin);  // from the end, so that earlier offsets stay valid
  for (const Replacement& part : parts) text.replace(part.begin, part.end - part.begin, part.text);
  return text;
}

Replacement replacement_of(const json::Node& node, std::string text) { return {node.begin, node.end, std::move(text)}; }

}  // namespace

Result<MergedScene> merge_scene(const std::string& open, const std::string& open_path, const std::string& added,
                                const std::string& added_path) {
  CATENA_TRY(const json::Node host, json::parse(open, open_path));
  CATENA_TRY(const json::Node guest, json::parse(added, added_path));
  const fs::path from = fs::path(added_path).parent_path(), to = fs::path(open_path).parent_path();
  MergedScene result;
  std::map<std::pair<std::string_view, std::string>, std::string> renamed;  // section and name -> new name
  std::vector<Replacement> parts;
  const auto rename_taken = [&](std::string_view section, std::set<std::string> taken, const std::string& name) {
    const std::string free = make_unique_name(name, [&](const std::string& n) { return taken.contains(n); });
    return renamed[{section, name}] = free;
  };
  for (const schema::Section& section : scene_components()) {
    const json::Node *theirs = guest.find(section.name), *ours = host.find(section.name);
    if (theirs == nullptr) continue;
    std::set<std::string> taken;
    if (ours != nullptr) {
      for (const auto& [name, node] : ours->members) taken.insert(name);
      for (const json::Node* name : name_nodes(*ours)) taken.insert(name->string);
    }
    if (section.layout == schema::Section::Layout::map)
      for (const auto& [name, node] : theirs->members) taken.insert(rename_taken(section.name, taken, name));
    for (const json::Node* name : name_nodes(*theirs)) {
      taken.insert(rename_taken(section.name, taken, name->string));
      parts.push_back(replacement_of(*name, json::serialize_string(renamed[{section.name, name->string}])));
    }
  }
  each_reference(guest, [&](schema::Role role, const json::Node& node) {
    if (role == schema::Role::file) parts.push_back(replacement_of(node, json::serialize_string(relocated(from, to, node.string))));
    const auto found = renamed.find({section_of(role), node.string});
    if (found != renamed.end()) parts.push_back(replacement_of(node, json::serialize_string(found->second)));
  });
  for (const IndexReference& index : kIndexReferences) {
    const json::Node *holders = guest.find(index.holder), *list = host.find(index.list);
    if (holders == nullptr || list == nullptr) continue;
    for (const json::Node& holder : holders->items)
      if (const json::Node* named = json::find_value(holder, "/" + std::string(index.key)))
        parts.push_back(replacement_of(*named, json::serialize_number(named->number + static_cast<double>(list->items.size()))));
  }
  CATENA_TRY(const json::Node final, json::parse(replaced(added, std::move(parts)), added_path));
  for (const schema::Section& section : scene_components()) {
    const json::Node* part = final.find(section.name);
    if (part == nullptr || std::ranges::find(kExcluded, section.name) != std::end(kExcluded)) continue;
    if (section.layout == schema::Section::Layout::map)
      for (const auto& [name, node] : part->members) {
        const std::string& as = renamed[{section.name, name}];
        result.edits.push_back({"/" + section.name + "/" + json::escape_pointer_token(as), json::serialize_node(node)});
        if (section.name == "fields") result.fields.emplace_back(name, as);
      }
    if (section.layout == schema::Section::Layout::list)
      for (const json::Node& item : part->items) {
        std::string text = json::serialize_node(item);
        // a projection has no depth at which it could be mixed with another volume
        if (section.name == "volumes" && host.find("volumes") != nullptr && item.find("projection") != nullptr) {
          CATENA_TRY(text, json::remove_value(text, added_path, "/projection"));
        }
        result.edits.push_back({"/" + section.name + "/-", text});
      }
  }
  return result;
}

}  // namespace catena::scene
