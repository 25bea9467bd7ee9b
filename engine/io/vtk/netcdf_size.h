/// The size that a NetCDF file of the classic formats (CDF-1, CDF-2, CDF-5) must have by its own header. The NetCDF library reads zeros
/// behind a file's end; files of NetCDF-4 are HDF5's, which checks that itself.
#pragma once
#include <string>

#include "engine/base/result.h"

namespace catena::vtk {

/// An error, which completes "PATH: ", where the file ends before the data that its header describes. Other files, and headers that make no
/// sense, are left to their readers.
Outcome check_netcdf_size(const std::string& path);

}  // namespace catena::vtk
