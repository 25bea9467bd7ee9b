// SPDX-License-Identifier: MIT
#include "engine/io/vtk/netcdf_axes.h"

#include <netcdf.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "engine/base/text.h"
#include "engine/io/vtk/netcdf_values.h"

namespace catena::vtk {
namespace {

using Words = std::initializer_list<std::string_view>;

std::string lowered(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

bool is_one_of(std::string_view word, const Words& words) { return std::ranges::find(words, word) != words.end(); }

NetcdfAxis axis_of_attribute(const std::string& word) {
  constexpr std::string_view kWords[] = {"x", "y", "z", "t"};
  const auto at = std::ranges::find(kWords, word) - std::begin(kWords);
  return static_cast<NetcdfAxis>(at);
}

NetcdfAxis axis_of_standard_name(const std::string& name) {
  if (is_one_of(name, {"longitude", "grid_longitude", "projection_x_coordinate", "projection_x_angular_coordinate"})) return NetcdfAxis::x;
  if (is_one_of(name, {"latitude", "grid_latitude", "projection_y_coordinate", "projection_y_angular_coordinate"})) return NetcdfAxis::y;
  if (name == "time") return NetcdfAxis::time;
  const bool parametric = (name.starts_with("atmosphere_") || name.starts_with("ocean_")) && name.ends_with("coordinate");
  const bool vertical = name.starts_with("height") || name.starts_with("depth") || name.starts_with("altitude") ||
                        name.ends_with("pressure") || name.ends_with("_height") || name == "model_level_number";
  return parametric || vertical ? NetcdfAxis::z : NetcdfAxis::unknown;
}

NetcdfAxis axis_of_unit(const std::string& unit) {
  if (is_one_of(unit, {"degrees_east", "degree_east", "degrees_e", "degree_e", "degreese", "degreee"})) return NetcdfAxis::x;
  if (is_one_of(unit, {"degrees_north", "degree_north", "degrees_n", "degree_n", "degreesn", "degreen"})) return NetcdfAxis::y;
  if (unit.find(" since ") != std::string::npos) return NetcdfAxis::time;
  const bool pressure = is_one_of(unit, {"pa", "hpa", "kpa", "pascal", "pascals", "hectopascal", "hectopascals", "bar", "bars", "mbar",
                                         "mb", "millibar", "millibars", "dbar", "decibar", "decibars", "atm", "atmosphere", "atmospheres"});
  return pressure || is_one_of(unit, {"level", "layer", "sigma_level"}) ? NetcdfAxis::z : NetcdfAxis::unknown;
}

NetcdfAxis axis_of_name(const std::string& name) {
  if (is_one_of(name, {"x", "lon", "longitude", "easting"})) return NetcdfAxis::x;
  if (is_one_of(name, {"y", "lat", "latitude", "northing"})) return NetcdfAxis::y;
  if (is_one_of(name, {"z", "lev", "level", "depth", "height", "altitude", "elevation"})) return NetcdfAxis::z;
  return NetcdfAxis::unknown;
}

/// Copies the values of a box of `size`, x fastest, into another order of axes.
void reorder(vtkDataSetAttributes* from, vtkDataSetAttributes* to, const int (&size)[3], const AxisOrder& order) {
  const vtkIdType steps[3] = {1, size[0], vtkIdType{size[0]} * size[1]};
  const auto of = [&](int a) { return static_cast<std::size_t>(order[static_cast<std::size_t>(a)]); };
  for (int n = 0; n < from->GetNumberOfArrays(); ++n) {
    vtkDataArray* array = from->GetArray(n);
    if (array == nullptr || array->GetNumberOfTuples() != steps[2] * size[2]) continue;
    const auto moved = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    moved->SetName(array->GetName());
    moved->SetNumberOfComponents(array->GetNumberOfComponents());
    moved->SetNumberOfTuples(array->GetNumberOfTuples());
    vtkIdType at = 0;
    for (int k = 0; k < size[of(2)]; ++k)
      for (int j = 0; j < size[of(1)]; ++j)
        for (int i = 0; i < size[of(0)]; ++i) moved->SetTuple(at++, i * steps[of(0)] + j * steps[of(1)] + k * steps[of(2)], array);
    to->AddArray(moved);
  }
}

}  // namespace

NetcdfDimension read_netcdf_dimension(int file, int dimension) {
  char name[NC_MAX_NAME + 1] = "";
  nc_inq_dimname(file, dimension, name);
  NetcdfDimension found;
  int variable = 0, own_dimension = -1, dimensions = 0;
  if (nc_inq_varid(file, name, &variable) == NC_NOERR && nc_inq_varndims(file, variable, &dimensions) == NC_NOERR && dimensions == 1 &&
      nc_inq_vardimid(file, variable, &own_dimension) == NC_NOERR && own_dimension == dimension) {
    const auto word = [&](const char* attribute) { return lowered(one_line(read_netcdf_text(file, variable, attribute))); };
    found.unit = read_netcdf_text(file, variable, "units");
    found.axis = axis_of_attribute(word("axis"));
    if (found.axis == NetcdfAxis::unknown) found.axis = axis_of_standard_name(word("standard_name"));
    if (found.axis == NetcdfAxis::unknown) found.axis = axis_of_unit(word("units"));
    if (found.axis == NetcdfAxis::unknown && is_one_of(word("positive"), {"up", "down"})) found.axis = NetcdfAxis::z;
  }
  if (found.axis == NetcdfAxis::unknown) {
    found.axis = axis_of_name(lowered(name));
    found.guessed_from_name = found.axis != NetcdfAxis::unknown;
  }
  return found;
}

AxisOrder compute_axis_order(const std::array<NetcdfAxis, 3>& axes) {
  AxisOrder order{-1, -1, -1};
  std::array<bool, 3> assigned{};
  const auto assign = [&](std::size_t from, std::size_t to) {
    order[to] = static_cast<int>(from);
    assigned[from] = true;
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const auto target = static_cast<std::size_t>(axes[a]);
    if (target >= 3) continue;
    if (order[target] >= 0) return kFileOrder;
    assign(a, target);
  }
  for (std::size_t a = 0; a < 3; ++a)
    if (!assigned[a] && order[a] < 0) assign(a, a);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t to = 0; to < 3 && !assigned[a]; ++to)
      if (order[to] < 0) assign(a, to);
  return order;
}

vtkSmartPointer<vtkDataSet> reorder_axes(vtkDataSet* data, const AxisOrder& order) {
  auto* image = vtkImageData::SafeDownCast(data);
  auto* grid = vtkRectilinearGrid::SafeDownCast(data);
  if (order == kFileOrder || (image == nullptr && grid == nullptr)) return data;
  int size[3], cells[3];
  image != nullptr ? image->GetDimensions(size) : grid->GetDimensions(size);
  for (int a = 0; a < 3; ++a) cells[a] = std::max(size[a] - 1, 1);
  vtkSmartPointer<vtkDataSet> moved;
  if (image != nullptr) {
    int extent[6], new_extent[6];
    double new_origin[3], new_spacing[3];
    image->GetExtent(extent);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto from = static_cast<std::size_t>(order[a]);
      new_extent[2 * a] = extent[2 * from];
      new_extent[2 * a + 1] = extent[2 * from + 1];
      new_origin[a] = image->GetOrigin()[from];
      new_spacing[a] = image->GetSpacing()[from];
    }
    const auto made = vtkSmartPointer<vtkImageData>::New();
    made->SetExtent(new_extent);
    made->SetOrigin(new_origin);
    made->SetSpacing(new_spacing);
    moved = made;
  } else {
    vtkDataArray* axes[3] = {grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates()};
    const auto made = vtkSmartPointer<vtkRectilinearGrid>::New();
    made->SetDimensions(size[order[0]], size[order[1]], size[order[2]]);
    made->SetXCoordinates(axes[order[0]]);
    made->SetYCoordinates(axes[order[1]]);
    made->SetZCoordinates(axes[order[2]]);
    moved = made;
  }
  reorder(data->GetPointData(), moved->GetPointData(), size, order);
  reorder(data->GetCellData(), moved->GetCellData(), cells, order);
  return moved;
}

}  // namespace catena::vtk
