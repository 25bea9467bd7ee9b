// SPDX-License-Identifier: MIT
/// Checks the size that a NetCDF file of the classic formats (CDF-1, CDF-2, CDF-5) must have by its own header. The NetCDF library returns
/// zeros past the end of a file; files of NetCDF-4 are checked by the HDF5 library itself.
#pragma once
#include <string>

#include "engine/base/result.h"

namespace catena::vtk {

/// Returns an Error, whose message completes "PATH: ", when the file ends before the data described by its header. Other files, and invalid
/// headers, are left to their readers.
Outcome check_netcdf_size(const std::string& path);

}  // namespace catena::vtk
