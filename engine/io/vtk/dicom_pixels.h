/// Private to this room: the pixels of DICOM files as numbers.
#pragma once
#include <functional>
#include <span>

#include "engine/io/vtk/dicom_headers.h"

namespace catena::vtk {

/// What became of the pixels, over all frames that were read.
struct PixelStats {
  std::uint64_t padding_count = 0;  ///< pixels that the header calls padding: NaN
  std::uint64_t rounded_count = 0;  ///< values that are no 32-bit floats
};

/// One frame at a time, rows * columns values with the frame's rescale applied, columns fastest.
using FrameCallback = std::function<void(const DicomFrame& frame, std::span<const float> values)>;

/// Reads frames of one file. Errors are phrases without the file's name. GDCM may throw.
Outcome read_dicom_pixels(const DicomFile& file, const std::vector<const DicomFrame*>& frames, const FrameCallback& take,
                          PixelStats& notes);

}  // namespace catena::vtk
