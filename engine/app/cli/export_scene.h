// SPDX-License-Identifier: MIT
/// Export of one part of a scene to a file for other programs: `catena export SCENE`.
#pragma once
#include <optional>
#include <string>

#include "engine/base/result.h"

namespace catena::app {

/// Options of an export, from the command line.
struct SceneExport {
  /// `source`: a scene or a data file; `grid`: of a data file that holds several, empty: the default one; the extension of `output` selects
  /// the format
  std::string source, grid, output;
  // Exactly one of the following six is set.
  std::optional<int> isosurface, slice, streamlines;  ///< Indices into the scene's lists, from 0
  std::string mesh, field, probe;                     ///< Names of a mesh and a field; CSV file of a probe path
  int step = -1;                                      ///< Time step, from 0; -1: the scene's
  // Options of some of the parts.
  double spacing = 0;            ///< Distance between a slice's samples, world units; 0: the smallest voxel edge
  std::string outside = "auto";  ///< Outward side of an isosurface: "lower" or "higher" values; "auto": higher for a level set, else lower
};

/// Writes the file and prints a summary. Error: bad options, an item that does not exist, or an output that is also an input.
Outcome export_scene(const SceneExport& options);

}  // namespace catena::app
