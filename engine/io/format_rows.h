// SPDX-License-Identifier: MIT
/// Private to this module: the rows of the registry (formats.h), each defined in the file of its reader.
#pragma once
#include <vector>

#include "engine/io/formats.h"

namespace catena::io {

Format vdb_format();
Format nifti_format();
Format raw_format();
Format npy_format();
Format stl_format();
Format obj_format();
Format tck_format();
Format trk_format();
Format csv_format();
Format table_format();
/// The formats that the program catena-read-vtk reads.
std::vector<Format> remote_formats();

}  // namespace catena::io
