/// Private to this room: frames of DICOM files brought together to volumes. A volume is a stack of frames of one series, size, pixel
/// spacing and orientation, in the order of their places along the normal, with one frame at each place, on a straight line.
///   origin + j step, step = (last - first) / (n - 1), which need not be along the normal (a tilted gantry)
/// Frames at one place are told apart by what their headers say of them: acquisition, echo time, ... (DicomKey).
#pragma once
#include <map>

#include "engine/io/vtk/dicom_headers.h"

namespace catena::vtk {

struct DicomVolume {
  std::string name;              ///< of the grid: the series' description, and what tells it from others of the series
  std::string volume_number;     ///< "3", or "3.2": the second volume with the SeriesNumber 3; empty: the header has none
  std::string series;            ///< description alone
  std::string series_number;     ///< SeriesNumber, which series may share
  std::size_t series_index = 0;  ///< which series of the scan
  std::size_t file = 0;
  std::vector<const DicomFrame*> frames;  ///< along the normal
  bool is_image = true;                   ///< false: one of its files alone is no field (colours, frames in time)
  std::string problem;                    ///< why it is no field: a phrase; empty: it is one
  std::vector<std::string> notes;
};

/// In the order of series numbers. Pure: reads the headers alone.
std::vector<DicomVolume> group_dicom_volumes(const std::vector<DicomFile>& files);

}  // namespace catena::vtk
