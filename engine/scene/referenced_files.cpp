// SPDX-License-Identifier: MIT
#include "engine/scene/referenced_files.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/json_edit.h"
#include "engine/base/output_file.h"
#include "engine/io/formats.h"
#include "engine/scene/readers.h"
#include "engine/scene/references.h"

namespace catena::scene {
namespace {

namespace fs = std::filesystem;

/// Returns the values that name files, in text order.
std::vector<const json::Node*> file_names(const json::Node& root) {
  std::vector<const json::Node*> names;
  each_reference(root, [&](schema::Role role, const json::Node& node) {
    if (role == schema::Role::file) names.push_back(&node);
  });
  return names;
}

fs::path folder_of(const std::string& path) {
  std::error_code code;
  const fs::path folder = fs::weakly_canonical(fs::absolute(path, code).parent_path(), code);
  return code ? fs::path(path).parent_path() : folder;
}

/// Returns the path of the file relative to a scene in that folder. Links in the folder part are resolved; the file keeps its own name
/// because its extension matters.
std::string name_from(const std::string& file, const fs::path& folder) {
  const std::string name = (folder_of(file).lexically_relative(folder) / fs::path(file).filename()).lexically_normal().string();
  std::error_code code;
  return is_same_file((folder / name).string(), file) ? name : fs::absolute(file, code).lexically_normal().string();
}

/// Returns the scene text with an override written as a field; the effect is that of apply_override.
Result<std::string> with_override(std::string text, const std::string& path, const FieldOverride& with) {
  const std::string name = fs::path(with.file).is_absolute() ? with.file : name_from(with.file, folder_of(path));
  CATENA_TRY(const json::Node root, json::parse(text, path));
  const std::string pointer = "/fields/" + json::escape_pointer_token(with.name);
  const json::Node* field = json::find_value(root, pointer);
  const json::Node* file = field == nullptr ? nullptr : field->find("file");
  const bool raw = file != nullptr && io::needs_layout(file->string);
  if (file == nullptr || (raw && !io::needs_layout(name))) {
    const std::string grid = with.grid.empty() ? "" : ", \"grid\": " + json::serialize_string(with.grid);
    return json::set_value(text, path, pointer, "{\"file\": " + json::serialize_string(name) + grid + "}");
  }
  CATENA_TRY(text, json::set_value(text, path, pointer + "/file", json::serialize_string(name)));
  if (raw) return text;

  // the names of the previous file's grid and mask are kept only if the new file has a grid and a mask with these names
  const json::Node *grid = field->find("grid"), *valid = field->find("valid");
  const bool keeps_grid = grid != nullptr && with.grid.empty(), mask = valid != nullptr && valid->kind == json::Kind::string;
  const auto grids = keeps_grid || mask ? field::describe_grids(with.file) : Result<std::vector<field::GridInfo>>(Error{});
  const auto lacks = [&](const json::Node& node) {
    return grids && std::none_of(grids->begin(), grids->end(), [&](const field::GridInfo& info) { return info.name == node.string; });
  };
  if (!with.grid.empty()) {
    CATENA_TRY(text, json::set_value(text, path, pointer + "/grid", json::serialize_string(with.grid)));
  } else if (keeps_grid && lacks(*grid)) {
    CATENA_TRY(text, json::remove_value(text, path, pointer + "/grid"));
  }
  if (mask && lacks(*valid)) {
    CATENA_TRY(text, json::set_value(text, path, pointer + "/valid", "null"));
  }
  return text;
}

}  // namespace

Result<std::vector<std::string>> referenced_files(std::string_view text, const std::string& path,
                                                  const std::vector<FieldOverride>& overrides) {
  CATENA_TRY(const json::Node root, json::parse(text, path));
  return referenced_files(root, path, overrides);
}

std::vector<std::string> referenced_files(const json::Node& root, const std::string& path, const std::vector<FieldOverride>& overrides) {
  std::vector<std::string> files;
  for (const json::Node* name : file_names(root)) files.push_back(resolve_path(path, name->string));
  for (const FieldOverride& with : overrides)
    if (!with.file.empty()) files.push_back(with.file);
  return files;
}

Result<std::string> relocate_text(std::string_view text, const std::string& from, const std::string& to,
                                  const std::vector<FieldOverride>& overrides) {
  std::string moved(text);
  const fs::path folder = folder_of(to);
  if (folder_of(from) != folder) {
    CATENA_TRY(const json::Node root, json::parse(text, from));
    const std::vector<const json::Node*> names = file_names(root);
    // replaced from the end, so that earlier offsets stay valid
    for (auto it = names.rbegin(); it != names.rend(); ++it)
      if (fs::path((*it)->string).is_relative())
        moved.replace((*it)->begin, (*it)->end - (*it)->begin,
                      json::serialize_string(name_from(resolve_path(from, (*it)->string), folder)));
  }
  for (const FieldOverride& with : overrides) {
    CATENA_TRY(moved, with_override(std::move(moved), to, with));
  }
  return moved;
}

}  // namespace catena::scene
