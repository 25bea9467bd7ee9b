// SPDX-License-Identifier: MIT
/// Default scene of a data file: the scene text that scene_for_file and Document read, and the data loaded to write it. Private to this
/// module.
#pragma once
#include <string>

#include "engine/scene/scene.h"

namespace catena::scene {

/// Scene text and loaded data of one data file.
struct DefaultScene {
  std::string text;            ///< Scene file text; names the data file without its folder
  std::string scene_path;      ///< Path where that scene file would be saved: FILE.json beside the data file
  std::string note;            ///< Classification of the data and the reason; empty for a mesh
  field::LoadRequest request;  ///< Request that loaded the file; for a pattern the file of the step
  field::AnyField field;       ///< The loaded field; empty for other data
  /// Further grids that were loaded: the fibers that lie in the body shown, the other channels.
  std::vector<std::pair<std::string, field::AnyField>> more_grids{};
  mesh::MeshPtr mesh;          ///< The loaded mesh; null for other data
  curves::PointSetPtr points;  ///< The loaded points; null for other data
  curves::CurveSetPtr curves;  ///< The loaded curves; null for other data
};

/// Loads the data file and writes its default scene. `grid`: the grid to show; empty: the first usable scalar grid, else the first vector
/// grid. `step`: time step that is loaded and shown. Error: the file cannot be read, or colors are specified for a mesh or curves.
Result<DefaultScene> make_default_scene(const std::string& path, const std::string& grid, const FileColors& colors, int step = 0);
/// Returns the factors by which the image of a grid is stretched: 1 along all axes unless their voxels and extents differ so much that
/// they can hardly have one unit (degrees and meters); then the outlying axis is shown at about half the extent of the others.
Vec3 choose_stretch(const field::Field& field);
/// Hands the loaded data, and the notes on them, to the scene that was read from `text`, so that nothing is loaded twice.
void adopt_loaded_data(const DefaultScene& default_scene, Scene& scene);

}  // namespace catena::scene
