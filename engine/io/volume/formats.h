/// The file formats that hold fields, by the endings of their names (any case). Who asks for an ending, or prints which there are, asks
/// here. To add one: a reader with a row of the registry, NAME_format() below, and a line in formats.cpp. Any thread.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/grid/dense.h"
#include "engine/field/number_type.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"

namespace catena::field {

/// By its name; a folder and a DICOM file without an ending by themselves.
bool is_field_file(std::string_view path);
/// Whether it is of a format that does not say its own layout (.raw): a scene or an option has to.
bool needs_layout(std::string_view path);
/// An array of NumPy's (.npy, .npz), which does not say where it lies.
bool is_numpy_file(std::string_view path);
/// ".vdb", ".nii", ..; `bare`: of those that say their layout, which can be opened without a scene.
std::vector<std::string_view> field_extensions(bool bare = false);
/// "a data file (.vdb, .nii, ..)", for a sentence.
std::string describe_field_extensions();

/// Private to this room: the checks that every reader makes of a path.

/// DICOM files often have names without an ending: "DICM" after 128 bytes tells them.
bool has_dicom_magic(std::string_view path);

/// The size of a regular file that can be opened; else an error that names it.
Result<std::uint64_t> readable_file_size(const std::string& path);
/// The file's name without folder and extension.
std::string file_stem(const std::string& path);

/// For who reads a format: this room, and programs that bring one of their own. One reader a format, and the counters they keep.

/// A file that holds one box of numbers, opened: its layout is checked and fits into the memory that is allowed.
struct DenseFile {
  std::string name;    ///< of its grid
  std::string type;    ///< as `info` prints it
  std::string prefix;  ///< of a phrase about its values: "x.raw: the data "
  Mapping mapping;
  int components = 1;                ///< 1 or 3
  DenseSource source;                ///< keeps the file open
  std::vector<double> times{};       ///< as those of AnyField
  std::string time_unit{};           ///< as that of AnyField
  std::int64_t newest_mtime_ns = 0;  ///< as that of AnyField
  std::vector<std::string> notes{};
  std::shared_ptr<const RoundingLoss> rounding{};  ///< what reading the numbers has rounded so far; none: nothing is told of it
};
Result<AnyField> load_dense(const DenseFile& file);
/// The same grid read by its cubic cells. What is no grid of its own values (points, meshes) is as it was.
Result<AnyField> with_cubic_interpolation(AnyField field, const std::string& path);
/// Of a format that holds one grid: what there is once it is loaded.
Result<std::vector<GridInfo>> describe_by_loading(const std::string& path, int step);

/// One row of the registry of formats (formats.cpp).
struct FileFormat {
  std::vector<std::string_view> extensions;  ///< of names, lower-case
  bool needs_layout = false;                 ///< the file says nothing about itself: LoadRequest::raw goes with it
  /// Either a box of numbers is opened, or one grid of the file is loaded.
  Result<DenseFile> (*open)(const LoadRequest& request) = nullptr;
  Result<AnyField> (*load)(const LoadRequest& request) = nullptr;
  Result<std::vector<GridInfo>> (*describe)(const std::string& path, int step) = nullptr;
  Units (*units)(const std::string& path, const std::string& grid) = nullptr;  ///< nullptr: the format has none
  bool reads_folders = false;                                                  ///< it reads folders, and DICOM files without an ending, too
};
/// One more, at start-up, before anything reads a file.
void register_format(FileFormat format);
FileFormat vdb_format();
FileFormat nifti_format();
FileFormat raw_format();
FileFormat npy_format();
FileFormat vtk_format();
/// nullptr: none. `ending`: which of its endings.
const FileFormat* find_format(std::string_view path, std::string_view* ending = nullptr);

Units read_nifti_units(const std::string& path, const std::string& grid);
Units read_vdb_units(const std::string& path, const std::string& grid);

void count_file();
void count_grid();
void count_mask();

}  // namespace catena::field
