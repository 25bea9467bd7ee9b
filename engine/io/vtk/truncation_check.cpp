// SPDX-License-Identifier: MIT
#include "engine/io/vtk/truncation_check.h"

#include <malloc.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace catena::vtk {
namespace {

constexpr unsigned char kFills[] = {0x5a, 0x3c};

/// Fills new memory with `fill`, and freed memory with ~fill, which a reused block may still contain.
void fill_new_memory(unsigned char fill) { ::mallopt(M_PERTURB, fill ^ 0xff); }

/// Returns whether the first or the last byte of the last value has the fill pattern: with the other byte order the last byte comes first.
bool ends_with(const std::byte* values, std::size_t bytes, std::size_t value_bytes, unsigned char fill) {
  const auto is_fill = [fill](std::byte b) { return b == std::byte{fill} || b == std::byte(fill ^ 0xff); };
  return bytes >= value_bytes && value_bytes > 0 && (is_fill(values[bytes - 1]) || is_fill(values[bytes - value_bytes]));
}

bool ends_with(vtkDataArray* array, unsigned char fill) {
  if (array == nullptr || array->GetNumberOfValues() == 0 || !array->HasStandardMemoryLayout()) return false;
  const auto size = static_cast<std::size_t>(array->GetDataTypeSize());
  const auto bytes = size * static_cast<std::size_t>(array->GetNumberOfValues());
  return ends_with(static_cast<const std::byte*>(array->GetVoidPointer(0)), bytes, size, fill);
}

bool ends_with(vtkDataSet* data, unsigned char fill) {
  std::vector<vtkDataArray*> arrays;
  const auto add_attributes = [&](vtkDataSetAttributes* attributes) {
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i) arrays.push_back(attributes->GetArray(i));
  };
  const auto add_cells = [&](vtkCellArray* cells) {
    if (cells != nullptr && cells->GetNumberOfCells() > 0) arrays.push_back(cells->GetConnectivityArray());
  };
  add_attributes(data->GetPointData());
  add_attributes(data->GetCellData());
  if (auto* points = vtkPointSet::SafeDownCast(data); points != nullptr && points->GetPoints() != nullptr)
    arrays.push_back(points->GetPoints()->GetData());
  if (auto* grid = vtkRectilinearGrid::SafeDownCast(data))
    for (vtkDataArray* axis : {grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates()}) arrays.push_back(axis);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data)) add_cells(grid->GetCells());
  if (auto* mesh = vtkPolyData::SafeDownCast(data))
    for (vtkCellArray* cells : {mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys(), mesh->GetStrips()}) add_cells(cells);
  return std::ranges::any_of(arrays, [fill](vtkDataArray* array) { return ends_with(array, fill); });
}

bool ends_with(vtkDataObject* object, unsigned char fill) {
  if (auto* data = vtkDataSet::SafeDownCast(object)) return ends_with(data, fill);
  auto* composite = vtkCompositeDataSet::SafeDownCast(object);
  if (composite == nullptr) return false;
  const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem())
    if (auto* data = vtkDataSet::SafeDownCast(each->GetCurrentDataObject()); data != nullptr && ends_with(data, fill)) return true;
  return false;
}

}  // namespace

Outcome read_checking_truncation(const std::function<void()>& read, const std::function<vtkDataObject*()>& data) {
  for (const unsigned char fill : kFills) {
    fill_new_memory(fill);
    read();
    if (!ends_with(data(), fill)) return Done{};
  }
  return Error{kTruncatedMessage};
}

Outcome read_checking_truncation(std::byte* values, std::size_t bytes, std::size_t value_bytes, const std::function<void()>& read) {
  for (const unsigned char fill : kFills) {
    std::memset(values, fill, bytes);
    read();
    if (!ends_with(values, bytes, value_bytes, fill)) return Done{};
  }
  return Error{kTruncatedMessage};
}

}  // namespace catena::vtk
