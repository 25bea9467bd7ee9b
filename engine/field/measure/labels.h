// SPDX-License-Identifier: MIT
/// Measurement of the labels of a label map: voxels, the statistics of a second field, and the surface. Not for the haptic tick; any
/// thread. Results do not depend on the number of threads. Memory: the slabs, and 120 bytes per label and slab.
///
/// The surface of a label is the isosurface at 0.5 of chi (label_surface.h) without smoothing: chi is 1 in the voxels of the label and 0 in
/// all others, in voxels that are left out, and around the grid. The area of this surface in a cell of eight voxels depends only on which
/// of them have the label, so one pass with a table of 256 areas measures all labels.
#pragma once
#include <array>
#include <vector>

#include "engine/base/export.h"
#include "engine/field/measure/voxels.h"

namespace catena::field {

/// Largest number of labels of a map.
inline constexpr std::size_t kMaxMeasuredLabels = 65536;
/// Largest |value| of a label: floats represent integers exactly up to this value.
inline constexpr float kMaxMeasuredLabel = 1 << 24;

/// One label with its measurements; 0 means no label.
struct MeasuredLabel : RegionStats {
  float label = 0;     ///< integer
  double surface = 0;  ///< area, squared world units; set by add_label_surfaces()
};

/// All labels, values rising, 0 included.
struct MeasuredLabels {
  std::vector<MeasuredLabel> labels;  ///< those of the map's voxels
  LeftOut left_out;                   ///< voxels of the map that do not count
};

/// Measures the labels; `values`: a second field, or null. Error (a message fragment): a voxel does not hold an integer up to 2^24, there
/// are more than 65536 labels, or measurable_box() fails.
CATENA_EXPORT Result<MeasuredLabels> measure_labels(const ScalarGrid& map, const ScalarField* values);

/// Adds the areas of the surfaces. `cell_areas`: area in a cell whose corner n has the label if bit n of the index is set.
CATENA_EXPORT Outcome add_label_surfaces(const ScalarGrid& map, const std::array<double, 256>& cell_areas, MeasuredLabels& measured);

}  // namespace catena::field
