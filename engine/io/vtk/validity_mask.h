/// Which points and cells of a file are data, by VTK's flags (the array vtkGhostType, of any type of number) and by an array that masks.
///   cell    not where it is HIDDENCELL or REFINEDCELL, is DUPLICATECELL and stands in the file once more, is masked, or has a point that
///           is HIDDENPOINT or masked: vtkStructuredGrid's and vtkImageData's IsCellVisible, for cells of every kind
///   point   not where it is HIDDENPOINT or masked, or where all cells that use it are no data, or none does of an unstructured grid
/// DUPLICATEPOINT, HIGHCONNECTIVITYCELL, LOWCONNECTIVITYCELL and EXTERIORCELL say where a cell belongs, not that it is no data.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/vtk/open.h"

namespace catena::vtk {

/// Of one block; 1: data.
struct ValidityMask {
  std::vector<std::uint8_t> points, cells;  ///< empty: all are
  bool is_valid_point(vtkIdType i) const { return points.empty() || points[static_cast<std::size_t>(i)] != 0; }
  bool is_valid_cell(vtkIdType i) const { return cells.empty() || cells[static_cast<std::size_t>(i)] != 0; }
};

/// One a block. `mask`: the name of arrays of points or cells that are zero where there are no data; empty: none.
std::vector<ValidityMask> make_validity_masks(const ImportedData& opened, const std::string& mask);

/// The cells that are data, without arrays of flags; the block's own data where all are.
vtkSmartPointer<vtkDataSet> extract_valid_cells(vtkDataSet* data, const ValidityMask& seen);

/// Of a grid's masks: some cell of which all corners are valid is masked of itself.
bool needs_cell_mask(const field::Index3& size, const std::uint8_t* valid, const std::uint8_t* cells);

}  // namespace catena::vtk
