/// Private to this room: one reader a format, and the counters they keep.
#pragma once
#include "engine/field/dense.h"
#include "engine/field/load.h"

namespace catena::field {

Result<AnyField> load_vdb(const LoadRequest& request);
Result<std::vector<GridInfo>> describe_vdb(const std::string& path);

/// A file that holds one box of numbers, opened: its layout is checked and fits into the memory that is allowed.
struct DenseFile {
  std::string name;    ///< of its grid
  std::string type;    ///< as `info` prints it
  std::string prefix;  ///< of a phrase about its values: "x.raw: the data "
  Mapping mapping;
  int components = 1;  ///< 1 or 3
  DenseSource source;  ///< keeps the file open
};
Result<DenseFile> open_raw(const LoadRequest& request);
Result<DenseFile> open_nifti(const LoadRequest& request);
Result<AnyField> load_dense(const DenseFile& file);
Result<std::vector<GridInfo>> describe_nifti(const std::string& path);

void count_file();
void count_grid();
void count_mask();

}  // namespace catena::field
