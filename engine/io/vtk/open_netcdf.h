/// NetCDF (CF): VTK finds the coordinates, the values come from the NetCDF library (netcdf_values.h).
#pragma once
#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include "engine/io/vtk/open.h"

namespace catena::vtk {

vtkSmartPointer<vtkAlgorithm> open_netcdf(const Source& source);

/// Which variables are read: those of the grid that is wanted, else those with most dimensions. Others are named in a note. Before the
/// data are read; of another reader than open_netcdf's nothing is done.
void choose_netcdf_variables(vtkAlgorithm* reader, const Source& source, ImportedData& opened);

/// After the data are read: units and notes, coordinates that are stored with a scale, and grids of even steps as images (VTK takes falling
/// coordinates for uneven ones). An error is a phrase: there are no values.
Outcome finish_netcdf(vtkAlgorithm* reader, ImportedData& opened);

}  // namespace catena::vtk
