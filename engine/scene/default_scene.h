/// A data file as a scene: the text that scene_for_file and Document read, and what had to be loaded to write it. Inside this room only.
#pragma once
#include <string>

#include "engine/scene/scene.h"

namespace catena::scene {

struct DefaultScene {
  std::string text;        ///< a scene file; it names the data file without its folder
  std::string scene_path;  ///< where that scene file would be: FILE.json beside it
  std::string note;        ///< what the data look like, and why; of a mesh nothing
  field::LoadRequest request;
  field::AnyField field;      ///< either this
  std::string fibers_grid{};  ///< with a body's field: the fibres in it
  field::AnyField fibers{};
  mesh::MeshPtr mesh;  ///< or this
  curves::PointSetPtr points;
  curves::CurveSetPtr curves;  ///< or this
};

Result<DefaultScene> make_default_scene(const std::string& path, const std::string& grid, const NamedColors& colors, int step = 0);
/// Gives the scene that was read from the text what is loaded already, and the notes on it.
void adopt_loaded_data(const DefaultScene& bare, Scene& scene);

}  // namespace catena::scene
