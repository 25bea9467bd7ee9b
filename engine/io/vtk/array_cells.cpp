// SPDX-License-Identifier: MIT
#include <vtkAppendFilter.h>
#include <vtkCellData.h>
#include <vtkCellDataToPointData.h>
#include <vtkExtractCells.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/io/vtk/arrays.h"
#include "engine/io/vtk/polyhedra.h"

namespace catena::vtk {
namespace {

/// Joins the pieces of one mesh, so that cells on both sides of a cut share its points.
vtkSmartPointer<vtkDataSet> joined_pieces(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& masks) {
  vtkNew<vtkAppendFilter> join;
  join->MergePointsOn();
  for (const std::size_t b : column.block_indices) join->AddInputData(extract_valid_cells(opened.blocks[b].data, masks[b]));
  join->Update();
  return join->GetOutput();
}

bool is_finite_at(vtkDataArray& values, vtkIdType i) {
  for (int c = 0; c < values.GetNumberOfComponents(); ++c)
    if (!std::isfinite(values.GetComponent(i, c))) return false;
  return true;
}

/// Returns the cells that have a volume and finite values (their own, or those of all of their points); null if there are none.
vtkSmartPointer<vtkDataSet> solid_part(vtkDataSet* data, vtkDataArray& values, bool of_cells) {
  vtkNew<vtkGenericCell> cell;
  vtkNew<vtkIdList> ids, points;
  std::map<int, bool> solid;
  const vtkIdType cells = data->GetNumberOfCells();
  const auto is_finite = [&](vtkIdType i) {
    if (of_cells) return is_finite_at(values, i);
    data->GetCellPoints(i, points);
    return std::all_of(points->begin(), points->end(), [&](vtkIdType p) { return is_finite_at(values, p); });
  };
  for (vtkIdType i = 0; i < cells; ++i) {
    const auto [at, is_new] = solid.try_emplace(data->GetCellType(i), false);
    if (is_new) {
      cell->SetCellType(at->first);
      at->second = cell->GetCellDimension() == 3;
    }
    if (at->second && is_finite(i)) ids->InsertNextId(i);
  }
  if (ids->GetNumberOfIds() == cells) return data;
  if (ids->GetNumberOfIds() == 0) return nullptr;
  vtkNew<vtkExtractCells> extract;
  extract->SetInputData(data);
  extract->SetCellList(ids);
  extract->Update();
  return extract->GetOutput();
}

}  // namespace

std::vector<CellValues> make_cell_values(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& masks,
                                         std::vector<vtkSmartPointer<vtkDataSet>>& owned) {
  std::vector<CellValues> cells;
  if (column.is_cell_data && column.block_indices.size() > 1) {
    ImportedData joined;
    joined.blocks.push_back({joined_pieces(opened, column, masks), {}});
    FieldArray one = column;
    one.block_indices = {0};
    return make_cell_values(joined, one, {ValidityMask()}, owned);
  }
  for (const std::size_t b : column.block_indices) {
    const Block block{extract_valid_cells(opened.blocks[b].data, masks[b]), {}};
    vtkDataArray* values = column.find_in(block);
    if (values == nullptr) continue;
    const std::string name = name_of(*values);
    vtkSmartPointer<vtkDataSet> data = solid_part(block.data, *values, column.is_cell_data);
    if (data == nullptr) continue;
    if (column.is_cell_data) {
      vtkNew<vtkCellDataToPointData> average;
      average->SetInputData(data);
      average->PassCellDataOff();
      average->ProcessAllArraysOff();
      average->AddCellDataArray(column.array_name.c_str());
      average->Update();
      data = vtkDataSet::SafeDownCast(average->GetOutput());
      if (data == nullptr) continue;
    }
    values = nullptr;
    for (int i = 0; i < data->GetPointData()->GetNumberOfArrays(); ++i)
      if (vtkDataArray* one = data->GetPointData()->GetArray(i); one != nullptr && name_of(*one) == name) values = one;
    if (values == nullptr) continue;
    owned.push_back(data);
    cells.push_back(tetrahedralize_polyhedra({data, values}, owned));
  }
  return cells;
}

}  // namespace catena::vtk
