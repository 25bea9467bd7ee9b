// SPDX-License-Identifier: MIT
#include "engine/io/vtk/open_netcdf.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkNetCDFCFReader.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/base/text.h"
#include "engine/io/vtk/netcdf_axes.h"
#include "engine/io/vtk/netcdf_values.h"

namespace catena::vtk {
namespace {

std::string dimension_name(int file, int dimension) {
  char name[NC_MAX_NAME + 1] = "";
  nc_inq_dimname(file, dimension, name);
  return name;
}

/// Returns the number of variables in the groups below a group.
std::size_t variables_in_groups(int file, int depth = 0) {
  int count = 0;
  constexpr int kDeepest = 8;
  if (depth > kDeepest || nc_inq_grps(file, &count, nullptr) != NC_NOERR || count <= 0) return 0;
  std::vector<int> groups(static_cast<std::size_t>(count));
  nc_inq_grps(file, &count, groups.data());
  std::size_t all = 0;
  for (const int group : groups) {
    int variables = 0;
    nc_inq_nvars(group, &variables);
    all += static_cast<std::size_t>(std::max(variables, 0)) + variables_in_groups(group, depth + 1);
  }
  return all;
}

/// VTK's reader with the values of netcdf_values.h.
class NetcdfReader : public vtkNetCDFCFReader {
 public:
  vtkTypeMacro(NetcdfReader, vtkNetCDFCFReader);
  static NetcdfReader* New();

  std::vector<std::string> notes;
  std::vector<NetcdfScale> axis_scales;  ///< of the coordinates along the data's axes
  AxisOrder order = kFileOrder;
  std::string time_unit;

  std::string dimensions_of(vtkIdType variable) const { return VariableDimensions->GetValue(variable); }

 protected:
  int ReadMetaData(int file) override {
    if (const std::size_t group_variables = variables_in_groups(file); group_variables > 0)
      notes.push_back(
          fmt::format("{} variables in groups were left out: \"ncks -G : FILE OUT\" or \"ncks -g GROUP FILE OUT\" moves the variables "
                      "of a group to the top level",
                      group_variables));
    return Superclass::ReadMetaData(file);
  }

  int IsTimeDimension(int file, int dimension) override {
    return Superclass::IsTimeDimension(file, dimension) != 0 || read_netcdf_dimension(file, dimension).axis == NetcdfAxis::time ? 1 : 0;
  }

  int LoadVariable(int file, const char* name, double time, vtkDataSet* output) override {
    NetcdfHyperslab part{file, 0, {}, {}};
    int count = 0;
    if (nc_inq_varid(file, name, &part.variable) != NC_NOERR || nc_inq_varndims(file, part.variable, &count) != NC_NOERR)
      return failed(name, "is damaged");
    std::vector<int> dimensions(static_cast<std::size_t>(count));
    nc_inq_vardimid(file, part.variable, dimensions.data());
    // the time step
    if (count > 0 && IsTimeDimension(file, dimensions[0]) != 0) {
      const vtkSmartPointer<vtkDoubleArray> times = GetTimeValues(file, dimensions[0]);
      std::size_t step = 0;
      const auto steps = static_cast<std::size_t>(times->GetNumberOfTuples());
      while (step + 1 < steps && times->GetValue(static_cast<vtkIdType>(step)) < time) ++step;
      if (steps == 0) return 1;
      time_unit = read_netcdf_dimension(file, dimensions[0]).unit;
      part.start.push_back(step);
      part.count.push_back(1);
      dimensions.erase(dimensions.begin());
    }
    if (static_cast<vtkIdType>(dimensions.size()) != LoadingDimensions->GetNumberOfTuples() ||
        !std::equal(dimensions.begin(), dimensions.end(), LoadingDimensions->GetPointer(0))) {
      notes.push_back(fmt::format("{} has other dimensions and was left out", name));
      return 1;
    }
    // the last three dimensions are z, y, x
    const bool of_points = DimensionsAreForPointData(LoadingDimensions);
    int extent[6];
    GetUpdateExtentForOutput(output, extent);
    for (std::size_t i = 0; i < dimensions.size(); ++i) {
      const std::size_t axis = dimensions.size() - i - 1;
      std::size_t length = 0;
      nc_inq_dimlen(file, dimensions[i], &length);
      if (axis >= 3) {
        part.start.push_back(0);
        part.count.push_back(1);
        if (length > 1)
          notes.push_back(fmt::format("only the first of {} positions along {} is read", length, dimension_name(file, dimensions[i])));
        continue;
      }
      if (IsTimeDimension(file, dimensions[i]) != 0)
        notes.push_back(
            fmt::format("{} is not the first dimension of {} and is read as a spatial axis", dimension_name(file, dimensions[i]), name));
      const int cells = of_points ? 1 : 0;
      const auto first = static_cast<std::size_t>(extent[2 * axis]);
      const auto length_read = static_cast<std::size_t>(std::max(extent[2 * axis + 1] - extent[2 * axis] + cells, 0));
      if (first > length || length_read > length - first) return failed(name, "differs in size from the coordinates");
      part.start.push_back(first);
      part.count.push_back(length_read);
    }
    std::vector<std::string> value_notes;
    const auto values = read_netcdf_values(part, value_notes);
    if (!values) return failed(name, values.error().message);
    for (const std::string& note : value_notes) notes.push_back(fmt::format("{}: {}", name, note));
    if (*values == nullptr) {
      notes.push_back(fmt::format("{} contains no numbers and was left out", name));
      return 1;
    }
    (*values)->SetName(name);
    if (of_points)
      output->GetPointData()->AddArray(*values);
    else
      output->GetCellData()->AddArray(*values);
    note_axes(file, dimensions);
    return 1;
  }

 private:
  int failed(const char* name, const std::string& what) {
    vtkErrorMacro(<< name << ": " << what);
    return 0;
  }

  /// Records the axes that the spatial dimensions declare; the last dimension is the data's first axis.
  void note_axes(int file, const std::vector<int>& dimensions) {
    axis_scales.assign(3, {});
    std::array<NetcdfAxis, 3> axes;
    axes.fill(NetcdfAxis::unknown);
    bool by_name = false;
    for (std::size_t axis = 0; axis < std::min<std::size_t>(3, dimensions.size()); ++axis) {
      int variable = 0;
      const int dimension = dimensions[dimensions.size() - axis - 1];
      const std::string name = dimension_name(file, dimension);
      if (nc_inq_varid(file, name.c_str(), &variable) == NC_NOERR) axis_scales[axis] = read_netcdf_scale(file, variable);
      const NetcdfDimension declared = read_netcdf_dimension(file, dimension);
      axes[axis] = declared.axis;
      by_name = by_name || declared.guessed_from_name;
    }
    order = compute_axis_order(axes);
    if (by_name && order != kFileOrder)
      notes.push_back(
          "the axes follow the names of the dimensions, because not all coordinate variables have an axis, a standard_name or units "
          "that identify the axis");
  }
};
vtkStandardNewMacro(NetcdfReader);

/// Applies scale_factor and add_offset to the coordinates, which VTK reads as stored.
void scale_axes(vtkDataSet* data, const std::vector<NetcdfScale>& scales) {
  if (auto* image = vtkImageData::SafeDownCast(data)) {
    double origin[3], spacing[3];
    image->GetOrigin(origin);
    image->GetSpacing(spacing);
    for (std::size_t a = 0; a < 3; ++a) {
      origin[a] = origin[a] * scales[a].factor + scales[a].offset;
      spacing[a] *= scales[a].factor;
    }
    image->SetOrigin(origin);
    image->SetSpacing(spacing);
  } else if (auto* grid = vtkRectilinearGrid::SafeDownCast(data)) {
    vtkDataArray* axes[3] = {grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates()};
    for (std::size_t a = 0; a < 3; ++a)
      for (vtkIdType i = 0; axes[a] != nullptr && i < axes[a]->GetNumberOfTuples(); ++i)
        axes[a]->SetComponent(i, 0, axes[a]->GetComponent(i, 0) * scales[a].factor + scales[a].offset);
  }
}

/// Returns first position and step of evenly spaced coordinates; nullopt if they are uneven, or there is only one.
std::optional<std::pair<double, double>> even_steps(vtkDataArray* axis) {
  const vtkIdType count = axis != nullptr ? axis->GetNumberOfTuples() : 0;
  if (count < 2) return std::nullopt;
  const double first = axis->GetComponent(0, 0), step = (axis->GetComponent(count - 1, 0) - first) / static_cast<double>(count - 1);
  constexpr double kOfStep = 0.01;
  for (vtkIdType i = 0; i < count; ++i)
    if (!(std::fabs(axis->GetComponent(i, 0) - (first + static_cast<double>(i) * step)) <= kOfStep * std::fabs(step))) return std::nullopt;
  return step != 0 ? std::optional(std::pair(first, step)) : std::nullopt;
}

/// Converts an evenly spaced rectilinear grid to an image with a mapping; steps may be negative.
void make_image(Block& block) {
  auto* grid = vtkRectilinearGrid::SafeDownCast(block.data);
  if (grid == nullptr) return;
  vtkDataArray* axes[3] = {grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates()};
  Mat3 linear(0.0);
  Vec3 origin(0.0);
  double smallest = 0;
  for (int a = 0; a < 3; ++a) {
    const auto even = even_steps(axes[a]);
    const bool single = axes[a] != nullptr && axes[a]->GetNumberOfTuples() == 1;
    if (!even && !single) return;
    origin[a] = even ? even->first : axes[a]->GetComponent(0, 0);
    linear[a][a] = even ? even->second : 0;
    if (even && (smallest == 0 || std::fabs(even->second) < smallest)) smallest = std::fabs(even->second);
  }
  if (smallest == 0) return;
  for (int a = 0; a < 3; ++a)
    if (linear[a][a] == 0) linear[a][a] = smallest;
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(grid->GetDimensions());
  image->GetPointData()->ShallowCopy(grid->GetPointData());
  image->GetCellData()->ShallowCopy(grid->GetCellData());
  block = {image, field::Mapping::from_linear(linear, origin)};
}

}  // namespace

vtkSmartPointer<vtkAlgorithm> make_netcdf_reader(const Source& source) {
  const auto reader = vtkSmartPointer<NetcdfReader>::New();
  reader->SetFileName(source.path.c_str());
  reader->SphericalCoordinatesOff();  // degrees are used as coordinates, as on a map
  return reader;
}

void choose_netcdf_variables(vtkAlgorithm* algorithm, const Source& source, ImportedData& opened) {
  auto* reader = NetcdfReader::SafeDownCast(algorithm);
  if (reader == nullptr) return;
  const int count = reader->GetNumberOfVariableArrays();
  std::string best;
  std::ptrdiff_t max_dimensions = -1;
  for (int i = 0; i < count; ++i) {
    const std::string words = reader->dimensions_of(i);
    const std::ptrdiff_t commas = std::count(words.begin(), words.end(), ',');
    if (!source.grid.empty() && source.grid == reader->GetVariableArrayName(i)) {
      best = words;
      break;
    }
    if (words != "()" && commas > max_dimensions) best = words, max_dimensions = commas;
  }
  std::vector<std::string> others;
  for (int i = 0; i < count; ++i)
    if (const std::string words = reader->dimensions_of(i); words != best && words != "()")
      others.push_back(fmt::format("{} {}", reader->GetVariableArrayName(i), words));
  if (best.empty() || (others.empty() && count == 0)) return;
  reader->SetDimensions(best.c_str());
  if (others.empty()) return;
  constexpr std::size_t kMaxListed = 10;
  const std::size_t listed = std::min(kMaxListed, others.size());
  const std::string more = others.size() > listed ? fmt::format(" and {} more", others.size() - listed) : "";
  opened.notes.push_back(fmt::format("the variables with the dimensions {} are read; --grid NAME selects others: {}{}", best,
                                     fmt::join(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(listed), ", "), more));
}

Outcome finish_netcdf(vtkAlgorithm* algorithm, ImportedData& opened) {
  auto* reader = NetcdfReader::SafeDownCast(algorithm);
  if (reader == nullptr) return Done{};
  if (!opened.times.empty()) opened.time_unit = reader->time_unit;
  for (int i = 0; i < reader->GetNumberOfVariableArrays(); ++i)
    if (const char* name = reader->GetVariableArrayName(i)) opened.units[name] = reader->QueryArrayUnits(name);
  for (const std::string& note : reader->notes)
    if (std::find(opened.notes.begin(), opened.notes.end(), note) == opened.notes.end()) opened.notes.push_back(note);
  const bool scaled =
      std::any_of(reader->axis_scales.begin(), reader->axis_scales.end(), [](const NetcdfScale& s) { return !s.is_identity(); });
  int arrays = 0;
  for (Block& block : opened.blocks) {
    if (scaled) scale_axes(block.data, reader->axis_scales);
    block.data = reorder_axes(block.data, reader->order);
    make_image(block);
    arrays += block.data->GetPointData()->GetNumberOfArrays() + block.data->GetCellData()->GetNumberOfArrays();
  }
  if (arrays == 0)
    return Error{
        fmt::format("contains no numeric variables with dimensions{}{}", opened.notes.empty() ? "" : "; ", fmt::join(opened.notes, "; "))};
  return Done{};
}

}  // namespace catena::vtk
