// SPDX-License-Identifier: MIT
/// Interface for readers of volume formats, in this module and in programs that register their own (engine/io/formats.h). Any thread.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/input_files.h"
#include "engine/base/result.h"
#include "engine/field/grid/dense.h"
#include "engine/field/number_type.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"

namespace catena::field {

struct VoxelSource;  // voxel_source.h

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

/// Functions that read the volumes of a format. `open` is set (the file contains one dense array), or `load` (loads one grid of the file).
struct VolumeReader {
  Result<DenseFile> (*open)(const LoadRequest& request) = nullptr;
  Result<AnyField> (*load)(const LoadRequest& request) = nullptr;
  Result<std::vector<GridInfo>> (*describe)(const std::string& path, int step) = nullptr;
  Units (*units)(const std::string& path, const std::string& grid) = nullptr;  ///< Null: the format has no units.
  std::vector<double> (*times)(const std::string& path) = nullptr;             ///< Null: the format has one time step.
  std::vector<std::string> (*notes)(const std::string& path) = nullptr;        ///< On the whole file; with `reads_parts` only.
  std::vector<FileId> (*files)(const std::string& path) = nullptr;             ///< Data files; null: those that a reader opened.
  /// Opens a scalar grid that is read in boxes, at full resolution, whatever its size; null: the grid is loaded.
  Result<VoxelSource> (*open_voxels)(const LoadRequest& request) = nullptr;
  bool (*recognizes_folder)(const std::string& path) = nullptr;  ///< By its contents, whatever its name.
  bool is_array = false;                                         ///< One array in rows: a large file is read in bricks, as a store.
  bool needs_layout = false;                                     ///< The file does not describe itself: LoadRequest::raw is required.
  bool reads_folders = false;  ///< Reads folders that no format recognizes, and DICOM files without an extension, too.
  bool reads_parts = false;    ///< `load` applies level and crop itself; `describe` does not read all values.
};

/// Loads the values of a dense file into a grid.
Result<AnyField> load_dense(const DenseFile& file);
/// Returns the grid with cubic interpolation; other fields are returned unchanged. An Error begins with `path`.
Result<AnyField> with_cubic_interpolation(AnyField field, const std::string& path);
/// Loads the only grid of a file and describes it; for formats that hold one grid.
Result<std::vector<GridInfo>> describe_by_loading(const std::string& path, int step);

/// DICOM files often have no extension: recognized by "DICM" after 128 bytes.
bool has_dicom_magic(std::string_view path);
/// Size of a regular, readable, non-empty file, bytes; otherwise an Error that names it.
Result<std::uint64_t> readable_file_size(const std::string& path);

/// Units in the header of a NIfTI file.
Units read_nifti_units(const std::string& path, const std::string& grid);
/// Units in the metadata of a VDB file.
Units read_vdb_units(const std::string& path, const std::string& grid);

/// Counters of load_counters(): a loaded file, grid or mask.
void count_file();
void count_grid();
void count_mask();

}  // namespace catena::field
