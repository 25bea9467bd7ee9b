/// Private to this room: what the header of a DICOM file says of geometry and values, one record a frame. A file of one image is a file of
/// one frame. Lengths are millimetres; positions and directions are the patient's: +x to the left, +y to the back, +z to the head.
///   position of a frame, the first that there is of
///     ImagePositionPatient of the frame, of its functional groups, of its NM detector
///     ImagePositionPatient + GridFrameOffsetVector (RT dose), + (slice - 1) SpacingBetweenSlices along the normal (NM and other
///     multi-frame files)
///   value = slope stored + intercept: Rescale Slope and Intercept of the frame, DoseGridScaling, else a linear real world value mapping
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

/// What may tell images at one position apart, in order of preference; text as the header has it.
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
struct DicomKeyInfo {
  const char *name, *unit;
};
DicomKeyInfo key_info(DicomKey key);

struct DicomFrame {
  std::size_t file = 0;     ///< which file of the scan
  std::uint32_t index = 0;  ///< which frame of the file
  std::uint32_t columns = 0, rows = 0;
  bool has_position = false, has_orientation = false;  ///< whether the header says position and orientation
  Vec3 position{0.0};                                  ///< of the first pixel's centre
  Vec3 row_direction{1, 0, 0}, column_direction{0, 1, 0};
  double column_spacing = 0, row_spacing = 0;  ///< between columns, between rows; 0: not stated
  double thickness = 0;                        ///< of the slice; 0: not stated. It is no distance between slices
  double slope = 1, intercept = 0;
  int instance = 0;
  std::array<std::string, static_cast<std::size_t>(DicomKey::count)> keys;

  Vec3 normal() const { return direction(cross(row_direction, column_direction)); }
  /// Place along the normal.
  double offset() const { return dot(position, normal()); }
};

/// What holds for all frames of a file.
struct DicomFile {
  std::string path, name;  ///< name: for messages
  std::string series, description, series_number, modality, unit, frame_of_reference, transfer_syntax;
  bool localizer = false, segmentation = false;
  std::string problem;             ///< why its frames are no field: a phrase; empty: they are
  std::vector<std::string> notes;  ///< what was assumed
  std::uint16_t bits_allocated = 0, bits_stored = 0, high_bit = 0;
  bool is_signed = false;
  std::int64_t pixel_offset = -1;      ///< of uncompressed little-endian pixels in the file; -1: they have to be decoded
  std::int64_t fragments_offset = -1;  ///< of compressed pixels in the file; -1: there are none
  std::uint64_t pixel_bytes = 0;       ///< at pixel_offset, as the header says
  std::vector<std::string> segments;
  std::vector<DicomFrame> frames;
};

/// A file's data set, with its pixels or without. nullptr: GDCM cannot read it.
std::unique_ptr<gdcm::Reader> open_dicom_reader(const std::string& path, bool header_only);

enum class DicomKind { image, other_object, not_dicom, damaged };
/// Reads a header, without its pixels. `file` is complete for images only; `modality` is set of other objects, and `trouble` of a damaged
/// file where it is known.
DicomKind read_dicom_header(const std::string& path, DicomFile& file);

}  // namespace catena::vtk
