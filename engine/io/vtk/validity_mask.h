// SPDX-License-Identifier: MIT
/// Validity of the points and cells of a file, by VTK's flags (the array vtkGhostType, of any number type) and by a mask array.
///   cell    invalid if it is HIDDENCELL or REFINEDCELL, is a DUPLICATECELL that occurs elsewhere in the file, is masked, or has a point
///           that is HIDDENPOINT or masked: like IsCellVisible of vtkStructuredGrid and vtkImageData, for cells of every kind
///   point   invalid if it is HIDDENPOINT or masked, if all cells that use it are invalid, or if no cell of an unstructured grid uses it
/// DUPLICATEPOINT, HIGHCONNECTIVITYCELL, LOWCONNECTIVITYCELL and EXTERIORCELL do not make data invalid.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/vtk/open.h"

namespace catena::vtk {

/// Mask of one block; 1: valid.
struct ValidityMask {
  std::vector<std::uint8_t> points, cells;  ///< Empty: all are valid.
  bool is_valid_point(vtkIdType i) const { return points.empty() || points[static_cast<std::size_t>(i)] != 0; }
  bool is_valid_cell(vtkIdType i) const { return cells.empty() || cells[static_cast<std::size_t>(i)] != 0; }
};

/// Returns one mask per block. `mask`: name of point or cell arrays that are zero where there are no data; empty: none.
std::vector<ValidityMask> make_validity_masks(const ImportedData& opened, const std::string& mask);

/// Returns the valid cells, without flag arrays; `data` itself if all cells are valid.
vtkSmartPointer<vtkDataSet> extract_valid_cells(vtkDataSet* data, const ValidityMask& mask);

/// Returns whether a grid needs a cell mask: some cell with eight valid corners is masked.
bool needs_cell_mask(const field::Index3& size, const std::uint8_t* valid, const std::uint8_t* cells);

}  // namespace catena::vtk
