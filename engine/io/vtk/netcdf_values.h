// SPDX-License-Identifier: MIT
/// The values of one NetCDF variable as its attributes define them (NetCDF Users' Guide, appendix A; CF conventions, 2.5.1 and 8.1).
///   stored     numbers of the variable's type; "_Unsigned" reinterprets integers of the same size
///   missing    stored = _FillValue, or one of missing_value; without a _FillValue the library's default fill value of the type, except for
///              types of one byte; or outside valid_range, valid_min, valid_max. Attributes are first converted to the variable's type
///   value      stored * scale_factor + add_offset; missing values become NaN
/// The limits of a valid range are in stored units, unless their type is that of scale_factor and add_offset and wider than the
/// variable's: then they are in the units of the values. A missing_value is matched in either unit.
#pragma once
#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::vtk {

/// Part of a variable of an open file: `start` and `count` have one entry per dimension.
struct NetcdfHyperslab {
  int file = 0, variable = 0;
  std::vector<std::size_t> start, count;
};

/// Reads values. Integers without missing values and scale keep their type; other values become floats or doubles. Appends a note
/// on values that were masked because of a valid range. Returns an Error with a message fragment, or null if the variable has no numbers
/// (text, compounds).
Result<vtkSmartPointer<vtkDataArray>> read_netcdf_values(const NetcdfHyperslab& part, std::vector<std::string>& notes);

/// scale_factor and add_offset of a variable.
struct NetcdfScale {
  double factor = 1, offset = 0;
  bool is_identity() const { return factor == 1 && offset == 0; }
};
/// Reads the scale of a variable, by its NetCDF ids.
NetcdfScale read_netcdf_scale(int file, int variable);

/// Returns a text attribute, as in the file; empty: missing.
std::string read_netcdf_text(int file, int variable, const char* name);

}  // namespace catena::vtk
