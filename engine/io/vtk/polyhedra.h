// SPDX-License-Identifier: MIT
/// Splits polyhedra into tetrahedra, so that interpolated values are continuous and linear functions exact. VTK's mean value coordinates
/// lose accuracy near faces, and its inside test uses random rays.
///   polyhedron   split into tetrahedra of its center, a face center and an edge of that face; triangular faces have no center
///   values       at a center: the mean over the points of the polyhedron or face; the position of a center is the mean of their positions
/// A face shared by two polyhedra is split in the same way for both. A polyhedron with a face not fully visible from its center is kept.
#pragma once
#include "engine/io/vtk/resample.h"

namespace catena::vtk {

/// Splits the polyhedra of a block; returns the block itself when it has none. `owned` receives the data sets created, which must live as
/// long as the result.
CellValues tetrahedralize_polyhedra(const CellValues& block, std::vector<vtkSmartPointer<vtkDataSet>>& owned);

}  // namespace catena::vtk
