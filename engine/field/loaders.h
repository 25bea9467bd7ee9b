/// For who reads a format: this room, and programs that bring one of their own. One reader a format, and the counters they keep.
#pragma once
#include "engine/field/dense.h"
#include "engine/field/load.h"
#include "engine/field/units.h"

namespace catena::field {

/// A file that holds one box of numbers, opened: its layout is checked and fits into the memory that is allowed.
struct DenseFile {
  std::string name;    ///< of its grid
  std::string type;    ///< as `info` prints it
  std::string prefix;  ///< of a phrase about its values: "x.raw: the data "
  Mapping mapping;
  int components = 1;  ///< 1 or 3
  DenseSource source;  ///< keeps the file open
};
Result<AnyField> load_dense(const DenseFile& file);

/// One row of the registry of formats (formats.cpp).
struct FileFormat {
  std::vector<std::string_view> endings;  ///< of names, lower-case
  bool needs_layout = false;              ///< the file says nothing about itself: LoadRequest::raw goes with it
  /// Either a box of numbers is opened, or one grid of the file is loaded.
  Result<DenseFile> (*open)(const LoadRequest& request) = nullptr;
  Result<AnyField> (*load)(const LoadRequest& request) = nullptr;
  Result<std::vector<GridInfo>> (*describe)(const std::string& path) = nullptr;
  Units (*units)(const std::string& path, const std::string& grid) = nullptr;  ///< nullptr: the format has none
};
/// One more, at start-up, before anything reads a file.
void add_format(FileFormat format);
FileFormat vdb_format();
FileFormat nifti_format();
FileFormat raw_format();
/// nullptr: none. `ending`: which of its endings.
const FileFormat* format_of(std::string_view path, std::string_view* ending = nullptr);

Units nifti_units(const std::string& path, const std::string& grid);
Units vdb_units(const std::string& path, const std::string& grid);

void count_file();
void count_grid();
void count_mask();

}  // namespace catena::field
