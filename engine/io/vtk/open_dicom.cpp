// SPDX-License-Identifier: MIT
// Opens DICOM: a file, or a folder with everything below it. Headers are read first and grouped into volumes (dicom_volumes.h), then the
// pixels of the requested volume. Patient space +x left, +y posterior (LPS) becomes Catena's +x right, +y anterior (RAS).
#include <fmt/format.h>
#include <gdcmTrace.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "engine/base/text.h"
#include "engine/io/volume/units.h"
#include "engine/io/vtk/dicom_pixels.h"
#include "engine/io/vtk/dicom_slice_grid.h"
#include "engine/io/vtk/itk_image.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

namespace fs = std::filesystem;
using field::Mapping;

struct DicomScan {
  std::string shown;
  std::vector<DicomFile> files;
  std::vector<DicomVolume> volumes;
  std::map<std::string, int> others;  ///< number of objects that are not images, by modality
  std::vector<std::string> damaged;
};
using DicomScanPtr = std::shared_ptr<const DicomScan>;

/// Returns a list of at most ten texts, and the number of the others.
std::string cut_list(const std::vector<std::string>& words) {
  constexpr std::size_t kMax = 10;
  std::string list =
      fmt::format("{}", fmt::join(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(std::min(kMax, words.size())), ", "));
  if (words.size() > kMax) list += fmt::format(" and {} more", words.size() - kMax);
  return list;
}

std::vector<std::string> dicom_paths(const std::string& path) {
  constexpr std::size_t kMaxFiles = 100'000;
  std::error_code code;
  if (!fs::is_directory(path, code)) return {path};
  std::vector<std::string> paths;
  for (fs::recursive_directory_iterator at(path, fs::directory_options::skip_permission_denied, code), end; !code && at != end;
       at.increment(code))
    if (std::error_code ignored; paths.size() < kMaxFiles && at->is_regular_file(ignored)) paths.push_back(at->path().string());
  std::ranges::sort(paths);
  return paths;
}

Result<DicomScanPtr> scan_of(const Source& source) {
  gdcm::Trace::SetDebug(false);
  gdcm::Trace::SetWarning(false);
  gdcm::Trace::SetError(false);
  const auto scan = std::make_shared<DicomScan>();
  scan->shown = source.display_name;
  const std::vector<std::string> paths = dicom_paths(source.path);
  for (const std::string& path : paths) {
    DicomFile file;
    switch (read_dicom_header(path, file)) {
      case DicomKind::image:
        for (DicomFrame& frame : file.frames) frame.file = scan->files.size();
        scan->files.push_back(std::move(file));
        break;
      case DicomKind::other_object:
        if (file.modality == "DICOMDIR" && paths.size() > 1) break;  // the directory file of the folder
        ++scan->others[file.modality.empty() ? "without modality" : sanitize_for_terminal(file.modality)];
        break;
      case DicomKind::damaged:
        scan->damaged.push_back(sanitize_for_terminal(file.name) + (file.problem.empty() ? "" : " (" + file.problem + ")"));
        break;
      case DicomKind::not_dicom:
        break;
    }
  }
  std::error_code code;
  const bool folder = fs::is_directory(source.path, code);
  if (!folder && !scan->files.empty()) {  // a single file gives its own name to the volume
    scan->files.front().description = sanitize_for_terminal(fs::path(source.display_name).stem().string());
    scan->files.front().series_number.clear();
  }
  scan->volumes = group_dicom_volumes(scan->files);
  if (!scan->volumes.empty()) return DicomScanPtr(scan);
  if (!scan->damaged.empty())
    return Error{fmt::format("{}: no DICOM image can be read; damaged files: {}", source.display_name, cut_list(scan->damaged))};
  if (!scan->others.empty())
    return Error{fmt::format("{}: contains only DICOM objects that are not images ({}), expected images", source.display_name,
                             scan->others.begin()->first)};
  return Error{
      source.display_name +
      (folder ? ": the folder contains neither DICOM images nor an OpenFOAM case (system/controlDict, constant/polyMesh or processor0)"
              : ": is not a DICOM file, expected an image")};
}

// ---- choice of the volume ----

const DicomVolume* largest_of(const std::vector<DicomVolume>& volumes, const std::function<bool(const DicomVolume&)>& counts) {
  const auto rank = [](const DicomVolume& v) {
    const DicomFrame& frame = *v.frames.front();
    return std::make_tuple(v.is_image, v.frames.size(), std::uint64_t{frame.columns} * frame.rows);
  };
  const DicomVolume* best = nullptr;
  for (const DicomVolume& volume : volumes)
    if (counts(volume) && (best == nullptr || rank(volume) > rank(*best))) best = &volume;
  return best;
}

std::string describe_volume(const DicomVolume& volume) {
  return fmt::format("{}{}\"{}\" ({} image{})", volume.volume_number, volume.volume_number.empty() ? "" : " ", volume.name,
                     volume.frames.size(), volume.frames.size() == 1 ? "" : "s");
}

std::string list_of_volumes(const std::vector<DicomVolume>& volumes) {
  std::vector<std::string> words;
  for (const DicomVolume& volume : volumes) words.push_back(describe_volume(volume));
  return cut_list(words);
}

struct Choice {
  const DicomVolume* volume = nullptr;
  std::string note;  ///< other meanings of the requested name; empty: none
};

/// Finds a volume by name, by series description, or by number; of several volumes of a series the largest. Returns an Error if the number
/// belongs to several series.
Result<Choice> choose_volume(const DicomScan& scan, const std::string& grid) {
  const auto& volumes = scan.volumes;
  if (grid.empty()) return Choice{largest_of(volumes, [](const DicomVolume&) { return true; }), {}};
  const auto named = [&](const DicomVolume& v) { return v.name == grid || v.series == grid; };
  const auto numbered = [&](const DicomVolume& v) { return v.series_number == grid || v.volume_number == grid; };
  const auto several_series = [&](const auto& counts) {
    std::vector<DicomVolume> found;
    std::set<std::size_t> series;
    for (const DicomVolume& volume : volumes)
      if (counts(volume)) found.push_back(volume), series.insert(volume.series_index);
    return series.size() > 1 ? list_of_volumes(found) : std::string();
  };
  const DicomVolume* volume = largest_of(volumes, [&](const DicomVolume& v) { return v.name == grid; });
  if (volume == nullptr) volume = largest_of(volumes, named);
  if (volume != nullptr) {
    if (const std::string list = several_series([&](const DicomVolume& v) { return named(v) || numbered(v); }); !list.empty())
      return Choice{volume, fmt::format("{} is read as a name, and matches several series: {}", in_quotes(grid), list)};
    return Choice{volume, {}};
  }
  if (const DicomVolume* exact = largest_of(volumes, [&](const DicomVolume& v) { return v.volume_number == grid; }))
    return Choice{exact, {}};
  if (const std::string list = several_series(numbered); !list.empty())
    return Error{one_line(fmt::format("{}: several series have the number {}, expected one of: {}", scan.shown, in_quotes(grid), list))};
  if ((volume = largest_of(volumes, numbered)) != nullptr) return Choice{volume, {}};
  return Error{
      one_line(fmt::format("{}: there is no grid {}, expected one of: {}", scan.shown, in_quotes(grid), list_of_volumes(volumes)))};
}

void add_scan_notes(const DicomScan& scan, const DicomVolume& volume, const std::string& grid, std::vector<std::string>& notes) {
  if (scan.volumes.size() > 1 && grid != volume.name && grid != volume.volume_number)
    notes.push_back(fmt::format("the largest of {} volumes is shown, {}; --grid selects a volume by number or name: {}",
                                scan.volumes.size(), describe_volume(volume), list_of_volumes(scan.volumes)));
  std::vector<std::string> others;
  for (const auto& [modality, count] : scan.others) others.push_back(fmt::format("{} {}", count, modality));
  if (!others.empty()) notes.push_back(fmt::format("DICOM objects that are not images were left out: {}", cut_list(others)));
  if (!scan.damaged.empty()) notes.push_back(fmt::format("damaged files were left out: {}", cut_list(scan.damaged)));
}

// ---- values ----

Outcome read_stack(const DicomScan& scan, const DicomVolume& volume, std::vector<float>& stack, PixelStats& notes) {
  const DicomFrame& first = *volume.frames.front();
  const std::size_t voxels = std::size_t{first.columns} * first.rows;
  std::map<std::size_t, std::vector<const DicomFrame*>> by_file;
  std::map<const DicomFrame*, std::size_t> slot;
  for (const DicomFrame* frame : volume.frames) {
    slot[frame] = slot.size();
    by_file[frame->file].push_back(frame);
  }
  // the header is untrusted: before memory is allocated, the file must be large enough for the pixels, compressed at most by kBestRatio
  constexpr double kBestRatio = 2000;
  double available = 0;
  for (const auto& [index, frames] : by_file) {
    std::error_code code;
    const auto bytes = static_cast<double>(fs::file_size(scan.files[index].path, code));
    available += code ? 0 : scan.files[index].pixel_offset >= 0 ? 8 * bytes : kBestRatio * bytes;
  }
  if (static_cast<double>(voxels) * static_cast<double>(volume.frames.size()) > available)
    return Error{fmt::format("{}: {}: the files are truncated, expected {} images of {} x {} pixels", scan.shown, volume.name,
                             volume.frames.size(), first.columns, first.rows)};
  stack.resize(voxels * volume.frames.size());
  for (const auto& [index, frames] : by_file) {
    const DicomFile& file = scan.files[index];
    const auto store_frame = [&](const DicomFrame& frame, std::span<const float> values) {
      std::ranges::copy(values, stack.begin() + static_cast<std::ptrdiff_t>(slot.at(&frame) * voxels));
    };
    if (const auto done = read_dicom_pixels(file, frames, store_frame, notes); !done)
      return Error{scan.files.size() == 1 ? fmt::format("{}: {}", scan.shown, done.error().message)
                                          : fmt::format("{}: {}: {}", scan.shown, file.name, done.error().message)};
  }
  return Done{};
}

Result<ImportedData> open_volume(const DicomScan& scan, const DicomVolume& volume) {
  if (!volume.problem.empty())
    return Error{fmt::format("{}: {}{}", scan.shown, scan.volumes.size() > 1 ? volume.name + ": " : "", volume.problem)};
  const DicomFile& file = scan.files[volume.file];
  ImportedData opened;
  opened.notes = volume.notes;
  std::vector<float> values;
  PixelStats pixels;
  CATENA_CHECK(read_stack(scan, volume, values, pixels));
  const DicomSliceGrid lattice = fit_slice_grid(volume);
  const DicomFrame& first = *volume.frames.front();
  const std::size_t voxels = std::size_t{first.columns} * first.rows;
  if (!lattice.is_uniform) {
    std::vector<float> even = resample_slices(values, voxels, lattice, file.segmentation);
    opened.notes.push_back(slice_grid_note(lattice, values, even, voxels, file.segmentation));
    values = std::move(even);
  }
  if (pixels.padding_count > 0)
    opened.notes.push_back(fmt::format("{} pixels with the PixelPaddingValue of the header are read as holes", pixels.padding_count));
  if (pixels.rounded_count > 0)
    opened.notes.push_back(fmt::format("{} stored numbers were rounded to 32-bit floats", pixels.rounded_count));
  const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_FLOAT));
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), static_cast<float*>(array->GetVoidPointer(0)));
  const int size[3] = {static_cast<int>(first.columns), static_cast<int>(first.rows), static_cast<int>(lattice.count)};
  const bool scaled = first.column_spacing > 0;
  const Vec3 x = (scaled ? first.column_spacing : 1) * first.row_direction, y = (scaled ? first.row_spacing : 1) * first.column_direction;
  const Mapping mapping = Mapping::from_linear(Mat3(x, y, lattice.step), lattice.origin);
  opened.is_patient_space = first.has_position;
  opened.unit_length = scaled ? "mm" : "";
  opened.blocks.push_back({make_image_data(size, array, volume.name), opened.is_patient_space ? ras_from_lps(mapping) : mapping});
  if (field::is_unit_name(file.unit)) opened.units[volume.name] = file.unit;
  opened.name = volume.name;
  if (scan.volumes.size() > 1 || scan.files.size() > 1) opened.volume_number = volume.volume_number;
  opened.image_count = static_cast<int>(volume.frames.size());
  return opened;
}

/// Returns the units under every name by which a volume may be requested.
std::vector<field::GridMetadata> words_of_volumes(const DicomScan& scan, const std::string& grid) {
  std::vector<field::GridMetadata> words;
  const auto add = [&](const std::string& name, const DicomVolume& volume) {
    words.push_back({name, scan.files[volume.file].unit, volume.frames.front()->column_spacing > 0 ? "mm" : "", false});
  };
  for (const DicomVolume& volume : scan.volumes) {
    add(volume.name, volume);
    if (!volume.volume_number.empty()) add(volume.volume_number, volume);
  }
  std::set<std::string> others{"", grid};
  for (const DicomVolume& volume : scan.volumes) others.insert({volume.series, volume.series_number});
  for (const std::string& name : others)
    if (const auto choice = choose_volume(scan, name)) add(name, *choice->volume);
  return words;
}

/// Returns a note that more files of the series are in the folder of the single file that was opened; empty if there are none.
std::string series_beside(const Source& source, const DicomFile& self) {
  if (self.series.empty()) return {};
  std::error_code code;
  std::vector<fs::path> files;
  const fs::path file(source.path);
  for (fs::directory_iterator at(file.parent_path(), code), end; !code && at != end; at.increment(code))
    if (std::error_code ignored; at->is_regular_file(ignored)) files.push_back(at->path());
  std::ranges::sort(files);
  constexpr std::ptrdiff_t kLooks = 4;  // files of a series have consecutive names: checking a few on either side is enough
  const auto own_index = std::ranges::find(files, file) - files.begin();
  for (std::ptrdiff_t k = std::max(own_index - kLooks, std::ptrdiff_t{0}); k <= std::min(own_index + kLooks, std::ssize(files) - 1); ++k) {
    DicomFile other;
    if (k == own_index || read_dicom_header(files[static_cast<std::size_t>(k)].string(), other) != DicomKind::image ||
        other.series != self.series)
      continue;
    const fs::path folder_name = fs::path(source.display_name).parent_path();
    const std::string folder = folder_name.empty() ? "." : folder_name.string();
    return "the folder of this file has more images of the series: open the folder to get the volume (catena render " + folder + ")";
  }
  return {};
}

}  // namespace

Result<ImportedData> open_dicom(const Source& source) {
  CATENA_TRY(const DicomScanPtr scan, scan_of(source));
  ImportedData opened;
  if (source.mode == field::ReadMode::describe) {
    for (const DicomVolume& volume : scan->volumes)
      opened.deferred_volumes.push_back([scan, &volume]() -> Result<ImportedData> {
        auto one = open_volume(*scan, volume);
        if (one) return one;
        ImportedData refused;
        refused.name = volume.name;
        refused.volume_number = volume.volume_number;
        refused.image_count = static_cast<int>(volume.frames.size());
        refused.problem = one_line(one.error().message);
        return refused;
      });
  } else if (source.mode != field::ReadMode::metadata) {
    CATENA_TRY(const Choice choice, choose_volume(*scan, source.grid));
    CATENA_TRY(opened, open_volume(*scan, *choice.volume));
    add_scan_notes(*scan, *choice.volume, source.grid, opened.notes);
    if (!choice.note.empty()) opened.notes.push_back(choice.note);
    std::error_code code;
    if (!fs::is_directory(source.path, code))
      if (const std::string note = series_beside(source, scan->files.front()); !note.empty()) opened.notes.push_back(note);
  }
  opened.grid_metadata = words_of_volumes(*scan, source.grid);
  opened.is_patient_space = scan->volumes.front().frames.front()->has_position;
  if (opened.unit_length.empty() &&
      std::ranges::all_of(scan->volumes, [](const DicomVolume& v) { return v.frames.front()->column_spacing > 0; }))
    opened.unit_length = "mm";
  return opened;
}

}  // namespace catena::vtk
