#include "engine/base/text.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

Outcome read_root(Scene& scene, const json::Node& root, const std::vector<FieldOverride>& overrides) {
  CATENA_CHECK(json::expect_object(root, "the scene"));
  CATENA_CHECK(json::only_keys(root, {"fields", "chain", "modes", "coupling", "workspace", "device", "volumes", "isosurfaces", "meshes",
                                      "streamlines", "indicator", "cursor", "camera", "background", "quality", "clip"}));
  // fields first: the other parts name them
  CATENA_CHECK(read_fields(scene, root, overrides));
  struct Part {
    const char* key;
    Outcome (*read)(Scene&, const json::Node&);
  };
  constexpr Part parts[] = {{"chain", read_chain},
                            {"modes", read_modes},
                            {"coupling", read_coupling},
                            {"workspace", read_workspace},
                            {"device", read_device},
                            {"volumes", read_volumes},
                            {"isosurfaces", read_isosurfaces},
                            {"meshes", read_meshes},
                            {"streamlines", read_streamlines},
                            {"indicator", read_indicator},
                            {"cursor", read_cursor},
                            {"camera", read_camera},
                            {"background", read_background},
                            {"quality", read_quality},
                            {"clip", read_clip}};
  for (const Part& part : parts)
    if (const json::Node* node = root.find(part.key)) CATENA_CHECK(part.read(scene, *node));
  return Done{};
}

}  // namespace

Result<Scene> parse_scene(std::string_view text, const std::string& path, const std::vector<FieldOverride>& overrides) {
  CATENA_TRY(const json::Node root, json::parse(text, path));
  Scene scene;
  scene.path = path;
  scene.cursor = scene.world.create();
  scene.world.emplace<Cursor>(scene.cursor);
  CATENA_CHECK(read_root(scene, root, overrides));
  return scene;
}

Result<Scene> read_scene(const std::string& path, const std::vector<FieldOverride>& overrides) {
  CATENA_TRY(const std::string text, read_text(path, "a scene file (JSON)"));
  return parse_scene(text, path, overrides);
}

}  // namespace catena::scene
