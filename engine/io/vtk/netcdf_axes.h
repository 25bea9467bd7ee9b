// SPDX-License-Identifier: MIT
/// Private to this module: identifies the dimensions of a NetCDF file by the CF conventions, and reorders grids to x, y, z.
/// The axis of a dimension follows from its coordinate variable, by the first available of
///   axis = X, Y, Z or T
///   standard_name: longitude, projection_y_coordinate, air_pressure, time, ...
///   units: degrees_east, degrees_north, a pressure, or "UNIT since DATE"
///   positive = up or down: z
/// and else from its name: x, lon, lat, depth, ...
#pragma once
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include <array>
#include <string>

namespace catena::vtk {

/// Axis of a dimension.
enum class NetcdfAxis { x, y, z, time, unknown };
/// Axis and unit of a dimension.
struct NetcdfDimension {
  NetcdfAxis axis = NetcdfAxis::unknown;
  bool guessed_from_name = false;  ///< No attribute specifies the axis; it was guessed from the name.
  std::string unit;                ///< Unit of the coordinate variable, as in the file.
};
/// Identifies a dimension of an open file, by its NetCDF ids.
NetcdfDimension read_netcdf_dimension(int file, int dimension);

/// Order of axes. [a]: index of the data's axis that lies along world axis a. Unknown axes fill the remaining positions.
using AxisOrder = std::array<int, 3>;
inline constexpr AxisOrder kFileOrder{0, 1, 2};
/// Computes the order from the axes in storage order, fastest first. If two are the same axis, the order of the file is retained.
AxisOrder compute_axis_order(const std::array<NetcdfAxis, 3>& axes);

/// Returns an image or a rectilinear grid with its axes in this order; other data unchanged.
vtkSmartPointer<vtkDataSet> reorder_axes(vtkDataSet* data, const AxisOrder& order);

}  // namespace catena::vtk
