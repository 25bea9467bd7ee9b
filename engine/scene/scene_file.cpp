// SPDX-License-Identifier: MIT
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/referenced_files.h"
#include "engine/scene/scene_from_object.h"
#include "engine/scene/units.h"
#include "engine/schema/renames.h"

namespace catena::scene {

// all sections except the drawables, each defined in the file of its reader
Part time_part(), fields_part(), chain_part(), modes_part(), coupling_part(), workspace_part(), device_part(), widgets_part(),
    indicator_part(), clip_part(), camera_part(), lights_part(), environment_part(), ambient_occlusion_part(), shadows_part(), look_part(),
    line_halos_part(), stereo_part(), screens_part(), background_part(), quality_part(), jitter_part(), stretch_part(),
    orthogonal_views_part(), cursor_part(), unit_length_part(), bounding_box_part(), axes_part(), ground_part(), fog_part(),
    scalar_bars_part(), labels_part(), title_part(), orientation_marker_part(), status_part(), overlay_part();

namespace {

/// All sections in reading order, so that every name is defined before it is used: fields first; links before the widgets that name them;
/// widgets before the objects bound to them; rendered objects before their scalar bars.
const std::vector<Part>& parts() {
  static const std::vector<Part> all = [] {
    std::vector<Part> made{time_part(),  fields_part(),   chain_part(),     widgets_part(),
                           modes_part(), coupling_part(), workspace_part(), device_part()};
    for (const Drawable& kind : drawables()) made.push_back(kind.part());
    for (Part (*part)() : {indicator_part,
                           cursor_part,
                           scalar_bars_part,
                           labels_part,
                           title_part,
                           orientation_marker_part,
                           status_part,
                           overlay_part,
                           camera_part,
                           stereo_part,
                           background_part,
                           quality_part,
                           clip_part,
                           jitter_part,
                           bounding_box_part,
                           axes_part,
                           ground_part,
                           fog_part,
                           lights_part,
                           environment_part,
                           ambient_occlusion_part,
                           shadows_part,
                           look_part,
                           line_halos_part,
                           unit_length_part,
                           screens_part,
                           stretch_part,
                           orthogonal_views_part})
      made.push_back(part());
    return made;
  }();
  return all;
}

Outcome read_root(Scene& scene, const json::Node& root, const std::vector<FieldOverride>& overrides) {
  CATENA_CHECK(json::expect_object(root, "the scene"));
  std::vector<std::string_view> keys;
  for (const Part& part : parts()) keys.push_back(part.description.name);
  if (root.find("$schema") != nullptr) {  // for editors
    keys.push_back("$schema");
    CATENA_CHECK(json::require_string(root, "$schema"));
  }
  CATENA_CHECK(json::check_known_keys(root, keys));
  // time first: it selects the step of the fields
  if (const json::Node* time = root.find("time")) CATENA_CHECK(read_time(scene, *time));
  CATENA_CHECK(read_fields(scene, root.find("fields"), overrides));
  for (const Part& part : parts())
    if (const json::Node* node = root.find(part.description.name); node != nullptr && part.read != nullptr)
      CATENA_CHECK(part.read(scene, *node));
  return Done{};
}

}  // namespace

static Outcome check_sizes(const json::Node& node) {
  const double size = std::abs(node.number);
  if (node.kind == json::Kind::number && size != 0 && !(size >= kMinSize && size <= kMaxSize))
    return json::error_at(node, to_text(node.number) + " is too " + (size < kMinSize ? "small" : "large") +
                                    "; 0 or a number of magnitude 1e-30 to 1e30 was expected");
  for (const json::Node& item : node.items) CATENA_CHECK(check_sizes(item));
  for (const auto& [key, value] : node.members) CATENA_CHECK(check_sizes(value));
  return Done{};
}

const std::vector<schema::Section>& scene_components() {
  static const auto all = [] {
    std::vector<schema::Section> components;
    for (const Part& part : parts()) components.push_back(part.description);
    return components;
  }();
  return all;
}

namespace {

/// Sets the location of every value to "NAME: /volumes/0/opacity" (a JSON pointer, RFC 6901).
void place_by_pointer(json::Node& node, const std::string& name, const std::string& pointer) {
  node.file = std::make_shared<const std::string>(pointer.empty() ? name : name + ": " + pointer);
  node.line = -1;
  for (std::size_t i = 0; i < node.items.size(); ++i) place_by_pointer(node.items[i], name, pointer + "/" + std::to_string(i));
  for (auto& [key, member] : node.members) {
    std::string escaped;
    for (const char c : key) escaped += c == '~' ? std::string("~0") : c == '/' ? std::string("~1") : std::string(1, c);
    place_by_pointer(member, name, pointer + "/" + escaped);
  }
}

Result<Scene> scene_of_root(const json::Node& root, const std::string& path, const std::vector<FieldOverride>& overrides,
                            const std::vector<std::string>& known_files = {}) {
  CATENA_CHECK(schema::check_names(root, schema::FileKind::scene));
  CATENA_CHECK(check_sizes(root));
  Scene scene;
  scene.path = path;
  scene.known_files = known_files;
  scene.cursor = scene.entities.create();
  scene.entities.emplace<Cursor>(scene.cursor);
  CATENA_CHECK(read_root(scene, root, overrides));
  scene.referenced_files = referenced_files(root, path, overrides);
  return scene;
}

}  // namespace

Result<Scene> parse_scene(std::string_view text, const std::string& path, const std::vector<FieldOverride>& overrides,
                          const std::vector<std::string>& known_files) {
  CATENA_TRY(const json::Node root, json::parse(text, path));
  return scene_of_root(root, path, overrides, known_files);
}

Result<Scene> parse_scene_object(std::string_view text, const std::string& name, const std::vector<FieldOverride>& overrides) {
  CATENA_TRY(json::Node root, json::parse(text, name));
  place_by_pointer(root, name, {});
  return scene_of_root(root, name, overrides);
}

Result<Scene> read_scene(const std::string& path, const std::vector<FieldOverride>& overrides) {
  CATENA_TRY(const std::string text, read_text_file(path, "a scene file (JSON)", kMaxJsonBytes));
  return parse_scene(text, path, overrides);
}

}  // namespace catena::scene
