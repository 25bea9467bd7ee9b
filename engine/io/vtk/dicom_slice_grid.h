/// Private to this room: the frames of a DICOM volume at equal distances.
#pragma once
#include "engine/io/vtk/dicom_volumes.h"

namespace catena::vtk {

/// The places of the frames on the volume's lattice.
struct DicomSliceGrid {
  Vec3 origin, step;
  std::size_t count = 1;
  std::vector<double> positions;              ///< of each frame, in steps; whole numbers where `exact`
  std::vector<double> stated_positions;       ///< of each frame, in steps, as the headers state them
  double min_distance = 0, max_distance = 0;  ///< distances of neighbours, mm
  bool is_uniform = true, is_exact = true;
  std::vector<bool> is_open_gap;                      ///< [k]: the gap between frames k and k + 1 has no values; empty: there is none
  double widest_open_gap = 0, widest_filled_gap = 0;  ///< gaps, mm; 0: there are none
};
/// The largest step that meets every frame, within 1 % of itself or 0.001 % of the smallest distance. Where that needs too many slices, the
/// step that comes nearest to every frame. A gap is a distance more than twice those beside it, or ten times the median. It is open where
/// two slices or more lie on either side; a single slice would be lost with it.
DicomSliceGrid fit_slice_grid(const DicomVolume& volume);

/// The slices of a volume, one after the other, brought to the lattice: linearly between them; NaN where it is open. Of a segmentation,
/// where nothing is, 0.
std::vector<float> resample_slices(const std::vector<float>& slices, std::size_t voxels, const DicomSliceGrid& lattice, bool zero_between);
/// What that did to them: a sentence without an end.
std::string slice_grid_note(const DicomSliceGrid& lattice, const std::vector<float>& slices, const std::vector<float>& even,
                            std::size_t voxels, bool zero_between);

}  // namespace catena::vtk
