#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/named_files.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/units.h"

namespace catena::scene {
namespace {

Outcome read_root(Scene& scene, const json::Node& root, const std::vector<FieldOverride>& overrides) {
  CATENA_CHECK(json::expect_object(root, "the scene"));
  struct Part {
    const char* key;
    Outcome (*read)(Scene&, const json::Node&);
  };
  constexpr Part parts[] = {{"chain", read_chain},
                            {"widgets", read_widgets},
                            {"modes", read_modes},
                            {"coupling", read_coupling},
                            {"workspace", read_workspace},
                            {"device", read_device},
                            {"volumes", read_volumes},
                            {"isosurfaces", read_isosurfaces},
                            {"meshes", read_meshes},
                            {"slices", read_slices},
                            {"streamlines", read_streamlines},
                            {"indicator", read_indicator},
                            {"cursor", read_cursor},
                            {"scalar_bars", read_scalar_bars},
                            {"labels", read_labels},
                            {"title", read_title},
                            {"orientation_marker", read_orientation_marker},
                            {"status", read_status},
                            {"overlay", read_overlay},
                            {"camera", read_camera},
                            {"stereo", read_stereo},
                            {"background", read_background},
                            {"quality", read_quality},
                            {"clip", read_clip},
                            {"jitter", read_jitter},
                            {"bounding_box", read_bounding_box},
                            {"axes", read_axes},
                            {"ground", read_ground},
                            {"fog", read_fog},
                            {"lights", read_lights},
                            {"unit_length", read_unit_length}};
  std::vector<std::string_view> keys{"fields"};
  for (const Part& part : parts) keys.push_back(part.key);
  CATENA_CHECK(json::only_keys(root, keys));
  // fields first: the other parts name them; widgets name links; what follows a widget names it; scalar bars name what is drawn
  CATENA_CHECK(read_fields(scene, root, overrides));
  for (const Part& part : parts)
    if (const json::Node* node = root.find(part.key)) CATENA_CHECK(part.read(scene, *node));
  return Done{};
}

}  // namespace

/// Numbers whose squares and quotients are numbers, too, of a double and (lengths of the picture) of a float.
static Outcome check_sizes(const json::Node& node) {
  constexpr double least = 1e-30, most = 1e30;
  const double size = std::abs(node.number);
  if (node.kind == json::Kind::number && size != 0 && !(size >= least && size <= most))
    return json::error_at(node, to_text(node.number) + " is too " + (size < least ? "small" : "large") +
                                    "; 0 or a number from 1e-30 to 1e30 in size was expected");
  for (const json::Node& item : node.items) CATENA_CHECK(check_sizes(item));
  for (const auto& [key, value] : node.members) CATENA_CHECK(check_sizes(value));
  return Done{};
}

Result<Scene> parse_scene(std::string_view text, const std::string& path, const std::vector<FieldOverride>& overrides) {
  CATENA_TRY(const json::Node root, json::parse(text, path));
  CATENA_CHECK(check_sizes(root));
  Scene scene;
  scene.path = path;
  scene.cursor = scene.world.create();
  scene.world.emplace<Cursor>(scene.cursor);
  CATENA_CHECK(read_root(scene, root, overrides));
  scene.files = files_of(root, path, overrides);
  return scene;
}

Result<Scene> read_scene(const std::string& path, const std::vector<FieldOverride>& overrides) {
  CATENA_TRY(const std::string text, read_text(path, "a scene file (JSON)", kMostJsonBytes));
  return parse_scene(text, path, overrides);
}

}  // namespace catena::scene
