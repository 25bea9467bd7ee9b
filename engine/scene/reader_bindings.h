// SPDX-License-Identifier: MIT
/// Readers for objects that have names in the scene file (fields, meshes, curves, points, widgets): their names and files, and the errors
/// for unknown names. In the messages `kind` is the singular ("mesh") and `list` the plural or key of all ("meshes"). Private to this
/// module.
#pragma once
#include "engine/scene/readers.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/visibility.h"

namespace catena::scene {

/// Returns the names of all entities that own a T.
template <class T>
std::vector<std::string_view> list_names(const Scene& scene) {
  std::vector<std::string_view> names;
  scene.entities.each<T>([&](Entity e, const T&) { names.push_back(scene.entities.get<Name>(e).value); });
  return names;
}

/// Returns the T of that name; an Error at `where` lists the known names.
template <class T>
Result<Entity> require_named(const Scene& scene, const std::string& name, const json::Node& where, const std::string& kind,
                             const std::string& list) {
  if (const Entity found = find_named<T>(scene, name)) return found;
  const std::vector<std::string_view> names = list_names<T>(scene);
  return json::error_at(where, "unknown " + kind + " " + in_quotes(name) + "; one of the scene's " + list +
                                   " was expected: " + (names.empty() ? "it has none" : join_words(names)) + suggestion(name, names));
}

/// Returns the T that member `key` of `object` names; an Error lists the known names.
template <class T>
Result<Entity> read_named(const Scene& scene, const json::Node& object, std::string_view key, const std::string& kind,
                          const std::string& list) {
  CATENA_TRY(const std::string name, json::require_string(object, key));
  if (const Entity found = find_named<T>(scene, name)) return found;
  const std::vector<std::string_view> names = list_names<T>(scene);
  return json::error_at(*object.find(key), "unknown " + kind + " " + in_quotes(name) +
                                               "; known: " + (names.empty() ? "none" : join_words(names)) + ", one of " + in_quotes(list) +
                                               " was expected" + suggestion(name, names));
}

/// Returns member "name" of a new T. `many`: the kind is a plural ("curves"). Error: not an identifier, or another T has the name.
template <class T>
Result<std::string> read_new_name(const Scene& scene, const json::Node& item, const std::string& kind, bool many = false) {
  CATENA_TRY(std::string name, json::require_string(item, "name"));
  const json::Node& node = *item.find("name");
  CATENA_CHECK(check_name(kind, name, node));
  if (find_named<T>(scene, name))
    return json::error_at(
        node, "the name " + in_quotes(name) + " is already used for " + (many ? "" : "a ") + kind + "; a unique name was expected");
  return name;
}

/// Returns the path in member "file" of the item `name`: an existing file with one of the endings, or for a pattern the file of the scene's
/// current step. Sets `pattern`, `series` and `step` of `steps`.
inline Result<std::string> read_path(const Scene& scene, const json::Node& item, const std::string& kind, const std::string& name,
                                     const std::vector<std::string_view>& endings, FileSteps& steps) {
  CATENA_TRY(const std::string file, json::require_string(item, "file"));
  std::string path = resolve_path(scene.path, file);
  if (is_pattern(path)) {
    steps.pattern = path;
    steps.series = expand_pattern(path);
    if (steps.series.empty())
      return json::error_at(*item.find("file"), kind + " " + in_quotes(name) + ": no file matches the pattern " + in_quotes(path));
    path = steps.series[std::min(static_cast<std::size_t>(scene.time.step), steps.series.size() - 1)];
  }
  steps.step = scene.time.step;
  const bool known = std::ranges::any_of(endings, [&](std::string_view ending) { return has_extension(path, ending); });
  if (const std::string fault = file_problem(path, known, "a " + join_alternatives(endings) + " file");
      !fault.empty() && !is_known_file(scene, path))
    return json::error_at(*item.find("file"), kind + " " + in_quotes(name) + ": file " + fault);
  return path;
}

/// An item of "curves" or "points": a named source.
template <class T>
struct FileItem {
  std::string name;
  T item;
};

/// Returns the table of the keys "name" and "file". `file`: start of the help of "file"; `needs_file`: whether "file" is required.
template <class T>
Table<FileItem<T>> make_file_table(const std::string& kind, const std::string& file, const std::vector<std::string_view>& endings,
                                   bool needs_file = true) {
  Table<FileItem<T>> t;
  t.custom(schema::identifier("name", "Unique name, by which links and other items refer to the " + kind + ".").required(),
           [kind](Scene& scene, const json::Node& item, FileItem<T>& read_item) -> Outcome {
             CATENA_TRY(read_item.name, read_new_name<T>(scene, item, kind, true));
             return Done{};
           });
  const Key key = schema::file("file", file + ": " + join_alternatives(endings) + ".");
  t.custom(needs_file ? key.required() : key,
           [kind, endings, needs_file](Scene& scene, const json::Node& item, FileItem<T>& read_item) -> Outcome {
             if (!needs_file && item.find("file") == nullptr) return Done{};
             CATENA_TRY(read_item.item.path, read_path(scene, item, kind, read_item.name, endings, read_item.item.steps));
             return Done{};
           });
  return t;
}

/// Reads an array of items with "name" and "file" into new entities.
template <class T>
Outcome read_file_items(Scene& scene, const json::Node& node, const Table<FileItem<T>>& table) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    FileItem<T> read_item;
    read_item.item.where = item;
    CATENA_CHECK(table.read(scene, item, read_item));
    const Entity e = scene.entities.create();
    scene.entities.emplace<Name>(e, {read_item.name});
    scene.entities.emplace<T>(e, std::move(read_item.item));
    return read_visible(scene, e, item);
  });
}

}  // namespace catena::scene
