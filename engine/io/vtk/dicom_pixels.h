// SPDX-License-Identifier: MIT
/// Private to this module: reads the pixels of DICOM files as numbers.
#pragma once
#include <functional>
#include <span>

#include "engine/io/vtk/dicom_headers.h"

namespace catena::vtk {

/// Statistics over all frames read.
struct PixelStats {
  std::uint64_t padding_count = 0;  ///< Number of pixels declared as padding by the header; they become NaN.
  std::uint64_t rounded_count = 0;  ///< Number of values that are not exactly representable as 32-bit floats.
};

/// Called for each frame with rows * columns values, rescaled, columns fastest.
using FrameCallback = std::function<void(const DicomFrame& frame, std::span<const float> values)>;

/// Reads frames of one file. Returns an Error with a message fragment without the file name. GDCM may throw.
Outcome read_dicom_pixels(const DicomFile& file, const std::vector<const DicomFrame*>& frames, const FrameCallback& on_frame,
                          PixelStats& notes);

}  // namespace catena::vtk
