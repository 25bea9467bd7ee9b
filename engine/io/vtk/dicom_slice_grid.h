// SPDX-License-Identifier: MIT
/// Private to this module: resamples the frames of a DICOM volume to equal distances.
#pragma once
#include "engine/io/vtk/dicom_volumes.h"

namespace catena::vtk {

/// Positions of the frames on the equidistant slices of the volume.
struct DicomSliceGrid {
  /// World position of the first slice, and the vector from one slice to the next, mm.
  Vec3 origin, step;
  /// Number of slices.
  std::size_t count = 1;
  std::vector<double> positions;              ///< Position of each frame, in steps; integers if `is_exact`.
  std::vector<double> stated_positions;       ///< Position of each frame according to the header, in steps.
  double min_distance = 0, max_distance = 0;  ///< Distances between neighboring frames, mm.
  bool is_uniform = true, is_exact = true;
  std::vector<bool> is_open_gap;  ///< [k]: the gap between frames k and k + 1 has no values; empty: there is no such gap.
  double widest_open_gap = 0, widest_filled_gap = 0;  ///< Widest gaps, mm; 0: none.
};
/// Finds the largest step whose multiples meet every frame, within 1 % of the step or 0.001 % of the smallest distance. If that needs too
/// many slices: the step that comes nearest to all frames. A gap is a distance more than twice (2.05 times) its neighbors, or ten times the
/// median. It is left open if there are at least two slices on either side; a single slice would be lost with it.
DicomSliceGrid fit_slice_grid(const DicomVolume& volume);

/// Resamples the slices of a volume (`voxels` each) to the slice grid: linearly between them; NaN in open gaps. `zero_between`: a
/// segmentation, with 0 where there is no slice.
std::vector<float> resample_slices(const std::vector<float>& slices, std::size_t voxels, const DicomSliceGrid& lattice, bool zero_between);
/// Message on what the resampling changed, without a final period.
std::string slice_grid_note(const DicomSliceGrid& lattice, const std::vector<float>& slices, const std::vector<float>& even,
                            std::size_t voxels, bool zero_between);

}  // namespace catena::vtk
