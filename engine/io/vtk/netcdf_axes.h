/// Private to this room: what the dimensions of a NetCDF file are, by the CF conventions, and grids brought to the order x, y, z.
/// A dimension is what its coordinate variable says, the first that there is of
///   axis = X, Y, Z or T
///   standard_name: longitude, projection_y_coordinate, air_pressure, time, ...
///   units: degrees_east, degrees_north, a pressure, or "UNIT since DATE"
///   positive = up or down: z
/// and last what its name says: x, lon, lat, depth, ...
#pragma once
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include <array>
#include <string>

namespace catena::vtk {

enum class NetcdfAxis { x, y, z, time, unknown };
struct NetcdfDimension {
  NetcdfAxis axis = NetcdfAxis::unknown;
  bool guessed_from_name = false;  ///< no attribute states it
  std::string unit;                ///< of the coordinate variable, as the file has it
};
NetcdfDimension read_netcdf_dimension(int file, int dimension);

/// [a]: which axis of the data lies along a of the world. Axes that are unknown fill the places that are left.
using AxisOrder = std::array<int, 3>;
inline constexpr AxisOrder kFileOrder{0, 1, 2};
/// Of the axes as they lie in memory, fastest first. Where two are the same axis the order stays the file's.
AxisOrder compute_axis_order(const std::array<NetcdfAxis, 3>& axes);

/// An image or a rectilinear grid with its axes in this order; other data as they are.
vtkSmartPointer<vtkDataSet> reorder_axes(vtkDataSet* data, const AxisOrder& order);

}  // namespace catena::vtk
