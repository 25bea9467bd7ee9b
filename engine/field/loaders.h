/// Private to this room: one reader a format, and the counters they keep.
#pragma once
#include "engine/field/load.h"

namespace catena::field {

Result<AnyField> load_vdb(const LoadRequest& request);
Result<AnyField> load_nifti(const LoadRequest& request);
Result<AnyField> load_raw(const LoadRequest& request);
Result<std::vector<GridInfo>> describe_vdb(const std::string& path);
Result<std::vector<GridInfo>> describe_nifti(const std::string& path);

void count_file();
void count_grid();
void count_mask();

}  // namespace catena::field
