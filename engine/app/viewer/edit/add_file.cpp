#include "engine/app/viewer/edit/add_file.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "engine/base/json.h"
#include "engine/base/json_edit.h"
#include "engine/base/text.h"

namespace catena::app {

namespace fs = std::filesystem;

namespace {

json::Node* member_of(json::Node& object, std::string_view key) {
  const auto found = std::ranges::find_if(object.members, [&](const auto& member) { return member.first == key; });
  return found == object.members.end() ? nullptr : &found->second;
}

std::string free_among(std::set<std::string>& taken, const std::string& name) {
  std::string free = free_name(name, [&](const std::string& n) { return taken.contains(n); });
  taken.insert(free);
  return free;
}

/// A file that is named from `from`, as it is named from `to`.
std::string named_from(const fs::path& from, const fs::path& to, const std::string& file) {
  // a scene that was named without its folder is in the current one
  std::error_code code;
  const fs::path here = fs::current_path(code);
  const fs::path whole = (here / from / file).lexically_normal(), near = whole.lexically_relative((here / to).lexically_normal());
  return near.empty() || *near.begin() == ".." ? whole.string() : near.string();
}

}  // namespace

Result<AddedFile> edits_to_add(const std::string& open_text, const std::string& open_path, const std::string& added_text,
                               const std::string& added_path) {
  CATENA_TRY(const json::Node open, json::parse(open_text, open_path));
  CATENA_TRY(json::Node added, json::parse(added_text, added_path));
  AddedFile result;
  std::set<std::string> fields, meshes;
  if (const json::Node* there = open.find("fields"))
    for (const auto& [name, node] : there->members) fields.insert(name);
  if (const json::Node* there = open.find("meshes"))
    for (const json::Node& mesh : there->items)
      if (const json::Node* name = mesh.find("name")) meshes.insert(name->string);
  const fs::path from = fs::path(added_path).parent_path(), to = fs::path(open_path).parent_path();

  if (json::Node* own = member_of(added, "fields"))
    for (auto& [name, node] : own->members) {
      const std::string as = free_among(fields, name);
      if (json::Node* file = member_of(node, "file")) file->string = named_from(from, to, file->string);
      result.edits.push_back({"/fields/" + json::pointer_step(as), json::node_text(node)});
      result.names.emplace_back(name, as);
    }
  const auto renamed = [&](const std::string& name) {
    const auto found = std::ranges::find(result.names, name, &std::pair<std::string, std::string>::first);
    return found == result.names.end() ? name : found->second;
  };
  for (const char* part : {"meshes", "volumes", "streamlines"}) {
    json::Node* items = member_of(added, part);
    if (items == nullptr) continue;
    for (json::Node& item : items->items) {
      if (json::Node* field = member_of(item, "field")) field->string = renamed(field->string);
      if (json::Node* file = member_of(item, "file")) file->string = named_from(from, to, file->string);
      if (json::Node* name = member_of(item, "name")) name->string = free_among(meshes, name->string);
      result.edits.push_back({std::string("/") + part + "/-", json::node_text(item)});
    }
  }
  return result;
}

}  // namespace catena::app
