/// The values of one NetCDF variable as its attributes define them (NetCDF Users' Guide, appendix A; CF conventions, 2.5.1 and 8.1).
///   stored     numbers of the variable's type; "_Unsigned" reinterprets integers of the same size
///   hole       stored = _FillValue, or one of missing_value; without a _FillValue the library's default fill of the type, except for
///              types of one byte; or outside valid_range, valid_min, valid_max. Attributes are converted to the variable's type first
///   value      stored * scale_factor + add_offset; holes become NaN
/// The limits of a valid range are in stored units, unless their type is that of scale_factor and add_offset and wider than the
/// variable's: then they are in the units of the values. A missing_value counts in either units.
#pragma once
#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::vtk {

/// Part of a variable of an open file: `start` and `count` hold one number for each of its dimensions.
struct NetcdfHyperslab {
  int file = 0, variable = 0;
  std::vector<std::size_t> start, count;
};

/// Integers without holes and without a scale keep their type; other values are floats or doubles. Appends to `notes` what was masked on
/// the word of a valid range. An error is a phrase. A null array: the variable holds no numbers (text, compounds).
Result<vtkSmartPointer<vtkDataArray>> read_netcdf_values(const NetcdfHyperslab& part, std::vector<std::string>& notes);

/// scale_factor and add_offset of a variable.
struct NetcdfScale {
  double factor = 1, offset = 0;
  bool is_identity() const { return factor == 1 && offset == 0; }
};
NetcdfScale read_netcdf_scale(int file, int variable);

/// An attribute of text, as the file has it; empty: there is none.
std::string read_netcdf_text(int file, int variable, const char* name);

}  // namespace catena::vtk
