// SPDX-License-Identifier: MIT
#include "engine/io/vtk/dicom_headers.h"

#include <fmt/format.h>
#include <gdcmReader.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "engine/base/text.h"
#include "engine/io/vtk/dicom_functional_groups.h"
#include "engine/io/vtk/gdcm_guard.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

using gdcm::DataSet;
using gdcm::Tag;

constexpr std::size_t kMaxFrames = 65'536;

/// A human-readable text, at most 64 bytes as in the standard. Latin-1 becomes UTF-8; in other character sets only ASCII is read.
std::string words_at(const DataSet& set, Tag tag, const std::string& character_set) {
  constexpr std::size_t kMaxBytes = 64;
  std::string words;
  for (const char c : read_text(set, tag).substr(0, kMaxBytes)) {
    const auto byte = static_cast<unsigned char>(c);
    if (character_set == "ISO_IR 100" && byte >= 0x80) {
      words += static_cast<char>(0xc0 | byte >> 6);
      words += static_cast<char>(0x80 | (byte & 0x3f));
    } else {
      words += c;
    }
  }
  return sanitize_for_terminal(words);
}

std::optional<Vec3> vector_of(const std::vector<double>& numbers, std::size_t at = 0) {
  return numbers.size() >= at + 3 ? std::optional(Vec3(numbers[at], numbers[at + 1], numbers[at + 2])) : std::nullopt;
}

/// Reads the rescale of a frame. Returns false if the file has a real world value mapping that is not linear.
bool read_rescale(const DicomFunctionalGroups& groups, DicomFrame& frame, DicomFile& file) {
  const Tag group(0x28, 0x9145);
  const auto slope = groups.number(group, Tag(0x28, 0x1053)), intercept = groups.number(group, Tag(0x28, 0x1052));
  if (file.modality == "RTDOSE") {
    const auto scaling = read_number(groups.root, Tag(0x3004, 0xe));
    if (scaling) frame.slope = *scaling;
    if (read_text(groups.root, Tag(0x3004, 0x2)) == "GY" && scaling) file.unit = "Gy";
    if (!scaling && frame.index == 0) file.notes.push_back("the header has no DoseGridScaling: the stored numbers are used unscaled");
    return true;
  }
  if (slope || intercept) {
    frame.slope = slope.value_or(1);
    frame.intercept = intercept.value_or(0);
    return true;
  }
  if (groups.root.FindDataElement(Tag(0x28, 0x3000))) return true;  // a modality LUT
  std::vector<DataSet> mappings;
  for (const DataSet* set : {groups.per_frame, groups.shared, &groups.root})
    if (set != nullptr && mappings.empty()) mappings = read_items(*set, Tag(0x40, 0x9096));
  if (mappings.empty()) return true;
  const auto real_slope = read_number(mappings[0], Tag(0x40, 0x9225), DicomEncoding::f64);
  const auto real_intercept = read_number(mappings[0], Tag(0x40, 0x9224), DicomEncoding::f64);
  if (!real_slope || !real_intercept) return false;
  frame.slope = *real_slope;
  frame.intercept = *real_intercept;
  if (frame.index > 0) return true;
  file.notes.push_back("the values are scaled by the first real world value mapping of the header");
  for (const DataSet& unit : read_items(mappings[0], Tag(0x40, 0x8ea))) file.unit = read_text(unit, Tag(0x8, 0x100));
  return true;
}

void read_units(const DataSet& root, const DicomFunctionalGroups& groups, DicomFile& file) {
  const std::string type = groups.text(Tag(0x28, 0x9145), Tag(0x28, 0x1054)), unit_text = read_text(root, Tag(0x54, 0x1001));
  if (file.modality == "CT" && type.empty()) file.unit = "HU";
  if (type == "HU") file.unit = "HU";
  static constexpr std::pair<const char*, const char*> kPet[] = {{"BQML", "Bq/mL"}, {"GML", "g/mL"}, {"CNTS", "counts"}, {"CPS", "1/s"}};
  for (const auto& [code, word] : kPet)
    if (unit_text == code) file.unit = word;
}

/// Reads position and axes, as far as the frame itself has them.
void read_place(const DicomFunctionalGroups& groups, DicomFrame& frame) {
  for (const Tag& group : {Tag(0x20, 0x9113), Tag(0x20, 0x930e)})
    if (!frame.has_position)
      if (const auto numbers = groups.numbers(group, group == Tag(0x20, 0x930e) ? Tag(0x20, 0x9301) : Tag(0x20, 0x32), 3,
                                              group == Tag(0x20, 0x930e) ? DicomEncoding::f64 : DicomEncoding::text))
        frame.position = *vector_of(*numbers), frame.has_position = true;
  for (const Tag& group : {Tag(0x20, 0x9116), Tag(0x20, 0x930f)})
    if (!frame.has_orientation)
      if (const auto numbers = groups.numbers(group, group == Tag(0x20, 0x930f) ? Tag(0x20, 0x9302) : Tag(0x20, 0x37), 6,
                                              group == Tag(0x20, 0x930f) ? DicomEncoding::f64 : DicomEncoding::text))
        frame.row_direction = *vector_of(*numbers), frame.column_direction = *vector_of(*numbers, 3), frame.has_orientation = true;
  const Tag measures(0x28, 0x9110);
  if (const auto spacing = groups.numbers(measures, Tag(0x28, 0x30), 2))
    frame.row_spacing = (*spacing)[0], frame.column_spacing = (*spacing)[1];
  frame.thickness = groups.number(measures, Tag(0x18, 0x50)).value_or(0);
}

/// Reads another spacing in place of a missing PixelSpacing.
void read_other_spacing(const DataSet& root, DicomFile& file) {
  struct Other {
    Tag tag;
    const char* note;
  };
  static const Other kOthers[] = {
      {Tag(0x18, 0x1164),
       "the header has no PixelSpacing: ImagerPixelSpacing is used, so that lengths are measured on the detector, not in the patient"},
      {Tag(0x18, 0x2010),
       "the header has no PixelSpacing: NominalScannedPixelSpacing is used, so that lengths are measured on the scanned image"}};
  for (const Other& other : kOthers) {
    const auto spacing = read_numbers(root, other.tag);
    if (spacing.size() < 2 || file.frames.front().row_spacing != 0) continue;
    for (DicomFrame& frame : file.frames) frame.row_spacing = spacing[0], frame.column_spacing = spacing[1];
    file.notes.push_back(other.note);
  }
}

/// Adds the frame offsets of an RT dose. Returns false if the offsets contradict the position.
bool add_grid_offsets(const std::vector<double>& offsets, DicomFile& file) {
  for (DicomFrame& frame : file.frames) {
    const double z = frame.position.z, offset = offsets[frame.index];
    const bool along_z = std::fabs(std::fabs(frame.normal().z) - 1) < 1e-6;
    if (offsets[0] == 0)
      frame.position = frame.position + offset * frame.normal();
    else if (along_z && std::fabs(offsets[0] - z) < 1e-3)
      frame.position.z = offset;  // the offsets are z coordinates in patient space
    else
      return false;
  }
  return true;
}

/// Sets the positions of frames in files without functional groups.
void place_frames(const DataSet& root, double step, DicomFile& file) {
  const std::vector<double> offsets = read_numbers(root, Tag(0x3004, 0xc)),
                            slices = read_numbers(root, Tag(0x54, 0x80), DicomEncoding::u16);
  if (file.frames.size() < 2 && slices.empty()) return;
  if (!offsets.empty()) {
    if (offsets.size() != file.frames.size())
      file.problem =
          fmt::format("GridFrameOffsetVector has {} numbers, expected one for each of the {} frames", offsets.size(), file.frames.size());
    else if (!file.frames.front().has_position)
      file.problem = "the header has no ImagePositionPatient";
    else if (!add_grid_offsets(offsets, file))
      file.problem = fmt::format("GridFrameOffsetVector begins with {:g}, expected 0 or the z of ImagePositionPatient", offsets[0]);
    return;
  }
  if (slices.size() == file.frames.size() && step != 0) {
    for (DicomFrame& frame : file.frames) frame.position = frame.position + (slices[frame.index] - 1) * step * frame.normal();
    return;
  }
  const std::string increment = read_bytes(root, Tag(0x28, 0x9));
  const bool timed = increment.size() >= 2 && increment[0] == 0x18 && increment[1] == 0;  // FrameTime and similar
  if (timed)
    file.problem = fmt::format("the {} frames are a time series, expected slices", file.frames.size());
  else if (step == 0)
    file.problem = fmt::format(
        "the header has no distance between the {} frames, expected frame positions, GridFrameOffsetVector or SpacingBetweenSlices",
        file.frames.size());
  else
    for (DicomFrame& frame : file.frames) frame.position = frame.position + frame.index * step * frame.normal();
}

void read_detectors(const DataSet& root, DicomFile& file) {
  const std::vector<DataSet> detectors = read_items(root, Tag(0x54, 0x22), 64);
  for (DicomFrame& frame : file.frames) {
    const std::string& number = frame.keys[static_cast<std::size_t>(DicomKey::detector)];
    const auto at = static_cast<std::size_t>(std::max(1, std::atoi(number.c_str())) - 1);
    if (at >= detectors.size()) continue;
    const auto position = vector_of(read_numbers(detectors[at], Tag(0x20, 0x32)));
    const auto axes = read_numbers(detectors[at], Tag(0x20, 0x37));
    if (!frame.has_position && position) frame.position = *position, frame.has_position = true;
    if (!frame.has_orientation && axes.size() >= 6)
      frame.row_direction = *vector_of(axes), frame.column_direction = *vector_of(axes, 3), frame.has_orientation = true;
  }
}

/// Checks that the axes are two orthogonal directions, and that each spacing is a length.
void check_frames(DicomFile& file) {
  constexpr double kMaxLength = 1e6;
  for (const DicomFrame& frame : file.frames) {
    const Vec3 &a = frame.row_direction, &b = frame.column_direction;
    if (std::fabs(norm(a) - 1) > 1e-2 || std::fabs(norm(b) - 1) > 1e-2 || std::fabs(dot(a, b)) > 1e-2)
      file.problem = "ImageOrientationPatient is invalid, expected two orthogonal unit vectors";
    const bool has_spacing = frame.row_spacing != 0 || frame.column_spacing != 0;
    if (has_spacing &&
        !(frame.row_spacing > 0 && frame.column_spacing > 0 && std::max(frame.row_spacing, frame.column_spacing) < kMaxLength))
      file.problem =
          fmt::format("PixelSpacing is {:g} and {:g} mm, expected positive lengths below 1e6 mm", frame.row_spacing, frame.column_spacing);
    if (!(norm(frame.position) < kMaxLength)) file.problem = "ImagePositionPatient is farther than 1e6 mm from the origin";
    if (!std::isfinite(frame.slope) || !std::isfinite(frame.intercept) || frame.slope == 0)
      file.problem = fmt::format("the rescale slope is {:g} and the intercept is {:g}, expected finite numbers and a slope other than 0",
                                 frame.slope, frame.intercept);
  }
}

void read_geometry(const DataSet& root, std::size_t frames, DicomFile& file) {
  const std::vector<DataSet> shared = read_items(root, Tag(0x5200, 0x9229)),
                             frame_groups = read_items(root, Tag(0x5200, 0x9230), kMaxFrames);
  DicomFrame frame;
  frame.columns = static_cast<std::uint32_t>(read_number(root, Tag(0x28, 0x11), DicomEncoding::u16).value_or(0));
  frame.rows = static_cast<std::uint32_t>(read_number(root, Tag(0x28, 0x10), DicomEncoding::u16).value_or(0));
  frame.instance = static_cast<int>(std::clamp(read_number(root, Tag(0x20, 0x13)).value_or(0), -1e9, 1e9));
  bool own_places = !frame_groups.empty(), mapped = true;
  double step = 0;
  for (std::size_t n = 0; n < frames; ++n) {
    const DicomFunctionalGroups groups{root, shared.empty() ? nullptr : &shared[0], n < frame_groups.size() ? &frame_groups[n] : nullptr};
    DicomFrame one = frame;
    one.index = static_cast<std::uint32_t>(n);
    read_place(groups, one);
    read_frame_keys(groups, one);
    if (n == 0) read_units(root, groups, file);
    mapped = read_rescale(groups, one, file) && mapped;
    if (n == 0) step = groups.number(Tag(0x28, 0x9110), Tag(0x18, 0x88)).value_or(0);
    own_places = own_places && n < frame_groups.size() &&
                 (!read_items(frame_groups[n], Tag(0x20, 0x9113)).empty() || !read_items(frame_groups[n], Tag(0x20, 0x930e)).empty());
    file.frames.push_back(std::move(one));
  }
  read_nm_vectors(root, file.frames);
  read_detectors(root, file);
  read_other_spacing(root, file);
  if (!own_places) place_frames(root, step, file);
  if (!mapped) file.problem = "the real world value mapping is a table, expected a slope and an intercept";
  if (file.problem.empty()) check_frames(file);
}

/// Returns the offset of the pixels, and sets `bytes` to their size; -1: there are none. The pixels follow the header of the element, where
/// the stream stopped.
std::int64_t find_pixels(const std::string& path, std::uint64_t at, std::uint64_t& bytes) {
  constexpr std::uint64_t kHeaderBytes = 12;
  if (at < kHeaderBytes) return -1;
  std::ifstream in(path, std::ios::binary);
  std::string head(kHeaderBytes, '\0');
  in.seekg(static_cast<std::streamoff>(at - kHeaderBytes)).read(head.data(), static_cast<std::streamsize>(kHeaderBytes));
  const std::string_view tag("\xe0\x7f\x10\x00", 4);
  if (!in || (!head.starts_with(tag) && head.substr(4, 4) != tag)) return -1;
  for (std::size_t b = 0; b < 4; ++b) bytes |= std::uint64_t{static_cast<unsigned char>(head[8 + b])} << 8 * b;
  return static_cast<std::int64_t>(at);
}

/// Returns whether the file meta information, in explicit VR and little-endian, has TransferSyntaxUID.
bool states_transfer_syntax(const std::string& path) {
  constexpr std::size_t kStart = 132, kMaxMetaBytes = 1 << 16;
  std::string bytes(kMaxMetaBytes, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  const auto word = [&](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at])) |
           static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + 1])) << 8;
  };
  for (std::size_t at = kStart; at + 12 <= bytes.size() && word(at) == 2;) {
    const std::string_view type = std::string_view(bytes).substr(at + 4, 2);
    const bool has_long_length = type == "OB" || type == "OW" || type == "SQ" || type == "UN" || type == "UT";
    const std::size_t length = has_long_length ? word(at + 8) | word(at + 10) << 16 : word(at + 6);
    if (word(at + 2) == 0x10) return length > 0;
    at += (has_long_length ? 12 : 8) + length;
  }
  return false;
}

void read_pixel_words(const DataSet& root, DicomFile& file) {
  const auto word = [&](std::uint16_t element) {
    return static_cast<std::uint16_t>(read_number(root, Tag(0x28, element), DicomEncoding::u16).value_or(0));
  };
  file.bits_allocated = word(0x100);
  file.bits_stored = word(0x101) != 0 ? word(0x101) : file.bits_allocated;
  file.high_bit = root.FindDataElement(Tag(0x28, 0x102)) ? word(0x102) : static_cast<std::uint16_t>(file.bits_stored - 1);
  file.is_signed = word(0x103) == 1;
  const std::string photometric = read_text(root, Tag(0x28, 0x4)), type = read_text(root, Tag(0x8, 0x8));
  const int samples = std::max<int>(word(0x2), 1);
  if (samples != 1 || (photometric != "MONOCHROME2" && photometric != "MONOCHROME1" && !photometric.empty()))
    file.problem = fmt::format("is a colour image ({}), expected grey values",
                               photometric.empty() ? "several samples per pixel" : in_quotes(photometric));
  else if (type.find("MOSAIC") != std::string::npos)
    file.problem = "is a mosaic of several slices in one image, expected separate slices (dcm2niix converts mosaics to volumes)";
  if (photometric == "MONOCHROME1")
    file.notes.push_back("the image is MONOCHROME1, which other programs show inverted; the stored values are used");
}

}  // namespace

std::unique_ptr<gdcm::Reader> open_dicom_reader(const std::string& path, bool header_only) {
  auto reader = std::make_unique<gdcm::Reader>();
  reader->SetFileName(path.c_str());
  bool read = false;
  const bool completed = call_gdcm([&] {
    const Tag pixels(0x7fe0, 0x10);
    read = reader->CanRead() && (header_only ? reader->ReadUpToTag(pixels, {pixels}) : reader->Read());
  });
  if (!completed) static_cast<void>(reader.release());
  return read ? std::move(reader) : nullptr;
}

bool is_dicom_file(const std::string& path) {
  std::string head(132, '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), 132);
  return head.ends_with("DICM");
}

DicomKind read_dicom_header(const std::string& path, DicomFile& file) {
  const bool magic = is_dicom_file(path);
  const auto failed = [&] {
    if (magic && !states_transfer_syntax(path)) file.problem = "the header has no transfer syntax";
    return magic ? DicomKind::damaged : DicomKind::not_dicom;
  };
  file.path = path;
  file.name = std::filesystem::path(path).filename().string();
  const std::unique_ptr<gdcm::Reader> owned = open_dicom_reader(path, true);
  if (owned == nullptr) return failed();
  const gdcm::Reader& reader = *owned;
  const DataSet& root = reader.GetFile().GetDataSet();
  file.modality = read_text(root, Tag(0x8, 0x60));
  const double rows = read_number(root, Tag(0x28, 0x10), DicomEncoding::u16).value_or(0);
  const double columns = read_number(root, Tag(0x28, 0x11), DicomEncoding::u16).value_or(0);
  const std::string kind = read_text(root, Tag(0x8, 0x16));
  constexpr std::string_view kDirectory = "1.2.840.10008.1.3.10";
  if (read_text(reader.GetFile().GetHeader(), Tag(0x2, 0x2)) == kDirectory) {
    file.modality = "DICOMDIR";
    return DicomKind::other_object;
  }
  if (rows < 1 || columns < 1) return kind.empty() && file.modality.empty() ? failed() : DicomKind::other_object;
  const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  using Syntax = gdcm::TransferSyntax;
  if (syntax == Syntax::ImplicitVRLittleEndian || syntax == Syntax::ExplicitVRLittleEndian)
    file.pixel_offset = find_pixels(path, reader.GetStreamCurrentPosition(), file.pixel_bytes);
  std::uint64_t undefined = 0;
  if (syntax.IsEncapsulated()) file.fragments_offset = find_pixels(path, reader.GetStreamCurrentPosition(), undefined);
  file.series = read_text(root, Tag(0x20, 0xe));
  file.description = words_at(root, Tag(0x8, 0x103e), read_text(root, Tag(0x8, 0x5)));
  file.series_number = read_text(root, Tag(0x20, 0x11));
  file.frame_of_reference = read_text(root, Tag(0x20, 0x52));
  file.localizer = read_text(root, Tag(0x8, 0x8)).find("LOCALIZER") != std::string::npos;
  file.segmentation = file.modality == "SEG";
  for (const DataSet& segment : read_items(root, Tag(0x62, 0x2), kMaxFrames)) {
    const auto number = static_cast<std::size_t>(read_number(segment, Tag(0x62, 0x4), DicomEncoding::u16).value_or(0));
    if (file.segments.size() <= number) file.segments.resize(number + 1);
    file.segments[number] = words_at(segment, Tag(0x62, 0x5), read_text(root, Tag(0x8, 0x5)));
  }
  read_pixel_words(root, file);
  const double frames = read_number(root, Tag(0x28, 0x8)).value_or(1);
  if (!(frames >= 1 && frames <= static_cast<double>(kMaxFrames))) {
    file.problem = fmt::format("NumberOfFrames is {:g}, expected 1 to {}", frames, kMaxFrames);
    file.frames.resize(1);
    return DicomKind::image;
  }
  read_geometry(root, static_cast<std::size_t>(frames), file);
  return DicomKind::image;
}

}  // namespace catena::vtk
