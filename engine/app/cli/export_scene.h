/// One part of a scene as a file for other programs: what `catena export SCENE` writes.
#pragma once
#include <optional>
#include <string>

#include "engine/base/result.h"

namespace catena::app {

struct SceneExport {
  std::string source, grid, output;  ///< a scene or a data file; the output's ending is its format
  // exactly one of these
  std::optional<int> isosurface, slice, streamlines;  ///< numbers in the scene's lists, from 0
  std::string mesh, field, probe;                     ///< names; a path of the hand
  int step = -1;                                      ///< in time, from 0; -1: the scene's
  // of some
  double spacing = 0;            ///< of a slice's samples, world units; 0: the smallest voxel edge
  std::string outside = "auto";  ///< of an isosurface: lower, higher; auto: higher of a level set, else lower
};

Outcome export_scene(const SceneExport& options);

}  // namespace catena::app
