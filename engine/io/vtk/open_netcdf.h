// SPDX-License-Identifier: MIT
/// Opens NetCDF files (CF): VTK finds the coordinates, the values come from the NetCDF library (netcdf_values.h).
#pragma once
#include <vtkAlgorithm.h>
#include <vtkSmartPointer.h>

#include "engine/io/vtk/open.h"

namespace catena::vtk {

/// Creates the VTK reader for a file.
vtkSmartPointer<vtkAlgorithm> make_netcdf_reader(const Source& source);

/// Selects the variables to read: those of the requested grid, else those with most dimensions; others are listed in a note. Call it before
/// the data are read; does nothing for readers that make_netcdf_reader() has not created.
void choose_netcdf_variables(vtkAlgorithm* reader, const Source& source, ImportedData& opened);

/// Call it after the data have been read: sets units and notes, applies the scale of coordinates, and converts evenly spaced grids to
/// images (VTK considers decreasing coordinates uneven). Returns an Error with a message fragment: there are no values.
Outcome finish_netcdf(vtkAlgorithm* reader, ImportedData& opened);

}  // namespace catena::vtk
