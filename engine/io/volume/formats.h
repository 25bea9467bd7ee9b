// SPDX-License-Identifier: MIT
/// Registry of the file formats that hold fields, by file extension (any case). Everything that needs or prints extensions uses this
/// registry. To add a format: a reader with a row of the registry, NAME_format() below, and a line in formats.cpp. Any thread.
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

/// Decides by the extension; folders and DICOM files without an extension are recognized by their contents.
bool is_field_file(std::string_view path);
/// Whether the format does not specify its own layout (.raw): a scene or an option has to.
bool needs_layout(std::string_view path);
/// Whether it is a NumPy array (.npy, .npz), which does not specify its position in the world.
bool is_numpy_file(std::string_view path);
/// File extensions ".vdb", ".nii", ..; `bare`: only of formats that specify their layout, which can be opened without a scene.
std::vector<std::string_view> field_extensions(bool bare = false);
/// Message fragment: "a data file (.vdb, .nii, ..)".
std::string describe_field_extensions();

/// Private to this module: the path checks of every reader.

/// DICOM files often have no extension: recognized by "DICM" after 128 bytes.
bool has_dicom_magic(std::string_view path);

/// Size of a regular, readable, non-empty file, bytes; otherwise an Error that names it.
Result<std::uint64_t> readable_file_size(const std::string& path);
/// File name without folder and extension.
std::string file_stem(const std::string& path);

/// For implementers of formats: this module, and programs that register their own.

/// An opened file that contains one dense array: the layout has been validated and fits the memory budget.
struct DenseFile {
  std::string name;    ///< Name of the grid.
  std::string type;    ///< Number type, as printed by `info`.
  std::string prefix;  ///< Beginning of messages about the values: "x.raw: the data ".
  Mapping mapping;
  int components = 1;                ///< 1 or 3.
  DenseSource source;                ///< Reads the values; holds the file open.
  std::vector<double> times{};       ///< See AnyField::times.
  std::string time_unit{};           ///< See AnyField::time_unit.
  std::int64_t newest_mtime_ns = 0;  ///< See AnyField::newest_mtime_ns.
  std::vector<std::string> notes{};
  std::shared_ptr<const RoundingLoss> rounding{};  ///< Accumulated rounding loss of reading the values; null: not reported.
};
/// Loads the values of a dense file into a grid.
Result<AnyField> load_dense(const DenseFile& file);
/// Returns the grid with cubic interpolation; other fields are returned unchanged. An Error begins with `path`.
Result<AnyField> with_cubic_interpolation(AnyField field, const std::string& path);
/// For a format that holds one grid: loads it and describes the result.
Result<std::vector<GridInfo>> describe_by_loading(const std::string& path, int step);

/// A row of the format registry (formats.cpp).
struct FileFormat {
  std::vector<std::string_view> extensions;  ///< Lower case, with the dot.
  bool needs_layout = false;                 ///< The file does not describe itself: LoadRequest::raw is required.
  /// Either `open` is set (the file contains one dense array), or `load` (loads one grid of the file).
  Result<DenseFile> (*open)(const LoadRequest& request) = nullptr;
  Result<AnyField> (*load)(const LoadRequest& request) = nullptr;
  Result<std::vector<GridInfo>> (*describe)(const std::string& path, int step) = nullptr;
  Units (*units)(const std::string& path, const std::string& grid) = nullptr;  ///< Null: the format has no units.
  bool reads_folders = false;                                                  ///< Reads folders and DICOM files without an extension, too.
};
/// Adds a format. Call it at startup, before any file is read.
void register_format(FileFormat format);
FileFormat vdb_format();
FileFormat nifti_format();
FileFormat raw_format();
FileFormat npy_format();
FileFormat vtk_format();
/// Returns the format of a path; nullptr: none. `ending`: receives the matching extension; empty for a folder or by contents.
const FileFormat* find_format(std::string_view path, std::string_view* ending = nullptr);

Units read_nifti_units(const std::string& path, const std::string& grid);
Units read_vdb_units(const std::string& path, const std::string& grid);

/// Counters of load_counters(): a loaded file, grid or mask.
void count_file();
void count_grid();
void count_mask();

}  // namespace catena::field
