// SPDX-License-Identifier: MIT
/// Private to this module: geometry and value encoding from the header of a DICOM file, one record per frame. A file with one image has one
/// frame. Lengths are millimeters; positions and directions are in DICOM's patient space (LPS): +x to the left, +y to the back, +z to the
/// head.
///   position of a frame, the first available of
///     ImagePositionPatient of the frame, of its functional groups, of its NM detector
///     ImagePositionPatient + GridFrameOffsetVector (RT dose), + (slice - 1) SpacingBetweenSlices along the normal (NM and other
///     multi-frame files)
///   value = slope * stored + intercept: Rescale Slope and Intercept of the frame, DoseGridScaling, else a linear real world value mapping
#pragma once
#include <gdcmReader.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::vtk {

/// Attributes that can distinguish images at one position, in order of preference; values are text as in the header.
enum class DicomKey : std::size_t {
  segment,
  stack,
  acquisition,
  echo_time,
  temporal_position,
  trigger_time,
  b_value,
  gradient,
  inversion_time,
  flip_angle,
  time_offset,
  frame_reference_time,
  energy_window,
  detector,
  phase,
  rotation,
  rr_interval,
  time_slot,
  angular_view,
  time_slice,
  tube_voltage,
  image_type,
  sequence_name,
  acquisition_time,
  content_time,
  count
};
/// Name and unit of a key, for messages and names of volumes.
struct DicomKeyInfo {
  const char *name, *unit;
};
DicomKeyInfo key_info(DicomKey key);

/// One frame of a DICOM file.
struct DicomFrame {
  std::size_t file = 0;     ///< Index of the file in the scan.
  std::uint32_t index = 0;  ///< Index of the frame in the file.
  std::uint32_t columns = 0, rows = 0;
  bool has_position = false, has_orientation = false;  ///< True: specified by the header.
  Vec3 position{0.0};                                  ///< Center of the first pixel, mm.
  Vec3 row_direction{1, 0, 0}, column_direction{0, 1, 0};
  double column_spacing = 0, row_spacing = 0;  ///< Distance between columns, between rows, mm; 0: not specified.
  double thickness = 0;                        ///< Slice thickness, mm; 0: not specified. Not the distance between slices.
  double slope = 1, intercept = 0;
  int instance = 0;
  std::array<std::string, static_cast<std::size_t>(DicomKey::count)> keys;

  Vec3 normal() const { return direction(cross(row_direction, column_direction)); }
  /// Position along the normal, mm.
  double offset() const { return dot(position, normal()); }
};

/// Attributes shared by all frames of a file.
struct DicomFile {
  std::string path, name;  ///< `name` is used in messages.
  std::string series, description, series_number, modality, unit, frame_of_reference, transfer_syntax;
  bool localizer = false, segmentation = false;
  std::string problem;             ///< Message fragment: the reason that the frames are not a field; empty: they are.
  std::vector<std::string> notes;  ///< Assumptions that were made.
  std::uint16_t bits_allocated = 0, bits_stored = 0, high_bit = 0;
  bool is_signed = false;
  std::int64_t pixel_offset = -1;      ///< Offset of uncompressed little-endian pixels in the file, bytes; -1: they have to be decoded.
  std::int64_t fragments_offset = -1;  ///< Offset of compressed pixels in the file, bytes; -1: there are none.
  std::uint64_t pixel_bytes = 0;       ///< Number of bytes at pixel_offset, according to the header.
  std::vector<std::string> segments;
  std::vector<DicomFrame> frames;
};

/// Opens a file's data set, with or without its pixels; nullptr: GDCM cannot read it.
std::unique_ptr<gdcm::Reader> open_dicom_reader(const std::string& path, bool header_only);

/// Kind of a file, by its header.
enum class DicomKind { image, other_object, not_dicom, damaged };
/// Reads a header, without the pixels. `file` is complete for images only; for other objects `modality` is set, and for a damaged file
/// `problem`, if it is known.
DicomKind read_dicom_header(const std::string& path, DicomFile& file);

}  // namespace catena::vtk
