// SPDX-License-Identifier: MIT
/// Private to this module: groups frames of DICOM files into volumes. A volume is a stack of frames of the same series, size, pixel spacing
/// and orientation, ordered by position along the normal, with one frame at each position, on a straight line:
///   origin + j step, step = (last - first) / (n - 1), which need not be along the normal (a tilted gantry)
/// Frames at the same position are separated by attributes of their headers: acquisition, echo time, ... (DicomKey).
#pragma once
#include <map>

#include "engine/io/vtk/dicom_headers.h"

namespace catena::vtk {

/// A stack of frames.
struct DicomVolume {
  std::string name;  ///< Name of the grid: the description of the series, and the attribute that distinguishes the volume within it.
  std::string volume_number;     ///< "3", or "3.2": the second volume with the SeriesNumber 3; empty: not in the header.
  std::string series;            ///< Description of the series alone.
  std::string series_number;     ///< SeriesNumber, which several series may share.
  std::size_t series_index = 0;  ///< Index of the series in the scan.
  /// Index of the volume's first file in the scan.
  std::size_t file = 0;
  std::vector<const DicomFrame*> frames;  ///< Ordered along the normal.
  bool is_image = true;                   ///< False: one of the files by itself is not a field (color images, frames in time).
  std::string problem;                    ///< Message fragment: the reason that the volume is not a field; empty: it is one.
  std::vector<std::string> notes;
};

/// Groups frames into volumes, in the order of series numbers. Uses the headers only; does not access files.
std::vector<DicomVolume> group_dicom_volumes(const std::vector<DicomFile>& files);

}  // namespace catena::vtk
