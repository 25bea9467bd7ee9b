/// Polyhedra as tetrahedra, so that values in them are continuous, and linear ones exact. VTK's mean value coordinates lose accuracy
/// beside faces, and its test of what is inside is one by random rays.
///   a polyhedron    is cut into tetrahedra of its centre, a face's centre and an edge of the face; faces of three points have no centre
///   values          at a centre the mean over its points, where the centre's place is the mean, too
/// A face that two polyhedra share is cut the same way for both. One that its centre does not see whole stays as it is.
#pragma once
#include "engine/io/vtk/resample.h"

namespace catena::vtk {

/// `keep` holds what was made. The same block where it has no polyhedra.
CellValues tetrahedralize_polyhedra(const CellValues& block, std::vector<vtkSmartPointer<vtkDataSet>>& keep);

}  // namespace catena::vtk
